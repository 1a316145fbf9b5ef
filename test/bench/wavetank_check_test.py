#!/usr/bin/env python3
"""wavetank_check as a user meets it: its table and JSON, and what it refuses."""

import json
import os
import shutil
import subprocess
import tempfile
import unittest

PROGRAM = os.environ["WAVETANK_CHECK"]


class Check(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.mkdtemp(prefix="wavetank_test_")
        self.addCleanup(shutil.rmtree, self.folder)

    def run_program(self, *arguments):
        done = subprocess.run(
            [PROGRAM] + list(arguments), cwd=self.folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, universal_newlines=True, timeout=300
        )
        return done.returncode, done.stdout, done.stderr

    def test_checks_a_part(self):
        code, out, error = self.run_program("--part", "still_tank", "--json", "out.json")
        self.assertEqual(code, 0, out + error)
        self.assertIn("| still_tank | L2 error of the pressure ", out)
        self.assertIn("self-check: all is well", out)
        with open(os.path.join(self.folder, "out.json")) as file:
            results = json.load(file)
        (part,) = results["parts"]
        self.assertEqual((part["name"], part["ok"], results["ok"], results["whole"]), ("still_tank", True, True, True))

    def test_refuses_wrong_options_with_one_sentence(self):
        for arguments, word in [
            (["--part", "nothing_like_it"], "nothing_like_it"),
            (["--device", "no_such_device"], "no_such_device"),
            (["--json", "no/folder.json"], "no/folder.json"),
            (["--nonsense"], "--nonsense"),
        ]:
            with self.subTest(arguments):
                code, out, error = self.run_program(*arguments)
                self.assertEqual((code, out, len(error.splitlines())), (2, "", 1), error)
                self.assertTrue(error.startswith("wavetank_check: "), error)
                self.assertIn(word, error)
        self.assertEqual(os.listdir(self.folder), [])


if __name__ == "__main__":
    unittest.main()
