#!/usr/bin/env python3
"""package.xml, debian/control and .ci/apt.txt name the same things: what rosdep would install, what apt, and what scripts/install."""

import ast
import os
import re
import unittest
import xml.etree.ElementTree

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))

# rosdep's keys of what is no ROS package, and Debian's packages for them.
SYSTEM = {
    "assimp-dev": {"libassimp-dev"},
    "boost": {"libboost-dev"},
    "bullet": {"libbullet-dev"},
    "cli11": {"libcli11-dev"},
    "eigen": {"libeigen3-dev"},
    "liburdfdom-dev": {"liburdfdom-dev"},
    "muparser": {"libmuparser-dev"},
    "ocl-icd-opencl-dev": {"ocl-icd-opencl-dev"},
    "opencl-headers": {"opencl-c-headers"},
    "pkg-config": {"pkg-config"},
    "pybind11-dev": {"pybind11-dev"},
    "python3-dev": {"python3-dev"},
    "python3-h5py": {"python3-h5py"},
    "python3-matplotlib": {"python3-matplotlib"},
    "python3-numpy": {"python3-numpy"},
    "python3-pandas": {"python3-pandas"},
    "python3-rospkg": {"python3-rospkg"},
    "python3-setuptools": {"python3-setuptools"},
    "python3-yaml": {"python3-yaml"},
    "yaml-cpp": {"libyaml-cpp-dev"},
    "zlib": {"zlib1g-dev"},
}
# What others of the list bring with them.
BROUGHT = {"message_runtime", "pkg-config", "python3-rospkg", "python3-setuptools", "rosgraph", "rosgraph_msgs", "roslz4"}
# What has no key of rosdep's, or is no dependency of a package: a compiler, what users look at topics with, what formats the sources.
WITHOUT_KEY = {
    "build-essential",
    "cmake",
    "pocl-opencl-icd",
    "python3-rosmsg",
    "python3-rosnode",
    "rosbash",
    "rospack-tools",
    "libgtest-dev",
    "oclgrind",
    "clang-format-15",
    "black",
}
OPTIONAL_GROUPS = {"render", "surface", "web", "mpi", "browser", "docs"}


def groups():
    """{group: packages}, as scripts/install reads them."""
    found, group = {}, None
    with open(os.path.join(ROOT, ".ci", "apt.txt"), encoding="utf-8") as file:
        for line in file:
            words = line.split()
            if line.startswith("#"):
                group = words[1] if len(words) == 2 else None
            elif words and group:
                found.setdefault(group, set()).add(words[0])
    return found


def candidates(key):
    name = key.replace("_", "-")
    return SYSTEM.get(key, {"lib%s-dev" % name, "ros-" + name, "python3-" + name, name})


class Dependencies(unittest.TestCase):
    def setUp(self):
        tree = xml.etree.ElementTree.parse(os.path.join(ROOT, "package.xml"))
        self.keys = {element.text for element in tree.getroot() if element.tag.endswith("depend")}
        self.groups = groups()
        self.packages = set().union(*self.groups.values())

    def test_what_package_xml_names_is_in_the_list(self):
        self.assertGreater(len(self.keys), 30)
        for key in sorted(self.keys - BROUGHT):
            self.assertTrue(candidates(key) & self.packages, key + " is in package.xml, but nothing in .ci/apt.txt is for it")

    def test_what_the_list_has_is_named_in_package_xml(self):
        covered = set().union(*(candidates(key) for key in self.keys))
        listed = set().union(*(packages for group, packages in self.groups.items() if group not in OPTIONAL_GROUPS))
        self.assertGreater(len(listed), 50)
        self.assertEqual(listed - WITHOUT_KEY - covered, set(), "are in .ci/apt.txt, but package.xml names nothing that they are for")

    def test_python_of_ros_that_the_tools_import_is_named(self):
        imported = set()
        for folder, _, names in os.walk(os.path.join(ROOT, "src", "python")):
            for name in names:
                if name.endswith(".py"):
                    with open(os.path.join(folder, name), encoding="utf-8") as file:
                        imported.update(re.findall(r"(?m)^ *(?:import|from) (\w+_msgs|ros\w+|tf2_\w+|interactive_markers)\b", file.read()))
        self.assertIn("rospy", imported)
        self.assertEqual({name for name in imported if name not in self.keys and "python3-" + name not in self.keys}, set())


class OldPython(unittest.TestCase):
    def test_every_file_is_python_3_8(self):
        """As far as its grammar goes: Ubuntu 20.04 has that one."""
        sources = []
        for folder in ("scripts", "src", "test", "config"):
            for where, _, names in os.walk(os.path.join(ROOT, folder)):
                for name in names:
                    with open(os.path.join(where, name), "rb") as file:
                        text = file.read()
                    if name.endswith(".py") or re.match(rb"#!.*python", text):
                        sources.append((os.path.join(where, name), text))
        self.assertGreater(len(sources), 80)
        for path, text in sources:
            ast.parse(text, path, feature_version=(3, 8))


class DebianPackages(unittest.TestCase):
    """debian/ goes by the same list."""

    def setUp(self):
        with open(os.path.join(ROOT, "debian", "control"), encoding="utf-8") as file:
            paragraphs = file.read().strip().split("\n\n")
        self.source, self.package, self.headers = (dict(re.findall(r"(?ms)^([\w-]+):(.*?)(?=^\S|\Z)", paragraph)) for paragraph in paragraphs)
        self.groups = groups()

    @staticmethod
    def names(field):
        return {match for part in field.split(",") for match in re.findall(r"^\s*([a-z][\w.+-]*)", part)}

    def test_is_built_with_the_lists_groups(self):
        wanted = self.groups["build"] | self.groups["python"] | self.groups["surface"]
        self.assertEqual(self.names(self.source["Build-Depends"]), (wanted - {"build-essential"}) | {"debhelper-compat", "dh-python"})

    def test_runs_with_the_lists_groups(self):
        self.assertEqual(self.names(self.package["Depends"]), self.groups["run"])
        self.assertLessEqual(self.groups["rviz"] | self.groups["tools"] | self.groups["web"], self.names(self.package["Recommends"]))

    def test_headers_come_with_those_that_they_include(self):
        self.assertLessEqual({"wavetank", "libeigen3-dev", "libroscpp-dev"}, self.names(self.headers["Depends"]))

    def test_version(self):
        with open(os.path.join(ROOT, "debian", "changelog"), encoding="utf-8") as file:
            (version,) = re.findall(r"^wavetank \((.*?)\)", file.readline())
        self.assertEqual(version, xml.etree.ElementTree.parse(os.path.join(ROOT, "package.xml")).find("version").text)


if __name__ == "__main__":
    unittest.main()
