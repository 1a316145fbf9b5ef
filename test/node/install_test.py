#!/usr/bin/env python3
"""The install space, in a folder and an environment of its own: programs, a case with a mesh, launch files, tools, and another's program built on it."""

import csv
import os
import re
import shutil
import subprocess
import tempfile
import unittest

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
BUILD = os.environ["WAVETANK_BUILD"]


def text_of(*path):
    with open(os.path.join(*path), encoding="utf-8") as file:
        return file.read()


def installed_prefix():
    (prefix,) = re.findall(r"(?m)^CMAKE_INSTALL_PREFIX:PATH=(.*)$", text_of(BUILD, "CMakeCache.txt"))
    return prefix.strip("/")


def files_below(folder):
    return {os.path.relpath(os.path.join(where, name), folder) for where, _, names in os.walk(folder) for name in names}


class InstallSpace(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.mkdtemp(prefix="wavetank_install_")
        cls.addClassCleanup(shutil.rmtree, cls.folder, ignore_errors=True)
        install = subprocess.run(
            ["cmake", "--install", BUILD],
            env=dict(os.environ, DESTDIR=cls.folder),
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            universal_newlines=True,
        )
        if install.returncode != 0:
            raise RuntimeError(install.stdout[-3000:])
        cls.prefix = os.path.join(cls.folder, installed_prefix())
        cls.share = os.path.join(cls.prefix, "share", "wavetank")

    def run_there(self, *command):
        """As a user who has nothing of this package but the install space: a new shell that has read its setup.bash."""
        environment = {name: os.environ[name] for name in ("XDG_CACHE_HOME", "LANG") if name in os.environ}
        environment.update(PATH="/usr/bin:/bin", HOME=self.folder, ROS_HOSTNAME="localhost", ROS_HOME=self.folder)
        result = subprocess.run(
            ["/bin/bash", "-c", 'source "$0"/setup.bash && exec "$@"', self.prefix] + list(command),
            cwd=self.folder,
            env=environment,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            universal_newlines=True,
            timeout=300,
        )
        self.assertEqual(result.returncode, 0, " ".join(command) + "\n" + result.stdout + result.stderr)
        return result.stdout

    def test_version(self):
        (version,) = re.findall(r"<version>(.*)</version>", text_of(ROOT, "package.xml"))
        self.assertEqual(self.run_there("rosrun", "wavetank", "wavetank_run", "--version"), "wavetank %s\n" % version)

    def test_a_case_with_a_mesh_and_a_tool_for_its_bag(self):
        self.assertEqual(self.run_there("rospack", "find", "wavetank").strip(), self.share)
        options = ["--set", "numerics/packing/iterations=0", "--duration", "0.02", "--bag", "weir.bag", "--quiet"]
        self.run_there("rosrun", "wavetank", "wavetank_run", os.path.join(self.share, "config", "weir.yaml"), *options)
        self.run_there("rosrun", "wavetank", "export", "weir.bag", "--csv", "tables")
        with open(os.path.join(self.folder, "tables", "gauges.csv"), encoding="utf-8") as file:
            rows = list(csv.reader(line for line in file if not line.startswith("#")))
        self.assertEqual(len(rows), 4)  # a head, and 0, 0.01 and 0.02 s

    def test_launch_files_find_what_they_name(self):
        self.assertEqual(self.run_there("roslaunch", "--nodes", "wavetank", "weir.launch", "rviz:=true").split(), ["/wavetank", "/rviz"])
        launch = os.path.join(self.share, "launch")
        self.assertEqual(set(os.listdir(launch)), set(os.listdir(os.path.join(ROOT, "launch"))))
        named = {(name, path) for name in os.listdir(launch) for path in re.findall(r'\$\(find wavetank\)([^"$ ]+)"', text_of(launch, name))}
        self.assertGreater(len(named), 20)
        for name, path in named:
            self.assertTrue(os.path.exists(self.share + path), "%s: %s is not installed" % (name, path))

    def test_programs_of_the_development_space_are_installed(self):
        programs = set(os.listdir(os.path.join(self.prefix, "lib", "wavetank")))
        (tools,) = re.findall(r"catkin_install_python\(PROGRAMS (.*?)DESTINATION", text_of(ROOT, "CMakeLists.txt"), re.DOTALL)
        tools = [os.path.basename(path) for path in tools.split()]
        self.assertIn("render", tools)
        self.assertEqual(programs, set(tools) | {"wavetank_node", "wavetank_run", "wavetank_bench", "wavetank_check"})
        for program in programs:
            self.assertTrue(os.access(os.path.join(self.prefix, "lib", "wavetank", program), os.X_OK), program)

    def test_python_module_is_the_installed_one(self):
        where = self.run_there("python3", "-c", "import wavetank, wavetank.msg; print(wavetank.__file__); print(wavetank.msg.__file__)").split()
        for path in where:
            self.assertTrue(path.startswith(self.prefix), path)

    def test_public_headers_are_those_of_the_page_and_need_no_other(self):
        headers = os.path.join(self.prefix, "include", "wavetank")
        section = text_of(ROOT, "docs", "architecture.md").partition("## Public headers")[2].partition("\n## ")[0]
        listed = re.findall(r"(?m)^\| `([\w/]+\.h)` \|", section)
        generated = {name for name in os.listdir(headers) if name.endswith(".h")}  # of the messages
        self.assertEqual(files_below(headers) - generated, set(listed))
        for header in listed:
            for included in re.findall(r'#include "wavetank/(.+)"', text_of(headers, header)):
                self.assertIn(included, listed, header + " includes it")

    def test_the_pages_program_is_built_on_it_and_runs(self):
        (program,) = re.findall(r"(?s)```cpp\n(.*?)```", text_of(ROOT, "docs", "architecture.md"))
        source = os.path.join(self.folder, "level.cpp")
        with open(source, "w", encoding="utf-8") as file:
            file.write(program)
        libraries = ["-lwavetank_simulation", "-lwavetank_scene", "-lwavetank_common"]
        folders = ["-I", os.path.join(self.prefix, "include"), "-isystem", "/usr/include/eigen3", "-L", os.path.join(self.prefix, "lib")]
        self.run_there("c++", "-std=c++17", "-O0", source, "-o", "level", *folders, *libraries, "-Wl,-rpath-link," + os.path.join(self.prefix, "lib"))
        case = os.path.join(self.folder, "still.yaml")
        shutil.copy(os.path.join(ROOT, "test", "node", "still_tank.yaml"), case)
        lines = self.run_there("./level", case).splitlines()
        self.assertEqual(lines[0], "H1 0.2 m")
        self.assertRegex(lines[1], r"^184 particles at 0\.0\d+ s$")  # 20 × 10, less the 4 × 4 where the step is


if __name__ == "__main__":
    unittest.main()
