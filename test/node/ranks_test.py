#!/usr/bin/env python3
"""wavetank_run under mpirun (docs/distributed.md): the bits of one process, one voice, and an end whatever becomes of a rank."""

import os
import shutil
import signal
import subprocess
import sys
import time

import rosbag

import program_runner
from program_runner import PROGRAM, ProgramTest, interrupt, read_line_with

MPIRUN = shutil.which("mpirun")
RANKS = ["--oversubscribe", "--bind-to", "none", "--mca", "odls_base_sigkill_timeout", "2"]
# Root may run it, as in containers; every process has one of the cores; and no network is looked for.
SETTINGS = {
    "OMPI_ALLOW_RUN_AS_ROOT": "1",
    "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
    "OMPI_MCA_btl": "vader,self",
    "OMPI_MCA_btl_vader_single_copy_mechanism": "none",
    "OMPI_MCA_plm": "isolated",
    "POCL_MAX_PTHREAD_COUNT": "1",
}
# Water that runs out along a tank, over the step that the small case has.
DAM_BREAK = {
    "duration": 0.1,
    "fluid__sound_speed": 30.0,
    "fluid__fill": [{"box": {"min": [0, 0, 0], "max": [0.5, 0, 0.4]}}],
    "tank": {"box": {"size": [1.4, 0, 0.8]}},
    "bodies": [{"name": "step", "box": {"min": [0.8, -0.1, 0.0], "max": [0.9, 0.1, 0.08]}, "motion": "fixed"}],
    "numerics__precision": "single",
    "instruments": {"pressure_probes": [{"name": "P1", "position": [1.4, 0, 0.05]}], "rate": 100},
}


def sentences(text):
    """What the program itself has said on standard error; mpirun has words of its own."""
    return [line for line in text.splitlines() if line.startswith("wavetank_run: ")]


def parent_of(pid):
    with open("/proc/%s/stat" % pid) as file:
        return int(file.read().rsplit(")", 1)[1].split()[1])


def process_of_rank(mpirun, rank):
    for pid in filter(str.isdigit, os.listdir("/proc")):
        try:
            if parent_of(pid) == mpirun.pid:
                with open("/proc/%s/environ" % pid) as file:
                    if "OMPI_COMM_WORLD_RANK=%d" % rank in file.read().split("\0"):
                        return int(pid)
        except (OSError, ValueError):
            pass  # gone meanwhile
    raise AssertionError("mpirun has no rank %d" % rank)


def runs(pid):
    """Neither gone nor waiting to be taken note of."""
    try:
        with open("/proc/%d/stat" % pid) as file:
            return file.read().rsplit(")", 1)[1].split()[0] != "Z"
    except OSError:
        return False


