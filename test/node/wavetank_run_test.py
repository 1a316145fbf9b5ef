#!/usr/bin/env python3
"""wavetank_run as a user meets it: what it prints, writes, refuses, and how it ends."""

import glob
import os
import re
import resource
import shutil
import signal
import socket
import stat
import subprocess
import time
import unittest

import numpy
import rosbag
from visualization_msgs.msg import Marker

import program_runner
from program_runner import PACKAGE, ProgramTest, interrupt, read_line_with

BODY = {"name": "step", "box": {"min": [0.16, -0.1, 0.0], "max": [0.24, 0.1, 0.08]}, "motion": "fixed"}


def stamps(path, topic):
    with rosbag.Bag(path) as bag:
        return [message.header.stamp.to_nsec() for _, message, _ in bag.read_messages(topics=[topic])]


def milliseconds(count):
    return [i * 1000000 for i in range(count)]


# Waves of a few spacings, in three dimensions, for a picture in minutes: --check says so, and their pages too.
COARSE_SEAS = ("boat_in_a_sea.yaml", "wave_basin_robot.yaml")


class DemoCases(ProgramTest):
    def test_each_is_sound(self):
        cases = sorted(glob.glob(os.path.join(PACKAGE, "config", "*.yaml")))
        self.assertGreaterEqual(len(cases), 4)
        for case in cases:
            with self.subTest(os.path.basename(case)):
                result = self.run_program("--check", case, "--set", "numerics/packing/iterations=0")
                self.assert_runs(result)
                coarse = [line for line in result.stderr.splitlines() if "spacings high: fewer than 8 decay" in line]
                self.assertEqual(len(coarse), 1 if os.path.basename(case) in COARSE_SEAS else 0)
                self.assertEqual([line for line in result.stderr.splitlines() if line not in coarse], [])

    def test_gauges_of_the_tanks_at_rest_read_its_level(self):
        for name, level, tolerance in [("still_tank_3d.yaml", 0.36, 0.01), ("hydrostatic_2d.yaml", 0.092, 0.002)]:
            with self.subTest(name):
                case = os.path.join(PACKAGE, "config", name)
                self.assert_runs(self.run_program(case, "--bag", "rest.bag", "--duration", "0.01", "--set", "numerics/packing/iterations=30"))
                with rosbag.Bag(self.path("rest.bag")) as bag:
                    gauges = [message for _, message, _ in bag.read_messages(topics=["/wavetank/gauges"])][-1]
                self.assertGreater(len(gauges.levels), 0)
                for gauge, found in zip(gauges.names, gauges.levels):
                    self.assertLess(abs(found - level), tolerance, gauge)


class Information(ProgramTest):
    def test_help_names_every_option_and_exit_code(self):
        result = self.run_program("--help")
        self.assert_runs(result)
        for word in [
            "--bag",
            "--clouds",
            "--surface",
            "--duration",
            "--set",
            "--device",
            "--restore",
            "--save",
            "--profile",
            "--check",
            "--list-devices",
            "Exit code",
        ]:
            self.assertIn(word, result.stdout)

    def test_version(self):
        result = self.run_program("--version")
        self.assert_runs(result)
        self.assertRegex(result.stdout, r"^wavetank \d+\.\d+\.\d+\n$")

    def test_devices(self):
        result = self.run_program("--list-devices")
        self.assert_runs(result)
        self.assertRegex(result.stdout, r"^\d+:\d+ ")

    def test_check_reports_and_writes_nothing(self):
        result = self.run_program("--check", self.case())
        self.assert_runs(result)
        for word in ["particles", "wall elements", "memory", "estimated time"]:
            self.assertIn(word, result.stdout)
        self.assertEqual(result.stderr, "")
        self.assertEqual(self.files(), ["case.yaml"])

    def test_check_tells_sizes_masses_and_draughts(self):
        raft = {"name": "raft", "box": {"min": [0.1, -1, 0.15], "max": [0.3, 1, 0.25]}, "motion": "free", "density": 300}
        stone = {"name": "stone", "box": {"min": [0.32, -1, 0.05], "max": [0.38, 1, 0.11]}, "motion": "free", "density": 2000}
        result = self.run_program("--check", self.case(bodies=[raft, stone], instruments__pressure_probes=[], duration=2.0))
        self.assert_runs(result)
        lines = {line[:17].strip(): line[18:] for line in result.stdout.splitlines() if len(line) > 18}
        self.assertEqual(lines["tank"], "0.4 × 0.4 m, holds 0.16 m²")
        self.assertEqual(lines["body raft"], "0.2 × 0.1 m, 0.02 m², 6 kg/m, afloat upright its draught is 0.03 m")
        self.assertEqual(lines["body stone"], "0.06 × 0.06 m, 0.0036 m², 7.2 kg/m, sinks")
        self.assertRegex(lines["water"], r"^0\.0\d+ m², \d+\.?\d* kg/m$")
        self.assertEqual(lines["least depth"], "0.2 m, 10 particles")
        self.assertEqual(lines["least thickness"], "0.06 m, 3 particles, of body stone")
        self.assertRegex(lines["estimated time"], r"\(start .*, steps .*, instruments .*\)$")

    def test_shallow_water_is_told_before_and_while_it_runs(self):
        case = self.case(bodies=[], fluid__fill=[{"box": {"min": [0, 0, 0], "max": [0.4, 0, 0.05]}}])
        for arguments in [("--check", case), (case, "--quiet")]:
            result = self.run_program(*arguments)
            self.assert_runs(result)
            self.assertIn("spacings deep", result.stderr)
            self.assertIn("fluid/spacing", result.stderr)
            self.assertEqual(len(result.stderr.splitlines()), 1)
        self.assert_refused(self.run_program("--check", self.case(fluid__spacing=5.0, bodies=[])), "fluid/spacing", "larger than the tank")


