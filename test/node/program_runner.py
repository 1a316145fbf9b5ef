"""Runs the package's programs for tests: a folder to work in, cases made from a small one, and what came out."""

import os
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest

import yaml

HERE = os.path.dirname(os.path.abspath(__file__))
PACKAGE = os.path.dirname(os.path.dirname(HERE))
PROGRAM = os.environ.get("WAVETANK_RUN", "wavetank_run")


class ProgramTest(unittest.TestCase):
    """A test in an empty folder of its own."""

    def setUp(self):
        self.folder = tempfile.mkdtemp(prefix="wavetank_test_")
        self.addCleanup(shutil.rmtree, self.folder, ignore_errors=True)

    def path(self, name):
        return os.path.join(self.folder, name)

    def files(self):
        return sorted(os.listdir(self.folder))

    def case(self, name="case.yaml", **changes):
        """The small case with keys replaced ('fluid/spacing' as fluid__spacing; None takes a key out), written to a file."""
        with open(os.path.join(HERE, "still_tank.yaml")) as file:
            tree = yaml.safe_load(file)
        for key, value in changes.items():
            *groups, last = key.split("__")
            group = tree
            for part in groups:
                group = group.setdefault(part, {})
            if value is None:
                group.pop(last, None)
            else:
                group[last] = value
        with open(self.path(name), "w") as file:
            yaml.safe_dump(tree, file)
        return self.path(name)

    def run_program(self, *arguments, timeout=120, **options):
        return subprocess.run(
            [PROGRAM] + list(arguments), cwd=self.folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, universal_newlines=True, timeout=timeout, **options
        )

    def start_program(self, *arguments, **options):
        process = subprocess.Popen(
            [PROGRAM] + list(arguments), cwd=self.folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, universal_newlines=True, bufsize=1, **options
        )

        def end():
            if process.poll() is None:
                process.kill()
            process.communicate()

        self.addCleanup(end)
        return process

    def small_disk(self, size):
        disk = self.path("disk")
        os.mkdir(disk)
        mount = ["mount", "-t", "tmpfs", "-o", "size=" + size, "tmpfs", disk]
        if os.geteuid() != 0 or subprocess.run(mount, stderr=subprocess.DEVNULL).returncode != 0:
            self.skipTest("a small disk to fill can only be mounted by root, outside a container that forbids it")
        self.addCleanup(subprocess.run, ["umount", disk], check=True)
        return disk

    def assert_refused(self, result, *words):
        """One clear sentence on standard error that has the words, exit code 2, no crash."""
        self.assertEqual(result.returncode, 2, result.stdout + result.stderr)
        lines = result.stderr.strip().splitlines()
        self.assertEqual(len(lines), 1, result.stderr)
        self.assertTrue(lines[0].startswith("wavetank_run: "), lines[0])
        for word in words:
            self.assertIn(word, lines[0])

    def assert_runs(self, result):
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)


def read_line_with(process, text, seconds=60):
    """Reads a program's output up to the first line that holds the text."""
    end = time.time() + seconds
    while time.time() < end:
        line = process.stdout.readline()
        if text in line:
            return line
        if not line:
            break
    raise AssertionError("the program never printed '%s'" % text)


def interrupt(process):
    process.send_signal(signal.SIGINT)


def main():
    if not shutil.which(PROGRAM):
        sys.exit("%s is not there: set WAVETANK_RUN to the program" % PROGRAM)
    unittest.main()
