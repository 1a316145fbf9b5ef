#!/usr/bin/env python3
"""docs/reliability.md, by wavetank_run: no input ends it by a signal or makes it wait, and no run takes what another one has made."""

import os
import random
import signal
import struct
import subprocess
import sys
import time

import rosbag

import program_runner
from program_runner import ProgramTest, interrupt, read_line_with

sys.path.insert(0, os.path.join(program_runner.PACKAGE, "test", "validation"))
import kills

BOX = {"name": "box", "box": {"min": [0.1, -0.1, 0.18], "max": [0.2, 0.1, 0.25]}, "motion": "free", "density": 500.0}

CORNERS = [(0, 0, 0), (0, 0.2, 0), (0.2, 0.2, 0), (0.2, 0, 0), (0, 0, 0.2), (0.2, 0, 0.2), (0.2, 0.2, 0.2), (0, 0.2, 0.2)]
TRIANGLES = [(0, 1, 2), (0, 2, 3), (4, 5, 6), (4, 6, 7), (0, 3, 5), (0, 5, 4), (3, 2, 6), (3, 6, 5), (2, 1, 7), (2, 7, 6), (1, 0, 4), (1, 4, 7)]

COLLADA = """<?xml version="1.0" encoding="utf-8"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1"><asset><unit name="meter" meter="1"/><up_axis>Z_UP</up_axis></asset>
<library_geometries><geometry id="g"><mesh><source id="p"><float_array id="pa" count="24">%s</float_array>
<technique_common><accessor source="#pa" count="8" stride="3"><param name="X" type="float"/><param name="Y" type="float"/><param name="Z" type="float"/></accessor>
</technique_common></source><vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="12"><input semantic="VERTEX" source="#v" offset="0"/><p>%s</p></triangles></mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s"><node id="n"><instance_geometry url="#g"/></node></visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#s"/></scene></COLLADA>
""" % (
    " ".join("%g" % c for corner in CORNERS for c in corner),
    " ".join("%d" % i for triangle in TRIANGLES for i in triangle),
)

PLY_HEADER = """ply
format %s 1.0
element vertex 8
property float x
property float y
property float z
element face 12
property list uchar int vertex_indices
end_header
"""


def text_ply():
    return PLY_HEADER % "ascii" + "".join("%g %g %g\n" % corner for corner in CORNERS) + "".join("3 %d %d %d\n" % triangle for triangle in TRIANGLES)


def binary_ply(shift, order="<"):
    name = {"<": "binary_little_endian", ">": "binary_big_endian"}[order]
    body = b"".join(struct.pack(order + "3f", *(c + shift for c in corner)) for corner in CORNERS)
    return (PLY_HEADER % name).encode() + body + b"".join(struct.pack(order + "B3i", 3, *triangle) for triangle in TRIANGLES)


class ReliabilityTest(ProgramTest):
    def both_refuse(self, case, *words, code=2):
        """The run and --check: one sentence with the words, soon, and nothing left."""
        before = self.files()
        for arguments in [("--check", case), (case, "--bag", "out.bag")]:
            begin = time.time()
            result = self.run_program(*arguments, timeout=120)
            if code == 2:  # what comes to its first forces may have to compile kernels before
                self.assertLess(time.time() - begin, 20)
            self.assertEqual(result.returncode, code if arguments[0] == case else 2, result.stdout + result.stderr)
            lines = result.stderr.strip().splitlines()
            self.assertEqual(len(lines), 1, result.stderr)
            for word in words:
                self.assertIn(word, lines[0])
            self.assertEqual(self.files(), before)