class Bags(ProgramTest):
    def test_holds_every_sample_exactly_once(self):
        self.assert_runs(self.run_program(self.case(), "--bag", "out.bag", "--clouds"))
        self.assertEqual(self.files(), ["case.yaml", "out.bag"])
        bag = self.path("out.bag")
        for topic in ["probes", "probes/P1", "probes/P2", "gauges", "bodies/tank/wrench", "bodies/step/wrench", "bodies/step/wrench/pressure"]:
            self.assertEqual(stamps(bag, "/wavetank/" + topic), milliseconds(51), topic)

    def test_has_the_nodes_topics_types_and_frames(self):
        self.assert_runs(self.run_program(self.case(), "--bag", "out.bag", "--clouds"))
        with rosbag.Bag(self.path("out.bag")) as bag:
            kinds = {topic: info.msg_type for topic, info in bag.get_type_and_topic_info()[1].items()}
            first = {topic: message for topic, message, _ in reversed(list(bag.read_messages()))}
            latched = {c.topic for c in bag._get_connections() if c.header.get("latching") in ("1", b"1")}
        self.assertEqual(kinds["/wavetank/probes"], "wavetank/ProbeArray")
        self.assertEqual(kinds["/wavetank/gauges"], "wavetank/WaveGaugeArray")
        self.assertEqual(kinds["/wavetank/probes/P1"], "sensor_msgs/FluidPressure")
        self.assertEqual(kinds["/wavetank/bodies/step/wrench"], "geometry_msgs/WrenchStamped")
        self.assertEqual(kinds["/wavetank/status"], "wavetank/SolverStatus")
        self.assertEqual(kinds["/wavetank/free_surface"], "sensor_msgs/PointCloud2")
        self.assertEqual(latched, {"/wavetank/markers", "/wavetank/case", "/tf_static"})
        self.assertEqual(first["/wavetank/probes"].header.frame_id, "tank")
        self.assertEqual(list(first["/wavetank/probes"].names), ["P1", "P2"])
        self.assertEqual(first["/wavetank/probes/P1"].header.frame_id, "tank/probes/P1")
        self.assertEqual(first["/wavetank/bodies/step/wrench"].header.frame_id, "tank/bodies/step")
        self.assertIn("A small tank at rest", first["/wavetank/case"].data)

    def test_holds_the_surface_of_the_water(self):
        result = self.run_program(self.case(), "--bag", "out.bag", "--surface", "--set", "rates/surface_bag=50")
        if "OpenVDB" in result.stderr:
            self.assert_refused(result, "scripts/install --surface")
            self.assertEqual(self.files(), ["case.yaml"])
            return
        self.assert_runs(result)
        with rosbag.Bag(self.path("out.bag")) as bag:
            markers = [message for _, message, _ in bag.read_messages("/wavetank/surface_mesh")]
            maps = [message for _, message, _ in bag.read_messages("/wavetank/height_map")]
        surfaces = [marker for marker in markers if marker.ns == "surface"]
        self.assertEqual(sorted({marker.ns for marker in markers}), ["spray", "surface"])
        self.assertEqual(len(markers), 2 * len(surfaces))
        self.assertEqual([round(marker.header.stamp.to_sec() / 0.02) for marker in surfaces], [0, 1, 2])
        self.assertEqual([image.header.stamp for image in maps], [marker.header.stamp for marker in surfaces])
        for marker in surfaces:
            self.assertEqual((marker.header.frame_id, marker.type, marker.action), ("tank", Marker.TRIANGLE_LIST, Marker.ADD))
            corners = numpy.array([(point.x, point.y, point.z) for point in marker.points]).reshape(-1, 3, 3)
            volume = numpy.linalg.det(corners).sum() / 6
            self.assertAlmostEqual(volume, (0.4 * 0.2 - 0.08 * 0.08) * 0.02, delta=0.03 * 0.08 * 0.02)
        self.assertEqual((maps[0].encoding, maps[0].width, maps[0].height), ("32FC1", 1, 20))
        heights = numpy.frombuffer(maps[0].data, numpy.float32)
        # a tenth of the spacing; beside the walls of a 2-D tank the surface is up to a quarter of it too low, as docs/pictures.md says
        self.assertLess(abs(heights[2:-2] - 0.2).max(), 0.002, heights)
        self.assertLess(abs(heights - 0.2).max(), 0.006, heights)

    def test_holds_the_poses_of_what_moves(self):
        case = os.path.join(PACKAGE, "test", "node", "floating_box.yaml")
        self.assert_runs(self.run_program(case, "--bag", "out.bag", "--duration", "0.05", "--set", "tank/motion=commanded"))
        poses = [i * 2000000 for i in range(26)]
        for topic in ["bodies/tank/odom", "bodies/box/odom", "bodies/trolley/odom", "joint_states"]:
            self.assertEqual(stamps(self.path("out.bag"), "/wavetank/" + topic), poses, topic)
        with rosbag.Bag(self.path("out.bag")) as bag:
            kinds = {topic: info.msg_type for topic, info in bag.get_type_and_topic_info()[1].items()}
            transforms = [message.transforms for _, message, _ in bag.read_messages(topics=["/tf"])]
            static = [t.child_frame_id for _, message, _ in bag.read_messages(topics=["/tf_static"]) for t in message.transforms]
        self.assertEqual(kinds["/wavetank/bodies/box/odom"], "nav_msgs/Odometry")
        self.assertEqual(kinds["/wavetank/joint_states"], "sensor_msgs/JointState")
        self.assertNotIn("/wavetank/bodies/step/odom", kinds)
        self.assertEqual(static, ["tank/probes/P1", "tank/bodies/step", "tank/bodies/box/imu"])
        self.assertEqual([message[0].header.stamp.to_nsec() for message in transforms], poses)
        for message in transforms:
            frames = [(t.header.frame_id, t.child_frame_id) for t in message]
            self.assertEqual(frames, [("world", "tank")] + [("tank", "tank/bodies/" + body) for body in ("box", "trolley", "paddle")])
            self.assertEqual(len({t.header.stamp for t in message}), 1)

    def test_holds_every_instrument_on_a_topic_of_its_own(self):
        case = os.path.join(PACKAGE, "test", "node", "floating_box.yaml")
        self.assert_runs(self.run_program(case, "--bag", "out.bag", "--duration", "0.05"))
        kinds, counts, points, levels = {}, {}, [], []
        with rosbag.Bag(self.path("out.bag")) as bag:
            for topic, info in bag.get_type_and_topic_info()[1].items():
                kinds[topic[len("/wavetank/") :]], counts[topic[len("/wavetank/") :]] = info.msg_type, info.message_count
            for topic, message, _ in bag.read_messages(topics=["/wavetank/gauges", "/wavetank/gauges/H1"]):
                (points if topic.endswith("H1") else levels).append(message)
        for topic, kind, count in (
            ("gauges/H1", "geometry_msgs/PointStamped", 51),
            ("velocities/V1", "geometry_msgs/Vector3Stamped", 51),
            ("sections/S1", "wavetank/SectionFlow", 51),
            ("bodies/box/imu", "sensor_msgs/Imu", 26),
            ("bodies/box/moorings/chain/tension", "wavetank/MooringTension", 26),
        ):
            self.assertEqual((kinds[topic], counts[topic]), (kind, count), topic)
        self.assertEqual(counts["markers"], 3, "all at the start, and the moorings at 0 and 0.05 s")
        self.assertEqual([p.header.stamp for p in points], [l.header.stamp for l in levels])
        self.assertEqual([p.point.z for p in points], [l.levels[0] for l in levels])

    def test_the_case_in_a_bag_repeats_the_run(self):
        self.assert_runs(self.run_program(self.case(), "--bag", "first.bag", "--set", "fluid/density=998"))
        with rosbag.Bag(self.path("first.bag")) as bag:
            text = next(bag.read_messages(topics=["/wavetank/case"])).message.data
        with open(self.path("again.yaml"), "w") as file:
            file.write(text)
        self.assert_runs(self.run_program("again.yaml", "--bag", "second.bag"))

        def pressures(name):
            with rosbag.Bag(self.path(name)) as bag:
                return [message.pressures for _, message, _ in bag.read_messages(topics=["/wavetank/probes"])]

        self.assertEqual(pressures("first.bag"), pressures("second.bag"))

    def test_replaces_an_older_bag_only_when_done(self):
        with open(self.path("out.bag"), "w") as file:
            file.write("old")
        self.assert_refused(self.run_program(self.case(), "--bag", "out.bag", "--device", "no such device"))
        with open(self.path("out.bag")) as file:
            self.assertEqual(file.read(), "old")
        self.assert_runs(self.run_program(self.case(), "--bag", "out.bag"))
        self.assertEqual(len(stamps(self.path("out.bag"), "/wavetank/probes")), 51)

    def test_a_bag_is_written_by_one_run_at_a_time(self):
        first = self.start_program(self.case(duration=1000.0), "--bag", "out.bag")
        read_line_with(first, "running")
        self.assert_refused(self.run_program(self.case("other.yaml"), "--bag", "out.bag"), "out.bag", "another process")
        interrupt(first)
        self.assertEqual(first.wait(timeout=30), 130)
        found = stamps(self.path("out.bag"), "/wavetank/probes")
        self.assertEqual(found, milliseconds(len(found)))
        self.assertEqual(self.files(), ["case.yaml", "other.yaml", "out.bag"])

    def test_what_a_killed_run_left_is_kept(self):
        for left in [["out.bag.active"], ["out.bag.1.active", "out.bag.active"]]:
            run = self.start_program(self.case(duration=1000.0, instruments__rate=20000), "--bag", "out.bag")
            read_line_with(run, "running")
            deadline = time.time() + 60
            while os.path.getsize(self.path("out.bag.active")) < 2000000:
                self.assertLess(time.time(), deadline)
                time.sleep(0.02)
            run.kill()
            run.wait()
            self.assertEqual(self.files(), ["case.yaml"] + left)
        result = self.run_program(self.case(), "--bag", "out.bag")
        self.assert_runs(result)
        self.assertIn("out.bag.2.active", result.stderr)
        self.assertEqual(self.files(), ["case.yaml", "out.bag", "out.bag.1.active", "out.bag.2.active"])
        self.assertEqual(len(stamps(self.path("out.bag"), "/wavetank/probes")), 51)
        subprocess.run(["rosbag", "reindex", "--quiet", "out.bag.1.active"], cwd=self.folder, check=True)
        found = stamps(self.path("out.bag.1.active"), "/wavetank/probes")
        self.assertGreater(len(found), 100)
        self.assertEqual(found, [i * 50000 for i in range(len(found))])

    def test_duration_and_set_replace_keys(self):
        self.assert_runs(self.run_program(self.case(), "--bag", "out.bag", "--duration", "0.02", "--set", "instruments/rate=500"))
        self.assertEqual(stamps(self.path("out.bag"), "/wavetank/probes"), [i * 2000000 for i in range(11)])


