#!/usr/bin/env python3
"""The case that the README shows is a case: wavetank_run --check takes it, word by word. Its programs, demos and pages are there."""

import os
import re
import shutil
import subprocess
import tempfile
import unittest

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))


class Readme(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.mkdtemp()
        with open(os.path.join(ROOT, "README.md"), encoding="utf-8") as file:
            self.text = file.read()

    def tearDown(self):
        shutil.rmtree(self.folder)

    def test_case_is_taken(self):
        (case,) = re.findall(r"```yaml\n(.*?)```", self.text, re.DOTALL)
        path = os.path.join(self.folder, "first.yaml")
        with open(path, "w", encoding="utf-8") as file:
            file.write(case)
        shutil.copy(os.path.join(ROOT, "meshes", "sphere.stl"), os.path.join(self.folder, "obstacle.stl"))
        check = subprocess.run([os.environ["WAVETANK_RUN"], "--check", path], stdout=subprocess.PIPE, stderr=subprocess.PIPE, universal_newlines=True)
        self.assertEqual(check.returncode, 0, check.stderr)
        self.assertRegex(check.stdout, r"(?m)^particles +7500,")

    def test_programs_are_where_rosrun_finds_them(self):
        programs = set(re.findall(r"rosrun wavetank (\w+)", self.text))
        self.assertLessEqual({"plot_motion", "plot_probes", "push_boat"}, programs)
        for program in programs:
            self.assertTrue(os.access(os.path.join(os.path.dirname(os.environ["WAVETANK_RUN"]), program), os.X_OK), program + " is not installed")
            self.assertFalse(os.access(os.path.join(ROOT, "scripts", program), os.X_OK), "rosrun would ask which " + program + " is meant")

    def test_demo_cases_are_listed(self):
        for case in os.listdir(os.path.join(ROOT, "config")):
            if case.endswith(".yaml"):
                self.assertIn("`%s`" % case, self.text)

    def test_links_lead_somewhere(self):
        links = [link for link in re.findall(r"(?<!!)\[[^]]*\]\(([^)]+)\)", self.text) if "://" not in link]
        self.assertGreater(len(links), 5)
        for link in links:
            self.assertTrue(os.path.exists(os.path.join(ROOT, link)), link)


if __name__ == "__main__":
    unittest.main()
