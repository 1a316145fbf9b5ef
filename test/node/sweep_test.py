#!/usr/bin/env python3
"""sweep: what it makes of its arguments, and the program as a user runs it on a tank of some hundred particles."""

import contextlib
import csv
import os
import signal
import subprocess
import sys
import time
import unittest
from unittest import mock

import numpy
import program_runner
from program_runner import PACKAGE, ProgramTest
from wavetank import Failure
from wavetank.recording import Table
from wavetank.runs import Run, Runner, fingerprint
from wavetank.sweep import combinations, figures_of, read_vary
from wavetank.tank_facts import checked

SCRIPT = os.path.join(PACKAGE, "scripts", "sweep")


class Arguments(unittest.TestCase):
    def test_values(self):
        self.assertEqual(read_vary("fluid/spacing=0.02,0.01"), ("fluid/spacing", ["0.02", "0.01"]))
        self.assertEqual(read_vary("fluid/sound_speed=10:20:3"), ("fluid/sound_speed", ["10", "15", "20"]))
        self.assertEqual(read_vary("gravity=[0,-9.81],[0,-1.62]"), ("gravity", ["[0,-9.81]", "[0,-1.62]"]))
        self.assertEqual(read_vary("tank/mesh=shape://box?size=1,2,3"), ("tank/mesh", ["shape://box?size=1", "2", "3"]))
        self.assertEqual(read_vary("device=0:1"), ("device", ["0:1"]))
        for text in ("fluid/spacing", "=1", "fluid/spacing=", "fluid/spacing=1,,2", "fluid/spacing=1,1"):
            with self.assertRaises(Failure):
                read_vary(text)

    def test_all_combinations_have_names_of_their_own(self):
        runs = combinations("c.yaml", [("fluid/spacing", ["1", "2"]), ("tank/box/size", ["[1,2]", "[1;2]"])], [("duration", "3")], [])
        names = [run.name for run in runs]
        self.assertEqual(names[0::2], ["spacing=1+size=_1_2_+1", "spacing=2+size=_1_2_+1"])
        self.assertEqual(len(set(names)), 4)
        self.assertEqual(runs[1].settings, [("duration", "3"), ("fluid/spacing", "1"), ("tank/box/size", "[1;2]")])
        names = [run.name for run in combinations("c.yaml", [("bodies/0/mass", ["1"]), ("bodies/1/mass", ["2"])], [], [])]
        self.assertEqual(names, ["bodies.0.mass=1+bodies.1.mass=2"])


class Figures(unittest.TestCase):
    def test_a_status_that_was_never_sent_is_no_figure(self):
        recording = mock.Mock(names=["status"])
        recording.table.return_value = Table("status", numpy.empty(0, numpy.int64), {}, {})
        with mock.patch("wavetank.sweep.Recording", return_value=recording):
            self.assertEqual(figures_of("out.bag", 0.0), {})


def end(process):
    with contextlib.suppress(ProcessLookupError):
        os.kill(process, signal.SIGKILL)