class Starts(ReliabilityTest):
    def test_what_moves_faster_than_the_sound_allows_is_refused(self):
        fast = self.case(bodies=[dict(BOX, velocity=[0, 0, -15])], instruments__pressure_probes=[])
        self.both_refuse(fast, "case.yaml:", "bodies/0/velocity", "fluid/sound_speed", "10 m/s", "choose")
        self.both_refuse(self.case(fluid__current=[0, 0, 1e10]), "fluid/current", "fluid/sound_speed")
        astray = self.case(bodies=[dict(BOX, velocity=[1e10, 0, 0])], fluid__sound_speed="auto", instruments__pressure_probes=[])
        self.both_refuse(astray, "fluid/sound_speed is auto", "1e+10 m/s")

    def test_a_violation_before_the_first_step_is_a_sentence(self):
        spinning = self.case(bodies=[dict(BOX, angular_velocity=[0, 1e5, 0])], instruments__pressure_probes=[])
        self.both_refuse(spinning, "body 'box'", "speed of sound", code=3)
        self.both_refuse(self.case(fluid__initial={"u": "15"}), "particle", "speed of sound", code=3)
        self.both_refuse(self.case(fluid__initial={"u": "1/(x-x)"}), "fluid/initial/u", "not finite")
        soft = self.case(fluid__sound_speed=0.3, bodies=[], numerics__packing={"iterations": 5, "settling": 3})
        self.both_refuse(soft, "speed of sound", code=3)

    def test_numbers_that_nothing_holds_are_refused_with_their_key(self):
        for changes, words in [
            (dict(fluid__density=1e39), ["case.yaml:", "fluid/density", "1e15"]),
            (dict(fluid__density=1e-300), ["case.yaml:", "fluid/density", "1e-20"]),
            (dict(gravity=[0, 0, 0], fluid__density=1e-19, fluid__sound_speed=1e-6), ["fluid/density", "fluid/sound_speed", "single precision"]),
            (dict(fluid__spacing=1e308), ["case.yaml:", "fluid/spacing", "1e15"]),
            (dict(fluid__spacing=1e-300), ["case.yaml:", "fluid/spacing", "1e-20"]),
            (dict(fluid__sound_speed=1e-3), ["fluid/sound_speed", "choose about"]),
            (dict(fluid__sound_speed=1e7), ["case.yaml:", "fluid/sound_speed", "1000000"]),
            (dict(fluid__viscosity=1e300), ["case.yaml:", "fluid/viscosity", "1e15"]),
            (dict(fluid__viscosity=1e14, duration=1e3), ["fluid/viscosity", "time step"]),
            (dict(numerics__courant=1e-300), ["case.yaml:", "numerics/courant", "1e-20"]),
            (dict(numerics__courant=1e-18), ["numerics/courant", "time step"]),
            (dict(gravity=[0, 0, -1e200]), ["case.yaml:", "gravity", "1e15"]),
            (dict(duration=1e300), ["case.yaml:", "duration", "1e15"]),
        ]:
            with self.subTest(str(changes)):
                self.both_refuse(self.case(**changes), *words)

    def test_a_body_without_end_is_told_within_a_second(self):
        endless = {"name": "box", "box": {"min": [0.1, -0.1, 0.05], "max": [0.2, 0.1, 1e9]}}
        begin = time.time()
        self.both_refuse(self.case(bodies=[endless], instruments__pressure_probes=[]), "body 'box'", "1e+09")
        self.assertLess(time.time() - begin, 4, "of two programs, on a busy machine")

    def test_a_section_without_end_is_refused(self):
        section = {"name": "wide", "centre": [0.3, 0, 0.2], "normal": [1, 0, 0], "size": [0, 1e15]}
        self.both_refuse(self.case(instruments__sections=[section]), "section 'wide'", "5e+16 cells")


class OtherRuns(ReliabilityTest):
    def test_two_runs_of_one_bag_do_not_meet(self):
        first = self.start_program(self.case(duration=1000.0), "--bag", "out.bag")
        read_line_with(first, "running")
        before = os.path.getsize(self.path("out.bag.active"))
        result = self.run_program(self.case("other.yaml"), "--set", "instruments/rate=100", "--bag", "out.bag")
        self.assert_refused(result, "out.bag", "another process is writing it")
        interrupt(first)
        self.assertEqual(first.wait(timeout=60), 130)
        self.assertGreater(os.path.getsize(self.path("out.bag")), before)
        with rosbag.Bag(self.path("out.bag")) as bag:
            found = [message.header.stamp.to_nsec() for _, message, _ in bag.read_messages(topics=["/wavetank/probes"])]
        self.assertEqual(found, [i * 1000000 for i in range(len(found))])

    def test_a_failure_takes_no_snapshots_place(self):
        fails = self.case("fails.yaml", duration=2.0, fluid__sound_speed=0.6, fluid__fill=[{"box": {"min": [0, 0, 0.1], "max": [0.1, 0, 0.38]}}], bodies=None)
        with open(self.path("run.snapshot"), "w") as file:
            file.write("precious")
        result = self.run_program(fails, "--bag", "run.bag")
        self.assertEqual(result.returncode, 3, result.stderr)
        self.assertIn("run.1.snapshot", result.stderr)
        with open(self.path("run.snapshot")) as file:
            self.assertEqual(file.read(), "precious")
        self.assertEqual(self.files(), ["fails.yaml", "run.1.snapshot", "run.bag", "run.snapshot"])


