"""For catkin alone, which wants it here: where the Python package of the tools lies."""

from catkin_pkg.python_setup import generate_distutils_setup
from setuptools import setup

setup(**generate_distutils_setup(packages=["wavetank", "wavetank.web"], package_dir={"": "src/python"}))