class Runs(ProgramTest):
    """Runner, with a program that does what a test wants in the place of wavetank_run."""

    def program(self, script):
        path = self.path("program")
        with open(path, "wb") as file:
            file.write(b'#!/bin/sh\n[ "$1" = --version ] && echo 1 && exit\n' + script)
        os.chmod(path, 0o755)
        return mock.patch.dict(os.environ, WAVETANK_RUN=path)

    def do(self, *runs):
        told = []
        results = Runner(self.path("out"), tell=told.append).do(list(runs))
        return results, told

    def test_a_run_whose_bag_was_removed_is_done_again(self):
        run = Run("one", self.case())
        with self.program(b': > "$3"\n'):
            self.assertTrue(self.do(run)[0][0].bag)
            self.assertEqual(self.do(run)[1], ["[1/1] one: done before"])
            os.remove(self.path("out/one/out.bag"))
            (result,), told = self.do(run)
        self.assertEqual(told[0], "[1/1] one: running")
        self.assertTrue(os.path.isfile(result.bag))

    def test_files_that_are_set_belong_to_a_run(self):
        for settings in ([("bodies/0/mesh", "a.stl")], [("bodies/0", "{mesh: a.stl}")]):
            with open(self.path("a.stl"), "w") as file:
                file.write("first")
            run = Run("one", self.case(), settings)
            before = fingerprint(run, "1")
            with open(self.path("a.stl"), "w") as file:
                file.write("second")
            after = fingerprint(run, "1")
            self.assertEqual([what for what in before if before[what] != after[what]], ["files that the case names"])

    def test_what_is_not_utf_8_does_no_harm(self):
        with self.program(b"printf 'wavetank_run: b\\303\\266se \\377\\n' >&2; exit 2\n"):
            (result,), _ = self.do(Run("one", self.case()))
            with self.assertRaisesRegex(Failure, "does not take the case: böse \ufffd"):
                checked("case.yaml")
        self.assertEqual(result.sentence, "böse \ufffd")

    def test_a_second_interrupt_leaves_nothing_running(self):
        case = self.case()
        with self.program(b"trap '' INT\necho $$ > \"$3.pid\"\nwhile :; do sleep 0.05; done\n"):
            process = subprocess.Popen(
                [sys.executable, SCRIPT, case, "--vary", "duration=1", "--out", "out"], cwd=self.folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE
            )
        self.addCleanup(process.communicate)
        self.addCleanup(process.kill)
        begin = time.time()
        while not (os.path.exists(self.path("out/duration=1/out.bag.pid")) and os.path.getsize(self.path("out/duration=1/out.bag.pid"))):
            self.assertLess(time.time(), begin + 30)
            time.sleep(0.02)
        with open(self.path("out/duration=1/out.bag.pid")) as file:
            ours = int(file.read())
        self.addCleanup(end, ours)
        process.send_signal(signal.SIGINT)
        time.sleep(0.5)
        self.assertIsNone(process.poll())  # it waits for its run
        process.send_signal(signal.SIGINT)
        self.assertEqual(process.wait(30), 130)
        with self.assertRaises(ProcessLookupError):
            os.kill(ours, 0)