class Ends(ReliabilityTest):
    def assert_whole(self):
        with rosbag.Bag(self.path("out.bag")) as bag:
            found = [message.header.stamp.to_nsec() for _, message, _ in bag.read_messages(topics=["/wavetank/probes"])]
        self.assertEqual(found, [i * 1000000 for i in range(len(found))])
        self.assertFalse(os.path.exists(self.path("out.bag.active")))
        return len(found)

    def test_a_closed_pipe_costs_the_printing_only(self):
        run = self.start_program(self.case(duration=0.3), "--bag", "out.bag", "--save", "out.snapshot")
        run.stdout.readline()
        run.stdout.close()
        self.assertEqual(run.wait(timeout=120), 0, run.stderr.read())
        self.assertEqual(self.assert_whole(), 301)
        self.assertTrue(os.path.exists(self.path("out.snapshot")))
        run.stdout = open(os.devnull)

    def test_an_output_that_takes_nothing_is_a_sentence(self):
        case = self.case()
        for arguments in (["--check", case], ["--schedule", case], ["--list-devices"], ["--help"], ["--version"]):
            with self.subTest(arguments[0]), open("/dev/full", "w") as full:
                done = subprocess.run([program_runner.PROGRAM, *arguments], cwd=self.folder, stdout=full, stderr=subprocess.PIPE, universal_newlines=True)
                self.assertEqual(done.returncode, 2, done.stderr)
                self.assertEqual(done.stderr, "wavetank_run: standard output does not take all of what is printed: No space left on device\n")

    def test_hangup_sigterm_and_the_processor_limit_end_it_as_ctrl_c_does(self):
        for number in (signal.SIGHUP, signal.SIGTERM, signal.SIGXCPU):
            with self.subTest(number=number):
                run = self.start_program(self.case(duration=1000.0), "--bag", "out.bag", "--save", "out.snapshot")
                read_line_with(run, "running")
                run.send_signal(number)
                self.assertEqual(run.wait(timeout=60), 128 + number, run.stderr.read())
                self.assertGreater(self.assert_whole(), 0)
                self.assertIn("interrupted", run.stdout.read())
                for name in ("out.bag", "out.snapshot"):
                    os.remove(self.path(name))

    def test_a_second_sigterm_still_closes_the_bag(self):
        run = self.start_program(self.case(duration=1000.0), "--bag", "out.bag")
        read_line_with(run, "running")
        for _ in range(5):
            run.send_signal(signal.SIGTERM)
            run.send_signal(signal.SIGHUP)
        self.assertIn(run.wait(timeout=60), (128 + signal.SIGTERM, 128 + signal.SIGHUP), run.stderr.read())
        self.assert_whole()

    def test_nohup_stays_nohup(self):
        def ignore():
            signal.signal(signal.SIGHUP, signal.SIG_IGN)

        run = self.start_program(self.case(duration=0.3), "--bag", "out.bag", preexec_fn=ignore)
        read_line_with(run, "running")
        run.send_signal(signal.SIGHUP)
        self.assertEqual(run.wait(timeout=60), 0, run.stderr.read())
        self.assertEqual(self.assert_whole(), 301)


class KilledRuns(ReliabilityTest):
    def test_what_is_left_at_three_moments(self):
        """scripts/validate kills takes fifty."""
        seed = int(time.time())
        moments = random.Random(seed)
        runs = kills.Kills(program_runner.PROGRAM, self.path("runs"), duration=0.4)
        for _ in range(3):
            moment = runs.seconds * moments.uniform(0.4, 1)
            with self.subTest("seed %d, killed after %.3f s" % (seed, moment)):
                runs.kill_at(moment)

    def test_a_snapshot_on_the_way_that_cannot_be_written_ends_nothing(self):
        disk = self.small_disk("64k")
        with open(os.path.join(disk, "filler"), "w") as filler:
            filler.write("x" * 60000)
        done = self.run_program(self.case(), "--save", os.path.join(disk, "a.snapshot"), "--save-every", "0.01")
        self.assertEqual(done.returncode, 2, done.stderr)
        self.assertEqual(done.stderr.count("tries again at the next snapshot"), 1, done.stderr)
        self.assertIn("it is in '%s' instead" % self.path("a.snapshot"), done.stderr)