class Output(ProgramTest):
    def test_plain_lines_and_a_summary_when_not_on_a_terminal(self):
        result = self.run_program(self.case())
        self.assert_runs(result)
        self.assertEqual(result.stderr, "")
        self.assertNotIn("\r", result.stdout)
        self.assertIn("running", result.stdout)
        for word in ["simulated time", "steps", "wall time", "particle-steps/s", "guard hits"]:
            self.assertIn(word, result.stdout)

    def test_a_bar_on_a_terminal(self):
        try:
            for end in os.openpty():
                os.close(end)
        except OSError:
            self.skipTest("this system has no pseudo-terminals")
        result = subprocess.run(
            ["script", "-qec", "%s %s" % (program_runner.PROGRAM, self.case()), "/dev/null"],
            cwd=self.folder,
            stdout=subprocess.PIPE,
            stdin=subprocess.DEVNULL,
            timeout=120,
        )
        self.assertEqual(result.returncode, 0)
        self.assertIn(b"\r", result.stdout)
        self.assertIn(b"running [", result.stdout)

    def test_quiet_prints_nothing(self):
        result = self.run_program(self.case(), "--quiet")
        self.assert_runs(result)
        self.assertEqual(result.stdout + result.stderr, "")

    def test_profile_lists_kernels(self):
        result = self.run_program(self.case(), "--profile")
        self.assert_runs(result)
        self.assertIn("launches", result.stdout)