class Ranks(ProgramTest):
    def setUp(self):
        super().setUp()
        self.environment = dict(os.environ, **SETTINGS)

    def dam_break(self, **changes):
        return self.case(**dict(DAM_BREAK, **changes))

    def mpirun(self, ranks, *arguments, more=(), options=RANKS):
        command = [MPIRUN, "-n", str(ranks)] + options + [PROGRAM] + list(arguments) + list(more)
        return subprocess.run(command, timeout=120, **self.surroundings())

    def surroundings(self):
        """In which mpirun runs."""
        streams = dict(stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE, universal_newlines=True)
        return dict(streams, cwd=self.folder, env=self.environment)

    def start(self, ranks, *arguments, options=RANKS):
        command = [MPIRUN, "-n", str(ranks)] + options + [PROGRAM] + list(arguments)
        process = subprocess.Popen(command, bufsize=1, **self.surroundings())

        def end():
            if process.poll() is None:
                process.terminate()
            process.communicate()

        self.addCleanup(end)
        return process

    def start_long_run(self, ranks):
        """Some steps into a run of minutes."""
        process = self.start(ranks, self.dam_break(duration=60.0), "--bag", "long.bag")
        read_line_with(process, "running ")  # of its first step
        time.sleep(0.5)
        return process

    def bytes_of(self, name):
        with open(self.path(name), "rb") as file:
            return file.read()

    def samples_of(self, name):
        with rosbag.Bag(self.path(name)) as bag:
            return bag.get_message_count("/wavetank/probes/P1")

    def test_any_number_of_them_has_the_bits_of_threads(self):
        self.expect_bits_of_threads(self.dam_break(), (1, 2, 3, 4))

    def test_bodies_too(self):
        """The step of the dam break, loose, and a box that floats in the water."""
        step = dict(DAM_BREAK["bodies"][0], motion="free", density=1500.0)
        box = {"name": "box", "box": {"min": [0.15, -0.1, 0.3], "max": [0.35, 0.1, 0.44]}, "motion": "free", "density": 500.0}
        self.expect_bits_of_threads(self.dam_break(bodies=[step, box]), (2, 3))

    def expect_bits_of_threads(self, case, numbers):
        one = self.run_program(case, "--device", "0:0,0:0", "--save", "threads.snapshot", env=self.environment)
        self.assert_runs(one)
        steps = next(line for line in one.stdout.splitlines() if line.startswith("steps"))
        self.assertGreater(int(steps.split()[1]), 100)
        for ranks in numbers:
            with self.subTest(ranks=ranks):
                result = self.mpirun(ranks, case, "--save", "ranks.snapshot", "--bag", "ranks.bag")
                self.assert_runs(result)
                self.assertEqual(result.stdout.count("\nsteps "), 1)
                self.assertEqual(sentences(result.stderr), [])
                self.assertIn(steps, result.stdout)
                self.assertEqual(self.bytes_of("ranks.snapshot"), self.bytes_of("threads.snapshot"))
                self.assertEqual(self.samples_of("ranks.bag"), 11)
                with rosbag.Bag(self.path("ranks.bag")) as bag:
                    statuses = [message for _, message, _ in bag.read_messages("/wavetank/status")]
                self.assertEqual(statuses[-1].parts, ranks)
                self.assertGreaterEqual(statuses[-1].imbalance, 1)
                self.assertGreater(statuses[-1].exchange_share, 0)
                self.assertLess(statuses[-1].exchange_share, 1)

    def test_a_case_that_cannot_be_cut_is_refused_once(self):
        corner = [{"box": {"min": [0, 0, 0], "max": [0.05, 0, 0.4]}}]
        result = self.mpirun(2, self.dam_break(fluid__fill=corner), "--bag", "refused.bag")
        self.assertEqual(result.returncode, 2)
        self.assertEqual(len(sentences(result.stderr)), 1, result.stderr)
        self.assertIn("wavetank_run: the water is to be cut into 2 parts, but it is too short for that: of its ", sentences(result.stderr)[0])
        self.assertNotIn("refused.bag", self.files())

    def test_a_violation_stops_all_with_the_sentence_of_threads(self):
        case = self.dam_break(fluid__sound_speed=3.0)
        threads = self.run_program(case, "--device", "0:0,0:0", "--save", "end.snapshot", env=self.environment)
        self.assertEqual(threads.returncode, 3, threads.stderr)
        ranks = self.mpirun(2, case, "--save", "end.snapshot")
        self.assertEqual(ranks.returncode, 3, ranks.stderr)
        told = [line.split("; its state is in")[0] for line in sentences(ranks.stderr)]
        self.assertEqual(told, [line.split("; its state is in")[0] for line in sentences(threads.stderr)])
        self.assertIn("faster than half the speed of sound", told[-1])

    def test_a_rank_that_is_killed_ends_the_run(self):
        process = self.start_long_run(2)
        began = time.time()
        os.kill(process_of_rank(process, 1), signal.SIGKILL)
        errors = process.communicate(timeout=30)[1]
        self.assertLess(time.time() - began, 10)
        self.assertNotEqual(process.returncode, 0)
        told = [line for line in sentences(errors) if "has ended without a word" in line]
        self.assertEqual(len(told), 1, errors)
        self.assertIn("part 1 of 2 (process ", told[0])
        self.assertGreater(self.samples_of("long.bag"), 0)

    def test_the_first_rank_that_is_killed_takes_the_others_with_it(self):
        process = self.start_long_run(2)
        other = process_of_rank(process, 1)
        os.kill(process_of_rank(process, 0), signal.SIGKILL)
        process.communicate(timeout=20)
        self.assertNotEqual(process.returncode, 0)
        end = time.time() + 5
        while runs(other) and time.time() < end:
            time.sleep(0.1)
        self.assertFalse(runs(other))

    def test_an_interrupt_ends_all(self):
        process = self.start_long_run(3)
        interrupt(process)
        output, errors = process.communicate(timeout=20)
        self.assertIn("(interrupted)", output, errors)
        self.assertEqual(sentences(errors), [])
        self.assertNotEqual(process.returncode, 0)
        self.assertGreater(self.samples_of("long.bag"), 0)

    def test_an_interrupt_of_the_start_is_told_of(self):
        """Compilers do not listen, and mpirun kills a second after it has asked."""
        self.environment["XDG_CACHE_HOME"] = self.path("no_kernels_yet")
        self.environment["WAVETANK_CACHE_DIRECTORY"] = ""
        process = self.start(2, self.dam_break(duration=60.0), "--bag", "begun.bag", options=["--oversubscribe", "--bind-to", "none"])
        read_line_with(process, "compiling kernels")
        time.sleep(0.5)
        interrupt(process)
        output = process.communicate(timeout=20)[0]
        self.assertIn("interrupted during the start: nothing was simulated and no bag is written", output)
        self.assertFalse([name for name in os.listdir(self.folder) if name.startswith("begun.bag")])

    def test_trouble_of_one_is_told_by_the_first(self):
        without_devices = [":", "-n", "1", "env", "OCL_ICD_VENDORS=/nowhere", PROGRAM]
        case = self.dam_break()
        result = self.mpirun(1, case, "--bag", "trouble.bag", more=without_devices)
        self.assertEqual(result.returncode, 2, result.stderr)
        told = sentences(result.stderr)
        self.assertEqual(len(told), 1, result.stderr)
        self.assertIn("part 1 of 2 (process ", told[0])
        self.assertIn("no OpenCL device", told[0])

    def test_one_that_is_bound_to_too_few_cores_is_told_of(self):
        del self.environment["POCL_MAX_PTHREAD_COUNT"]
        if len(os.sched_getaffinity(0)) < 2:
            self.skipTest("there is one core alone")
        bound = ["--oversubscribe", "--bind-to", "core"]
        result = self.mpirun(2, self.dam_break(duration=0.002), options=bound)
        self.assert_runs(result)
        told = sentences(result.stderr)
        self.assertEqual(len(told), 1, result.stderr)
        self.assertIn("may use 1 core, but", told[0])
        self.assertIn("--bind-to none", told[0])


if __name__ == "__main__":
    if os.environ.get("WAVETANK_MPI") != "ON" or MPIRUN is None:
        print("wavetank was built without MPI, or mpirun is not there: nothing to test (scripts/install --mpi)")
        sys.exit(0)
    program_runner.main()