class Meshes(ReliabilityTest):
    def case_of(self, name, content):
        with open(self.path(name), "wb") as file:
            file.write(content if isinstance(content, bytes) else content.encode())
        return self.case(bodies=[{"name": "m", "mesh": name, "translation": [0.1, -0.1, 0.05]}], instruments__pressure_probes=[])

    def test_damaged_collada_is_a_sentence_within_a_second(self):
        self.assert_runs(self.run_program("--check", self.case_of("box.dae", COLLADA)))
        nested = COLLADA.replace("<instance_geometry", "<node>" * 20000 + "<instance_geometry").replace('"#g"/>', '"#g"/>' + "</node>" * 20000)
        cycle = COLLADA.replace("</visual_scene>", '<node id="m"><instance_node url="#n"/></node></visual_scene>')
        for what, text, words in [
            ("a decimal index", COLLADA.replace("<p>0 1", "<p>0.0 1"), ["line 6", "'0.0'", "whole number"]),
            ("a negative index", COLLADA.replace("<p>0 1", "<p>0 -1"), ["line 6", "'-1'"]),
            ("an index without end", COLLADA.replace("<p>0 1", "<p>0 1" + "0" * 300), ["line 6"]),
            ("an index beyond the vertices", COLLADA.replace("<p>0 1", "<p>0 8"), []),
            ("an array that says that it is empty", COLLADA.replace('count="24"', 'count="0"'), ["line 3", "float_array", "24 numbers"]),
            ("an array that says that it is shorter", COLLADA.replace('count="24"', 'count="3"'), ["line 3", "24 numbers"]),
            ("an array that says that it is longer", COLLADA.replace('count="24"', 'count="2400000000"'), ["line 3", "24 numbers"]),
            ("an accessor beyond its array", COLLADA.replace('count="8" stride', 'count="9" stride'), ["line 4", "accessor"]),
            ("a stride beyond it", COLLADA.replace('stride="3"', 'stride="1000"'), ["line 4", "accessor"]),
            ("no stride", COLLADA.replace('stride="3"', 'stride="0"'), ["line 4", "stride"]),
            ("an offset of an input", COLLADA.replace('offset="0"', 'offset="1000000000"'), []),
            ("a node that holds itself", COLLADA.replace('"#g"/>', '"#g"/><instance_node url="#n"/>'), ["line 7", "node 'n' holds itself"]),
            ("two that hold each other", cycle.replace('"#g"/>', '"#g"/><instance_node url="#m"/>'), ["line 7", "holds itself"]),
            ("nodes without end", nested, ["line 7", "nested"]),
            ("cut off", COLLADA[:900], []),
        ]:
            with self.subTest(what):
                begin = time.time()
                self.both_refuse(self.case_of("box.dae", text), "box.dae", *words)
                self.assertLess(time.time() - begin, 8, "of two programs, on a busy machine")

    def test_ply_is_read_whatever_byte_comes_first(self):
        for what, content in [
            ("a line feed, little", binary_ply(struct.unpack("<f", b"\n\xd7\x23\x3c")[0])),
            ("a line feed, big", binary_ply(struct.unpack(">f", b"\x0a\x23\xd7\x3c")[0] + 0.01, ">")),
            ("text", text_ply()),
            ("text with carriage returns", text_ply().replace("\n", "\r\n")),
        ]:
            with self.subTest(what):
                result = self.run_program("--check", self.case_of("box.ply", content))
                self.assert_runs(result)
                self.assertRegex(result.stdout, r"body m +0\.2 × 0\.2 m, 0\.04 m²")

    def test_damaged_ply_is_a_sentence_at_once(self):
        text = text_ply()
        for what, content, words in [
            ("a face of a hundred million corners", text.replace("\n3 0 1 2", "\n100000000 0 1 2"), ["line 18", "1e+08"]),
            ("less than none", text.replace("\n3 0 1 2", "\n-1 0 1 2"), ["line 18"]),
            ("more faces than bytes", text.replace("face 12", "face 999999999999"), ["999999999999"]),
            ("vertices without end", text.replace("vertex 8", "vertex 4000000000"), ["4000000000"]),
            ("a negative count", text.replace("vertex 8", "vertex -8"), ["line 3", "whole number"]),
            ("no vertex of that index", text.replace("\n3 0 1 2", "\n3 0 1 8"), ["line 18", "vertex 8", "there are 8"]),
            ("cut off", binary_ply(0)[:300], ["face"]),
            ("no coordinates", text.replace("float z", "float depth"), ["x, y and z"]),
        ]:
            with self.subTest(what):
                self.both_refuse(self.case_of("box.ply", content), "box.ply", *words)


class Messages(ReliabilityTest):
    def test_a_terminal_obeys_no_title(self):
        title = "\x1b[31mred\x1b[0m\x1b]0;owned\x07\x9b2J\r\n\u202e" + "long" * 1000
        case = self.case(title=title)
        for arguments in [("--check", case), (case,)]:
            result = self.run_program(*arguments)
            self.assert_runs(result)
            printed = result.stdout.replace("\n", "") + result.stderr.replace("\n", "")
            self.assertEqual([c for c in printed if ord(c) < 32 or 127 <= ord(c) < 160 or c == "\u202e"], [])
            self.assertIn(r"\x1b[31mred", printed)
            self.assertLess(max(len(line) for line in result.stdout.splitlines()), 300)

    def test_nor_a_key_nor_a_files_name(self):
        name = "a\x1b[2Jb.yaml"
        result = self.run_program(name)
        self.assert_refused(result, r"a\x1b[2Jb.yaml")
        self.assertNotIn("\x1b", result.stderr)


if __name__ == "__main__":
    program_runner.main()