class Endings(ProgramTest):
    def test_ctrl_c_leaves_a_readable_bag(self):
        process = self.start_program(self.case(duration=5.0), "--bag", "out.bag", "--save", "end.snapshot")
        read_line_with(process, "running  10 %")
        interrupt(process)
        self.assertEqual(process.wait(timeout=30), 130)
        self.assertEqual(self.files(), ["case.yaml", "end.snapshot", "out.bag"])
        found = stamps(self.path("out.bag"), "/wavetank/probes")
        self.assertEqual(found, milliseconds(len(found)))
        self.assertGreater(len(found), 1)

    def test_ctrl_c_during_the_start_leaves_nothing(self):
        process = self.start_program(self.case(fluid__spacing=0.002), "--bag", "out.bag")
        read_line_with(process, "%")
        interrupt(process)
        self.assertEqual(process.wait(timeout=30), 130)
        self.assertEqual(self.files(), ["case.yaml"])

    def test_ctrl_c_while_kernels_are_compiled_leaves_nothing(self):
        # a compiler behind OpenCL that hears the signal itself removes what it is writing, and fails
        for attempt in range(3):
            with self.subTest(attempt=attempt):
                cache = os.path.join(self.folder, "cache")
                environment = dict(os.environ, XDG_CACHE_HOME=cache)
                process = self.start_program(self.case(), "--bag", "out.bag", env=environment)
                deadline = time.time() + 60
                while not glob.glob(cache + "/**/*.cl.tmp", recursive=True) and process.poll() is None and time.time() < deadline:
                    pass
                time.sleep(0.1 * attempt)
                interrupt(process)
                self.assertEqual(process.wait(timeout=60), 130, process.stderr.read())
                shutil.rmtree(cache)
                self.assertEqual(self.files(), ["case.yaml"])

    def test_a_violation_ends_the_bag_and_writes_a_snapshot(self):
        # A speed of sound far below the fall's own speed: the watchdog's bound of half of it is passed at once.
        case = self.case(
            duration=2.0,
            fluid__sound_speed=0.6,
            fluid__fill=[{"box": {"min": [0, 0, 0.1], "max": [0.1, 0, 0.38]}}],
            bodies=None,
        )
        result = self.run_program(case, "--bag", "out.bag")
        self.assertEqual(result.returncode, 3, result.stdout + result.stderr)
        self.assertEqual(self.files(), ["case.yaml", "out.bag", "out.snapshot"])
        self.assertIn("particle", result.stderr)
        self.assertIn("out.snapshot", result.stderr)
        with rosbag.Bag(self.path("out.bag")) as bag:
            last = [message for _, message, _ in bag.read_messages(topics=["/wavetank/status"])][-1]
        self.assertEqual(last.phase, last.FAILED)
        self.assertIn("particle", last.failure)


