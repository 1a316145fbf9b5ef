#!/usr/bin/env python3
"""Nodes that end, and the bags they leave: recorded ones, failures, interrupts, refusals."""

import os
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import threading
import time
import unittest
import xmlrpc.client

import rosbag
import rosgraph
import roslib.packages
import rospy
import rostest
from diagnostic_msgs.msg import DiagnosticArray
from rosgraph_msgs.msg import Clock
from wavetank.msg import ProbeArray, SolverStatus
from wavetank.srv import Advance

HERE = os.path.dirname(os.path.abspath(__file__))
CASE = os.path.join(HERE, "still_tank.yaml")
PATIENCE = 15.0  # s of wall time from Ctrl-C until roslaunch loses patience with a node; idle, a node takes well under one

# A node of its own, at another master, that prints what it hears.
LISTENER = """
import rospy
from diagnostic_msgs.msg import DiagnosticArray
from wavetank.msg import SolverStatus
rospy.init_node("listener", disable_signals=True)
rospy.Subscriber("/lonely/status", SolverStatus, lambda message: print("status", flush=True))
rospy.Subscriber("/diagnostics", DiagnosticArray, lambda message: print("diagnostics", flush=True))
rospy.spin()
"""


def node_program():
    return roslib.packages.find_node("wavetank", "wavetank_node")[0]


