#!/usr/bin/env python3
"""wavetank_bench as a user meets it: its table and JSON, what it refuses, and how it ends."""

import json
import os
import shutil
import signal
import subprocess
import tempfile
import unittest

PROGRAM = os.environ["WAVETANK_BENCH"]
SMALL = "dam_break_2d/10k/h1.5/fourtakas/facet"


class Bench(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.mkdtemp(prefix="wavetank_test_")
        self.addCleanup(shutil.rmtree, self.folder)

    def start(self, *arguments):
        return subprocess.Popen(
            [PROGRAM] + list(arguments), cwd=self.folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, universal_newlines=True, bufsize=1
        )

    def run_program(self, *arguments):
        process = self.start(*arguments)
        out, error = process.communicate(timeout=300)
        return process.returncode, out, error

    def results(self):
        with open(os.path.join(self.folder, "out.json")) as file:
            return json.load(file)

    def test_measures_a_case(self):
        code, out, error = self.run_program("--filter", SMALL, "--repeat", "1", "--no-cold-build", "--json", "out.json")
        self.assertEqual(code, 0, error)
        self.assertIn("1 of 1: " + SMALL, error)
        results = self.results()
        (case,) = results["cases"]
        self.assertEqual(case["name"], SMALL)
        self.assertLess(abs(case["particles"] - 10000), 300)
        self.assertGreater(case["pairs_per_second"]["median"], 0)
        self.assertGreater(case["candidates_per_particle"]["median"], case["pairs_per_particle"]["median"])
        self.assertGreater(results["limits"]["flops_per_second"], 0)
        self.assertIsNone(case["cold_build_s"])
        for word in [SMALL, "momentum", "continuity", str(case["particles"])]:
            self.assertIn("| %s " % word, out)

    def test_lists_cases(self):
        code, out, _ = self.run_program("--list", "--filter", "2d/10k/h2/", "--filter", "ghost")
        self.assertEqual(code, 0)
        self.assertEqual(out.split(), ["dam_break_2d/10k/h2/%s/ghost" % diffusion for diffusion in ["fourtakas", "antuono", "none"]])

    def test_refuses_wrong_options_with_one_sentence(self):
        for arguments, word in [
            (["--filter", "nothing_like_it"], "nothing_like_it"),
            (["--device", "no_such_device"], "no_such_device"),
            (["--repeat", "0"], "--repeat 0"),
            (["--json", "no/folder.json"], "no/folder.json"),
            (["--nonsense"], "--nonsense"),
        ]:
            with self.subTest(arguments):
                code, out, error = self.run_program(*arguments)
                self.assertEqual((code, out, len(error.splitlines())), (2, "", 1), error)
                self.assertTrue(error.startswith("wavetank_bench: "), error)
                self.assertIn(word, error)
        self.assertEqual(os.listdir(self.folder), [])

    def test_ends_with_what_it_has(self):
        process = self.start("--filter", "2d/10k/h1.5/fourtakas/facet", "--repeat", "1000", "--no-cold-build", "--json", "out.json")
        while SMALL not in process.stderr.readline():
            pass
        process.send_signal(signal.SIGINT)
        out, error = process.communicate(timeout=60)
        self.assertEqual(process.returncode, 130, error)
        self.assertIn("interrupted", out)
        self.assertTrue(self.results()["interrupted"])


if __name__ == "__main__":
    unittest.main()