class Program(ProgramTest):
    def sweep(self, *arguments):
        return subprocess.run(
            [sys.executable, SCRIPT] + list(arguments), cwd=self.folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, universal_newlines=True
        )

    def table(self):
        with open(self.path("out/table.csv"), newline="") as file:
            return list(csv.DictReader(file))

    def test_runs_all_goes_on_and_refuses_a_changed_case(self):
        case = self.case()
        command = [case, "--vary", "fluid/spacing=0.04,5.0,0.02", "--out", "out", "--set", "numerics/packing/iterations=0", "--duration", "0.02"]
        done = self.sweep(*command)
        self.assertEqual(done.returncode, 1, done.stdout + done.stderr)
        first, failed, last = self.table()
        self.assertEqual([row["exit code"] for row in (first, failed, last)], ["0", "2", "0"])
        self.assertEqual(last["fluid/spacing"], "0.02")
        self.assertIn("fluid/spacing", failed["failure"])
        self.assertIn("larger than the tank", failed["failure"])
        self.assertIn("spacing=5.0 failed: ", done.stdout)
        self.assertGreater(float(last["P1 peak (Pa)"]), 100.0)
        self.assertAlmostEqual(float(last["simulated (s)"]), 0.02, delta=0.002)
        self.assertGreater(int(last["steps"]), int(first["steps"]))
        for column in ("time a step (ms)", "kinetic energy at the end (J)", "tank mean force_z (N)"):
            float(last[column])
        self.assertEqual(
            [column for column in last if column.endswith("greatest (m)")], [name.replace("least", "greatest") for name in last if name.endswith("least (m)")]
        )

        written = os.stat(self.path("out/spacing=0.02/out.bag")).st_mtime_ns
        again = self.sweep(*command)
        self.assertEqual(again.stdout.count("done before"), 2)  # what failed may have been the machine's fault
        self.assertEqual(os.stat(self.path("out/spacing=0.02/out.bag")).st_mtime_ns, written)

        os.remove(self.path("out/spacing=0.04/run.json"))  # as a run that was killed leaves its folder
        with open(case, "a") as file:
            file.write("# another\n")
        refused = self.sweep(*command)
        self.assertEqual(refused.returncode, 2)
        self.assertEqual(len(refused.stderr.splitlines()), 1, refused.stderr)
        self.assertRegex(
            refused.stderr, r"^sweep: 'out/spacing=.*' was run before, but not with the same of: the case; --again runs it anew, another --out keeps both$"
        )
        anew = self.sweep("--again", *command)
        self.assertIn("it is run anew", anew.stdout)
        self.assertGreater(os.stat(self.path("out/spacing=0.02/out.bag")).st_mtime_ns, written)

    def test_ends_its_run_when_it_is_ended(self):
        command = [self.case(), "--vary", "fluid/spacing=0.02", "--out", "out", "--duration", "1000", "--set", "numerics/packing/iterations=0"]
        for number, code in ((signal.SIGINT, 130), (signal.SIGTERM, 143)):
            process = subprocess.Popen([sys.executable, SCRIPT] + command, cwd=self.folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
            begin = time.time()
            while not os.path.exists(self.path("out/spacing=0.02/out.bag.active")) and time.time() < begin + 60:
                time.sleep(0.05)
            process.send_signal(number)
            process.communicate(timeout=60)
            self.assertEqual(process.returncode, code)
            self.assertNotIn("out.bag.active", os.listdir(self.path("out/spacing=0.02")))  # nobody writes it any more
            self.assertFalse(os.path.exists(self.path("out/spacing=0.02/run.json")))

    def test_without_setup_bash_every_tool_says_so(self):
        tools = {}
        for name in os.listdir(os.path.dirname(SCRIPT)):
            with open(os.path.join(os.path.dirname(SCRIPT), name), encoding="utf-8") as file:
                text = file.read()
            if "from wavetank" in text and text.startswith("#!/usr/bin/env python3"):
                tools[name] = os.path.join(os.path.dirname(SCRIPT), name)
        self.assertLessEqual({"sweep", "render", "export", "waves", "plot_probes"}, set(tools))
        for name, path in sorted(tools.items()):
            bare = {"PATH": "/usr/bin:/bin", "HOME": self.folder}
            done = subprocess.run(
                ["/usr/bin/python3", path], env=bare, cwd=self.folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, universal_newlines=True
            )
            self.assertEqual(done.returncode, 2, name + ": " + done.stderr)
            self.assertRegex(done.stderr, r"^%s: No module named '[a-z]+': (source the setup\.bash of its workspace|install python3-)[^\n]*\n$" % name)
        bare = subprocess.run(["/usr/bin/python3", SCRIPT], env=bare, stderr=subprocess.PIPE, universal_newlines=True)
        self.assertEqual(bare.stderr, "sweep: No module named 'wavetank': source the setup.bash of its workspace, as in 'source devel/setup.bash'\n")

    def test_what_is_wrong_is_one_sentence(self):
        case = self.case()
        for arguments, sentence in (
            (["none.yaml", "--vary", "duration=1", "--out", "out"], "sweep: the case 'none.yaml' cannot be read: No such file or directory"),
            ([case, "--vary", "duration", "--out", "out"], "sweep: --vary 'duration' is not KEY=VALUE,VALUE,..."),
            ([case, "--vary", "duration=1", "--vary", "duration=2", "--out", "out"], "sweep: --vary duration is given twice"),
            ([case, "--vary", "duration=1", "--set", "duration=2", "--out", "out"], "sweep: 'duration' is both varied and set"),
            ([case, "--vary", "duration=1", "--out", case], "sweep: cannot make the folder '%s': File exists" % case),
        ):
            done = self.sweep(*arguments)
            self.assertEqual(done.returncode, 2)
            self.assertEqual(len(done.stderr.splitlines()), 1, done.stderr)
            self.assertIn(sentence, done.stderr)


if __name__ == "__main__":
    program_runner.main()