class NodeEndings(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node("node_endings_test")

    def setUp(self):
        self.folder = tempfile.mkdtemp(prefix="wavetank_node_")
        self.addCleanup(shutil.rmtree, self.folder, ignore_errors=True)

    def path(self, name):
        return os.path.join(self.folder, name)

    def start(self, name, **parameters):
        rospy.set_param("/" + name, {key: value for key, value in parameters.items()})
        process = subprocess.Popen([node_program(), "__name:=" + name], cwd=self.folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        self.addCleanup(self.end, process)
        return process

    def end(self, process):
        if process.poll() is None:
            process.kill()
        process.communicate()

    def wait_for_end(self, process, seconds=60):
        try:
            output, _ = process.communicate(timeout=seconds)
        except subprocess.TimeoutExpired:
            self.fail("the node did not end in %g s" % seconds)
        return process.returncode, output.decode()

    def stamps(self, bag, topic):
        with rosbag.Bag(bag) as opened:
            return [message.header.stamp.to_nsec() for _, message, _ in opened.read_messages(topics=[topic])]

    def test_a_recorded_bag_has_every_sample_exactly_once(self):
        topics = ["/recorded/" + topic for topic in ("probes", "probes/P1", "gauges", "bodies/tank/wrench", "bodies/step/wrench", "status")]
        record = roslib.packages.find_node("rosbag", "record")[0]  # the recorder proper, which "rosbag record" only wraps
        recorder = subprocess.Popen([record, "-O", self.path("recorded.bag")] + topics, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        self.addCleanup(self.end, recorder)
        # Slower than real time: the recorder keeps 100 messages a topic at most and drops the rest when a busy machine holds it up.
        node = self.start(
            "recorded",
            case_file=CASE,
            duration=0.5,
            real_time_factor=0.1,
            wait_for_subscribers=60.0,
            exit_at_end=True,
            bag=self.path("own.bag"),
            bag_clouds=True,
        )
        self.assertEqual(self.wait_for_end(node)[0], 0)
        recorder.send_signal(signal.SIGINT)
        recorder.wait(timeout=30)
        for bag in ("recorded.bag", "own.bag"):
            for topic in topics[:-1]:
                self.assertEqual(self.stamps(self.path(bag), topic), [i * 1000000 for i in range(501)], bag + " " + topic)
        self.assertGreater(len(self.stamps(self.path("own.bag"), "/recorded/free_surface")), 20)

    def test_a_violation_is_an_error_diagnostic_a_snapshot_and_an_exit_code(self):
        errors = []

        def hear(message):
            errors.extend(s.message for s in message.status if s.name == "falling: solver" and s.level == 2)

        subscriber = rospy.Subscriber("/diagnostics", DiagnosticArray, hear)
        fluid = {"sound_speed": 0.6, "fill": [{"box": {"min": [0, 0, 0.1], "max": [0.1, 0, 0.38]}}]}
        node = self.start("falling", case_file=CASE, duration=2.0, fluid=fluid, bodies=[], snapshot_directory=self.folder, bag=self.path("end.bag"))
        code, output = self.wait_for_end(node)
        subscriber.unregister()
        self.assertEqual(code, 3, output)
        self.assertTrue(any("particle" in error for error in errors), errors)
        self.assertEqual(sorted(os.listdir(self.folder)), ["end.bag", "falling_failure.snapshot"])
        with rosbag.Bag(self.path("end.bag")) as bag:
            last = [message for _, message, _ in bag.read_messages(topics=["/falling/status"])][-1]
        self.assertEqual(last.phase, SolverStatus.FAILED)

    def test_ctrl_c_while_running_ends_cleanly_and_a_namesake_can_follow(self):
        for _ in range(2):
            node = self.start("interrupted", case_file=CASE, duration=1000.0, bag=self.path("a.bag"))
            rospy.wait_for_message("/interrupted/probes", ProbeArray, 60.0)
            begin = time.time()
            node.send_signal(signal.SIGINT)
            code, output = self.wait_for_end(node)
            self.assertEqual(code, 0, output)
            self.assertLess(time.time() - begin, PATIENCE)
            found = self.stamps(self.path("a.bag"), "/interrupted/probes")
            self.assertEqual(found, [i * 1000000 for i in range(len(found))])
            self.assertNotIn("/interrupted", str(rosgraph.Master("/test").getSystemState()))

    def test_ctrl_c_and_rosnode_kill_end_an_advance_that_is_in_progress(self):
        for name, end in (("stopped", lambda node: node.send_signal(signal.SIGINT)), ("shut_down", self.shut_down)):
            node = self.start(name, case_file=CASE, duration=1000.0, paused=True)
            node.name = "/" + name
            deadline = time.time() + 60
            while rospy.wait_for_message(node.name + "/status", SolverStatus, 60.0).phase != SolverStatus.PAUSED:
                self.assertLess(time.time(), deadline, "the node does not start")
            answers = []

            def advance():
                try:
                    answers.append(rospy.ServiceProxy(node.name + "/advance", Advance)(900.0).success)
                except rospy.ServiceException:  # the connection is gone before the answer is sent
                    answers.append(False)

            caller = threading.Thread(target=advance, daemon=True)
            caller.start()
            while rospy.wait_for_message(node.name + "/status", SolverStatus, 60.0).step < 10:
                self.assertLess(time.time(), deadline, "the advance does not begin")
            begin = time.time()
            end(node)
            code, output = self.wait_for_end(node)
            self.assertEqual(code, 0, output)
            self.assertLess(time.time() - begin, PATIENCE)
            caller.join(5.0)
            self.assertEqual(answers, [False], "who called it is answered")

    @staticmethod
    def shut_down(node):
        """As rosnode kill does."""
        with xmlrpc.client.ServerProxy(rosgraph.Master("/test").lookupNode(node.name)) as proxy:
            proxy.shutdown("/test", "the test ends it")

    def test_ctrl_c_while_packing_ends_cleanly_and_leaves_no_bag(self):
        numerics = {"packing": {"iterations": 100000}}
        node = self.start("packing", case_file=CASE, fluid={"spacing": 0.001}, numerics=numerics, bag=self.path("a.bag"))
        rospy.wait_for_message("/packing/status", SolverStatus, 60.0)
        begin = time.time()
        node.send_signal(signal.SIGINT)
        code, output = self.wait_for_end(node)
        self.assertEqual(code, 0, output)
        self.assertLess(time.time() - begin, PATIENCE)
        self.assertEqual(os.listdir(self.folder), [])

    def test_a_node_started_again_does_not_turn_the_clock_back(self):
        clock = []
        subscriber = rospy.Subscriber("/clock", Clock, lambda message: clock.append(message.clock.to_nsec()))
        first = self.start("respawned", case_file=CASE, duration=1000.0, publish_clock=True, real_time_factor=1.0)
        deadline = time.time() + 60
        while not rospy.has_param("/respawned/clock_reached") or len(clock) < 100:
            self.assertLess(time.time(), deadline, "the node published no /clock")
            time.sleep(0.1)
        first.kill()
        first.wait()
        before = len(clock)
        again = subprocess.Popen([node_program(), "__name:=respawned"], cwd=self.folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        self.addCleanup(self.end, again)
        rospy.wait_for_message("/respawned/probes", ProbeArray, 60.0)
        while len(clock) < before + 20:
            self.assertLess(time.time(), deadline + 60, "no /clock after the second start")
            time.sleep(0.1)
        subscriber.unregister()
        self.assertEqual(clock, sorted(clock))

    def test_a_killed_nodes_bag_is_kept_by_the_one_that_follows(self):
        killed = self.start("killed", case_file=CASE, duration=1000.0, bag=self.path("a.bag"))
        rospy.wait_for_message("/killed/probes", ProbeArray, 60.0)
        time.sleep(1.0)
        killed.kill()
        killed.wait()
        self.assertEqual(os.listdir(self.folder), ["a.bag.active"])
        died = os.path.getsize(self.path("a.bag.active"))
        node = self.start("killed", case_file=CASE, duration=0.05, bag=self.path("a.bag"), exit_at_end=True)
        code, output = self.wait_for_end(node)
        self.assertEqual(code, 0, output)
        self.assertIn("a.bag.1.active", output)
        self.assertEqual(sorted(os.listdir(self.folder)), ["a.bag", "a.bag.1.active"])
        self.assertEqual(os.path.getsize(self.path("a.bag.1.active")), died)
        self.assertEqual(len(self.stamps(self.path("a.bag"), "/killed/probes")), 51)

    def test_only_plain_files_become_bags_and_snapshots(self):
        with open(self.path("precious"), "w") as file:
            file.write("kept")
        for name in ["a.bag", "b.bag.active", "linked_failure.snapshot"]:
            os.symlink("precious", self.path(name))
        for bag in ["a.bag", "b.bag"]:
            code, output = self.wait_for_end(self.start("linked", case_file=CASE, bag=self.path(bag)))
            self.assertEqual(code, 2, output)
            self.assertIn("a link", output)
        fluid = {"sound_speed": 0.6, "fill": [{"box": {"min": [0, 0, 0.1], "max": [0.1, 0, 0.38]}}]}
        node = self.start("linked", case_file=CASE, duration=2.0, fluid=fluid, bodies=[], snapshot_directory=self.folder, bag="")
        code, output = self.wait_for_end(node)
        self.assertEqual(code, 3, output)
        self.assertIn("linked_failure.1.snapshot", output)
        self.assertTrue(os.path.islink(self.path("linked_failure.snapshot")))
        with open(self.path("precious")) as file:
            self.assertEqual(file.read(), "kept")

    def test_a_violation_during_the_start_is_one_too(self):
        bodies = [
            {"name": "top", "box": {"min": [0.1, -0.1, 0.25], "max": [0.2, 0.1, 0.3]}, "motion": "free", "density": 500.0, "angular_velocity": [0, 1e5, 0]}
        ]
        node = self.start("spinning", case_file=CASE, bodies=bodies, snapshot_directory=self.folder, bag=self.path("a.bag"))
        code, output = self.wait_for_end(node)
        self.assertEqual(code, 3, output)
        self.assertIn("before the start", output)
        self.assertEqual(os.listdir(self.folder), [])

    def test_sighup_and_sigterm_end_it_as_ctrl_c_does(self):
        for number in (signal.SIGHUP, signal.SIGTERM):
            node = self.start("ended", case_file=CASE, duration=1000.0, bag=self.path("a.bag"))
            rospy.wait_for_message("/ended/probes", ProbeArray, 60.0)
            for _ in range(3):
                node.send_signal(number)
            code, output = self.wait_for_end(node)
            self.assertEqual(code, 0, output)
            self.assertEqual(os.listdir(self.folder), ["a.bag"])
            found = self.stamps(self.path("a.bag"), "/ended/probes")
            self.assertEqual(found, [i * 1000000 for i in range(len(found))])

    def test_a_dead_master_silences_nothing(self):
        with socket.socket() as probe:
            probe.bind(("localhost", 0))
            port = probe.getsockname()[1]
        environment = dict(os.environ, ROS_MASTER_URI="http://localhost:%d" % port, ROS_LOG_DIR=self.folder)
        rosmaster = [sys.executable, shutil.which("rosmaster"), "--core", "-p", str(port), "__log:=" + self.path("m")]
        quiet = {"cwd": self.folder, "env": environment, "stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
        master = subprocess.Popen(rosmaster, **quiet)
        self.addCleanup(self.end, master)
        own = rosgraph.Master("/test", environment["ROS_MASTER_URI"])
        deadline = time.time() + 30
        while not own.is_online():
            self.assertLess(time.time(), deadline, "the second master did not start")
            time.sleep(0.1)
        for key, value in {"case_file": CASE, "duration": 1000.0, "publish_clock": True, "real_time_factor": 1.0}.items():
            own.setParam("/lonely/" + key, value)
        node = subprocess.Popen([node_program(), "__name:=lonely"], **quiet)
        self.addCleanup(self.end, node)
        listener = subprocess.Popen([sys.executable, "-c", LISTENER], **dict(quiet, stdout=subprocess.PIPE))
        self.addCleanup(self.end, listener)
        heard = []

        def read():
            for line in iter(listener.stdout.readline, b""):
                heard.append(line.decode().strip())

        reader = threading.Thread(target=read, daemon=True)
        reader.start()

        def wait_for_each(seconds):
            end = time.time() + seconds
            while time.time() < end and (heard.count("status") < 4 or heard.count("diagnostics") < 4):
                time.sleep(0.1)
            self.assertGreaterEqual(heard.count("status"), 4, heard)
            self.assertGreaterEqual(heard.count("diagnostics"), 4, heard)

        wait_for_each(60)
        self.assertTrue(own.hasParam("/lonely/clock_reached"))
        master.kill()
        master.wait()
        time.sleep(2.5)  # what was on its way, and a first note that finds no master
        del heard[:]
        wait_for_each(15)
        node.send_signal(signal.SIGINT)
        self.assertEqual(node.wait(timeout=10), 0)

    def test_what_cannot_be_read_laid_out_or_restored_is_refused(self):
        for number, (parameters, word) in enumerate(
            [
                ({}, "case_file"),
                ({"case_file": "/no/such/case.yaml"}, "/no/such/case.yaml"),
                ({"case_file": CASE, "fluid": {"densty": 1.0}}, "densty"),
                ({"case_file": CASE, "exit_at_end": "perhaps"}, "exit_at_end"),
                ({"case_file": CASE, "bag": "/no/such/a.bag"}, "/no/such/a.bag"),
                ({"case_file": CASE, "duration": "long"}, "parameter ~duration: duration is long"),
                ({"case_file": CASE, "bodies": [{"name": "step", "mesh": "none.stl"}]}, "parameter ~bodies: bodies/0/mesh: mesh file"),
                ({"case_file": CASE, "fluid": {"fill": [{"box": {"min": [5, 0, 5], "max": [6, 0, 6]}}]}}, "fluid"),
                ({"case_file": CASE, "restore": "/no/such/a.snapshot"}, "/no/such/a.snapshot"),
                ({"title": "a", "duration": 1.0}, "fluid"),
            ]
        ):
            name = "wrong_%d" % number
            code, output = self.wait_for_end(self.start(name, **parameters))
            self.assertEqual(code, 2, output)
            self.assertIn(word, output)
            self.assertNotIn("terminate called", output)
            self.assertEqual(os.listdir(self.folder), [])


if __name__ == "__main__":
    rostest.rosrun("wavetank", "node_endings", NodeEndings, sys.argv)