class Snapshots(ProgramTest):
    def test_a_restored_run_goes_on_bit_for_bit(self):
        case = self.case()
        self.assert_runs(self.run_program(case, "--bag", "whole.bag"))
        self.assert_runs(self.run_program(case, "--bag", "first.bag", "--duration", "0.02", "--save", "middle.snapshot"))
        self.assert_runs(self.run_program(case, "--bag", "second.bag", "--restore", "middle.snapshot"))

        def pressures(name):
            with rosbag.Bag(self.path(name)) as bag:
                return {message.header.stamp.to_nsec(): message.pressures for _, message, _ in bag.read_messages(topics=["/wavetank/probes"])}

        whole, second = pressures("whole.bag"), pressures("second.bag")
        self.assertGreater(len(second), 20)
        for stamp, values in second.items():
            self.assertEqual(values, whole[stamp], stamp)

    def test_truncated_and_foreign_snapshots_are_refused(self):
        case = self.case()
        self.assert_runs(self.run_program(case, "--duration", "0.01", "--save", "a.snapshot"))
        with open(self.path("a.snapshot"), "rb") as file:
            whole = file.read()
        for length in [0, 7, len(whole) // 2, len(whole) - 1]:
            with open(self.path("cut.snapshot"), "wb") as file:
                file.write(whole[:length])
            self.assert_refused(self.run_program(case, "--restore", "cut.snapshot"), "cut.snapshot")
        self.assert_refused(self.run_program(case, "--restore", "case.yaml"), "case.yaml")
        self.assert_refused(self.run_program(case, "--restore", "none.snapshot"), "none.snapshot")
        other = self.case("other.yaml", fluid__density=990.0)
        self.assert_refused(self.run_program(other, "--restore", "a.snapshot"), "a.snapshot")

    def test_a_place_that_cannot_be_written_is_told_before_the_start(self):
        result = self.run_program(self.case(), "--save", "no/such/end.snapshot")
        self.assert_refused(result, "no/such/end.snapshot")
        self.assertNotIn("%", result.stdout)


class Refusals(ProgramTest):
    def test_command_lines(self):
        self.assert_refused(self.run_program(), "CASE.yaml")
        self.assert_refused(self.run_program(self.case(), "--nonsense"), "--nonsense")
        self.assert_refused(self.run_program(self.case(), "--set", "duration"), "duration")
        self.assert_refused(self.run_program(self.case(), "--clouds"), "--bag")
        self.assert_refused(self.run_program(self.case(), "--surface"), "--bag")
        self.assert_refused(self.run_program(self.case(), "--bag", "out", "--save", "./out"), "--bag and --save")
        self.assert_refused(self.run_program("no_such_case.yaml"), "no_such_case.yaml")

    def test_unwritable_bags_are_told_before_the_start(self):
        for name in ["no/such/out.bag", ".", "/proc/out.bag"]:
            result = self.run_program(self.case(), "--bag", name)
            self.assert_refused(result, name)
            self.assertNotIn("%", result.stdout)
        self.assertEqual(self.files(), ["case.yaml"])

    def test_nothing_but_plain_files_is_written_or_replaced(self):
        case = self.case()
        with open(self.path("precious"), "w") as file:
            file.write("kept")
        os.mkdir(self.path("folder"))
        os.mkfifo(self.path("pipe"))
        os.symlink("precious", self.path("link"))
        os.symlink("nowhere", self.path("dangling"))
        listener = socket.socket(socket.AF_UNIX)
        self.addCleanup(listener.close)
        listener.bind(self.path("socket"))
        places = {"folder": "a folder", "pipe": "a pipe", "link": "a link", "dangling": "a link", "socket": "a socket"}
        try:
            os.mknod(self.path("device"), stat.S_IFCHR | 0o600, os.makedev(1, 3))
            places["device"] = "a device"
        except PermissionError:
            places["/dev/null"] = "a device"  # which only root could replace
        kinds = {name: os.lstat(self.path(name)).st_mode for name in self.files()}
        for option in ["--bag", "--save"]:
            for name, kind in places.items():
                with self.subTest(option + " " + name):
                    result = self.run_program(case, option, name)
                    self.assert_refused(result, name, kind)
                    self.assertNotIn("%", result.stdout)
        for name in ["pipe", "link", "dangling", "folder"]:
            os.rename(self.path(name), self.path("out.bag.active"))
            self.assert_refused(self.run_program(case, "--bag", "out.bag"), "out.bag.active", places[name])
            os.rename(self.path("out.bag.active"), self.path(name))
        os.symlink("precious", self.path("end.snapshot.part"))
        self.assert_runs(self.run_program(case, "--save", "end.snapshot"))
        self.assertFalse(os.path.islink(self.path("end.snapshot")))
        os.remove(self.path("end.snapshot.part"))
        os.remove(self.path("end.snapshot"))
        with open(self.path("precious")) as file:
            self.assertEqual(file.read(), "kept")
        self.assertEqual({name: os.lstat(self.path(name)).st_mode for name in self.files()}, kinds)

    def test_unknown_device(self):
        self.assert_refused(self.run_program(self.case(), "--bag", "out.bag", "--device", "no such device"), "no such device")
        self.assert_refused(self.run_program("--check", self.case(), "--device", "9:9"), "9:9")
        self.assertEqual(self.files(), ["case.yaml"])

    def test_broken_cases(self):
        with open(self.path("corrupt.stl"), "w") as file:
            file.write("solid nothing\nfacet normal 0 0 1\n outer loop\n  vertex 0 0\n")
        with open(self.path("empty.stl"), "w") as file:
            file.write("")
        bodies = lambda **change: [dict(BODY, **change)]  # noqa: E731
        probe = lambda *position: [{"name": "P1", "position": list(position)}]  # noqa: E731
        mesh_body = lambda name: [{"name": "step", "mesh": name, "motion": "fixed"}]  # noqa: E731
        broken = [
            ("an unknown key", dict(fluid__densty=1000.0), "densty"),
            ("an unknown group", dict(nummerics={"scheme": "delta_sph"}), "nummerics"),
            ("text for a number", dict(fluid__density="heavy"), "density"),
            ("a negative density", dict(fluid__density=-1.0), "density"),
            ("no duration", dict(duration=None), "duration"),
            ("a duration of nothing", dict(duration=0.0), "duration"),
            ("four dimensions", dict(dimensions=4), "dimensions"),
            ("neither spacing nor particles", dict(fluid__spacing=None), "spacing"),
            ("both of them", dict(fluid__particles=1000), "particles"),
            ("a spacing of zero", dict(fluid__spacing=0.0), "spacing"),
            ("an unknown scheme", dict(numerics__scheme="magic"), "magic"),
            ("gravity of four numbers", dict(gravity=[0, 0, 0, -9.81]), "gravity"),
            ("no fluid", dict(fluid__fill=[]), "fill"),
            ("a fill turned inside out", dict(fluid__fill=[{"box": {"min": [0.4, 0, 0.2], "max": [0, 0, 0]}}]), "fill"),
            ("fluid outside the tank", dict(fluid__fill=[{"box": {"min": [0.3, 0, 0], "max": [0.8, 0, 0.2]}}]), "tank"),
            ("fluid only above nothing", dict(fluid__fill=[{"box": {"min": [5, 0, 5], "max": [6, 0, 6]}}]), ""),
            ("no tank", dict(tank=None), "tank"),
            ("a tank of no size", dict(tank={"box": {"size": [0, 0, 0.4]}}), "size"),
            ("a missing mesh", dict(bodies=mesh_body("none.stl")), "none.stl"),
            ("a corrupt mesh", dict(bodies=mesh_body("corrupt.stl")), "corrupt.stl"),
            ("an empty mesh", dict(bodies=mesh_body("empty.stl")), "empty.stl"),
            ("a mesh of an unknown package", dict(bodies=mesh_body("package://no_such_package/a.stl")), "no_such_package"),
            ("an unknown motion", dict(bodies=bodies(motion="dancing")), "dancing"),
            ("two bodies of one name", dict(bodies=bodies() + bodies()), "step"),
            ("a body named as the tank", dict(bodies=bodies(name="tank")), "tank"),
            ("two probes of one name", dict(instruments__pressure_probes=probe(0, 0, 0.05) + probe(0.4, 0, 0.05)), "P1"),
            ("a probe inside a body", dict(instruments__pressure_probes=probe(0.2, 0, 0.04)), "P1"),
            ("a probe outside the tank", dict(instruments__pressure_probes=probe(9, 0, 0.04)), "P1"),
            ("a rate of zero", dict(instruments__rate=0), "rate"),
        ]
        for what, changes, word in broken:
            with self.subTest(what):
                case = self.case(**changes)
                before = self.files()
                self.assert_refused(self.run_program(case, "--bag", "out.bag"), word)
                self.assertEqual(self.files(), before)

    def test_broken_yaml(self):
        with open(self.path("broken.yaml"), "w") as file:
            file.write("title: [unfinished\nfluid: {")
        self.assert_refused(self.run_program("broken.yaml"), "broken.yaml")


class FullDisks(ProgramTest):
    """What a run has until its disk is full is kept, and one sentence tells where."""

    def assert_kept(self, result, bag, word):
        """The bag is whole up to the time of which the sentence speaks, and the snapshot where it says."""
        self.assert_refused(result, word, os.path.basename(bag))
        last = float(re.search(r"stops at ([0-9.e+-]+) s", result.stderr).group(1))
        found = stamps(bag, "/wavetank/probes")
        self.assertEqual(found, [i * 50000 for i in range(len(found))])
        self.assertGreater(len(found), 100)
        self.assertLess(abs(found[-1] * 1e-9 - last), 2e-3)
        with rosbag.Bag(bag) as opened:
            status = [message for _, message, _ in opened.read_messages(topics=["/wavetank/status"])][-1]
        self.assertEqual(status.phase, status.FAILED)
        self.assertFalse(os.path.exists(bag + ".active"))
        snapshot = re.search(r"its state is in '([^']+)'", result.stderr).group(1)
        case = self.case(duration=last + 0.01, instruments__rate=20000)
        self.assert_runs(self.run_program(case, "--restore", snapshot))
        return snapshot

    def test_a_file_that_cannot_grow(self):
        def limit():
            resource.setrlimit(resource.RLIMIT_FSIZE, (3000000, 3000000))

        case = self.case(duration=1000.0, instruments__rate=20000)
        result = self.run_program(case, "--bag", "out.bag", timeout=300, preexec_fn=limit)
        self.assert_kept(result, self.path("out.bag"), "limit on the size of files")
        self.assertEqual(self.files(), ["case.yaml", "out.bag", "out.snapshot"])

    def test_a_full_disk_under_the_bag(self):
        disk = self.small_disk("3m")
        case = self.case(duration=1000.0, instruments__rate=20000)
        bag = os.path.join(disk, "out.bag")
        self.assert_kept(self.run_program(case, "--bag", bag, timeout=300), bag, "the disk is full")

    def test_a_full_disk_under_bag_and_snapshot(self):
        disk = self.small_disk("3m")
        case = self.case(duration=1000.0, instruments__rate=20000)
        bag = os.path.join(disk, "out.bag")
        run = self.start_program(case, "--bag", bag, "--save", os.path.join(disk, "end.snapshot"))
        read_line_with(run, "running")
        # all that the bag does not have by then
        with open(os.path.join(disk, "others"), "wb", buffering=0) as file:
            try:
                while file.write(bytes(4096)) == 4096:
                    pass
            except OSError:
                pass
        run.wait(timeout=120)
        errors = run.stderr.read()
        self.assertEqual(run.returncode, 2, errors)
        self.assertEqual(len(errors.strip().splitlines()), 1, errors)
        self.assertGreater(len(stamps(bag, "/wavetank/probes")), 1)
        snapshot = re.search(r"its state is in '([^']+)'", errors).group(1)
        self.assertTrue(os.path.exists(os.path.join(self.folder, snapshot)))

    def test_a_full_disk_under_the_snapshot(self):
        disk = self.small_disk("4k")
        result = self.run_program(self.case(), "--bag", "out.bag", "--save", os.path.join(disk, "end.snapshot"))
        self.assert_refused(result, "the disk is full", os.path.join(self.folder, "end.snapshot"))
        self.assertEqual(os.listdir(disk), [])
        self.assertEqual(len(stamps(self.path("out.bag"), "/wavetank/probes")), 51)
        self.assert_runs(self.run_program(self.case(duration=0.06), "--restore", "end.snapshot"))

    def test_no_room_anywhere(self):
        disk = self.small_disk("4k")
        environment = dict(os.environ, TMPDIR=disk)
        case = self.case()
        result = subprocess.run(
            [program_runner.PROGRAM, case, "--bag", self.path("out.bag"), "--save", "end.snapshot"],
            cwd=disk,
            env=environment,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            universal_newlines=True,
            timeout=120,
        )
        self.assert_refused(result, "end.snapshot", "the disk is full", "nor in '%s'" % disk)
        self.assertEqual(len(stamps(self.path("out.bag"), "/wavetank/probes")), 51)

    def test_a_disk_too_small_to_begin(self):
        disk = self.small_disk("64k")
        self.assert_refused(self.run_program(self.case(), "--bag", os.path.join(disk, "out.bag")), "the disk is full")
        self.assertEqual(os.listdir(disk), [])


if __name__ == "__main__":
    program_runner.main()
