#!/usr/bin/env python3
"""A live node: every topic's type, frame, stamps and units; its services; its clock over a reset."""

import math
import os
import sys
import time
import unittest

import rospy
import rostest
from diagnostic_msgs.msg import DiagnosticArray
from ear import Ear
from geometry_msgs.msg import WrenchStamped
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import FluidPressure, Image, PointCloud2
from std_msgs.msg import String
from std_srvs.srv import SetBool, Trigger
from tf2_msgs.msg import TFMessage
from visualization_msgs.msg import InteractiveMarkerFeedback, Marker, MarkerArray
from wavetank.msg import ProbeArray, SolverStatus, WaveGaugeArray
from wavetank.srv import Advance

HYDROSTATIC = 1000.0 * 9.81 * 0.15  # Pa, 0.15 m under the surface
TOPICS = {
    "/wavetank/probes": ProbeArray,
    "/wavetank/probes/P1": FluidPressure,
    "/wavetank/probes/P2": FluidPressure,
    "/wavetank/gauges": WaveGaugeArray,
    "/wavetank/bodies/tank/wrench": WrenchStamped,
    "/wavetank/bodies/step/wrench": WrenchStamped,
    "/wavetank/bodies/step/wrench/pressure": WrenchStamped,
    "/wavetank/bodies/step/wrench/viscous": WrenchStamped,
    "/wavetank/particles": PointCloud2,
    "/wavetank/free_surface": PointCloud2,
    "/wavetank/surface_mesh": Marker,
    "/wavetank/height_map": Image,
    "/wavetank/status": SolverStatus,
    "/wavetank/markers": MarkerArray,
    "/wavetank/case": String,
    "/clock": Clock,
    "/tf_static": TFMessage,
    "/diagnostics": DiagnosticArray,
}
SAMPLED = ["/wavetank/probes", "/wavetank/probes/P1", "/wavetank/gauges", "/wavetank/bodies/tank/wrench", "/wavetank/bodies/step/wrench"]


class LiveNode(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node("live_node_test")
        cls.ear = Ear(TOPICS)
        cls.wait_for_phase(SolverStatus.FINISHED)
        for name in ["pause", "step", "advance", "reset", "save"]:
            rospy.wait_for_service("/wavetank/" + name)
        cls.pause = rospy.ServiceProxy("/wavetank/pause", SetBool)
        cls.step = rospy.ServiceProxy("/wavetank/step", Trigger)
        cls.advance = rospy.ServiceProxy("/wavetank/advance", Advance)
        cls.reset = rospy.ServiceProxy("/wavetank/reset", Trigger)
        cls.save = rospy.ServiceProxy("/wavetank/save", Trigger)

    @classmethod
    def wait_for_phase(cls, phase):
        cls.ear.wait(lambda: cls.ear.all("/wavetank/status") and cls.ear.last("/wavetank/status").phase == phase, "phase %d" % phase)

    def first_run(self, topic):
        return self.ear.all(topic)[:301]

    def test_01_every_sample_arrives_once_with_its_own_stamp(self):
        for topic in SAMPLED:
            self.assertEqual(self.ear.stamps(topic), [i * 1000000 for i in range(301)], topic)

    def test_02_probes(self):
        message = self.first_run("/wavetank/probes")[100]
        self.assertEqual(message.header.frame_id, "tank")
        self.assertEqual(message.names, ["P1", "P2"])
        self.assertEqual((message.positions[1].x, message.positions[1].z), (0.4, 0.05))
        for pressure in message.pressures:
            self.assertLess(abs(pressure - HYDROSTATIC), 0.2 * HYDROSTATIC)

    def test_03_single_probes_have_their_frame_and_the_reference_pressure(self):
        array = self.first_run("/wavetank/probes")[100]
        single = self.first_run("/wavetank/probes/P2")[100]
        self.assertEqual(single.header.frame_id, "tank/probes/P2")
        self.assertAlmostEqual(single.fluid_pressure, array.pressures[1] + 101325.0, 6)

    def test_04_gauges(self):
        message = self.first_run("/wavetank/gauges")[100]
        self.assertEqual(message.header.frame_id, "tank")
        self.assertEqual(message.names, ["H1"])
        self.assertLess(abs(message.levels[0] - 0.2), 0.03)

    def test_05_wrenches(self):
        total = self.first_run("/wavetank/bodies/step/wrench")[100]
        pressure = self.first_run("/wavetank/bodies/step/wrench/pressure")[100]
        viscous = self.first_run("/wavetank/bodies/step/wrench/viscous")[100]
        self.assertEqual(total.header.frame_id, "tank/bodies/step")
        self.assertEqual(self.first_run("/wavetank/bodies/tank/wrench")[0].header.frame_id, "tank")
        self.assertAlmostEqual(total.wrench.force.z, pressure.wrench.force.z + viscous.wrench.force.z, 6)
        self.assertLess(self.first_run("/wavetank/bodies/tank/wrench")[100].wrench.force.z, 0.0, "the water's weight on the floor")

    def test_06_clouds(self):
        for topic, step in [("/wavetank/particles", 44), ("/wavetank/free_surface", 28)]:
            cloud = self.ear.all(topic)[-1]
            self.assertEqual(cloud.header.frame_id, "tank")
            self.assertEqual(cloud.point_step, step)
            self.assertGreater(cloud.width, 0)
        self.assertEqual(self.ear.all("/wavetank/particles")[-1].width, self.ear.all("/wavetank/status")[-1].particles)

    def test_06_surface_of_the_water(self):
        types = dict(rospy.get_published_topics("/wavetank"))
        if "/wavetank/surface_mesh" not in types:
            self.skipTest("OpenVDB was not installed when this was built: scripts/install --surface")
        self.ear.wait(lambda: self.ear.all("/wavetank/surface_mesh") and self.ear.all("/wavetank/height_map"), "the surface of the water")
        surface = next(marker for marker in self.ear.all("/wavetank/surface_mesh") if marker.ns == "surface")
        self.assertEqual((surface.header.frame_id, surface.type), ("tank", Marker.TRIANGLE_LIST))
        self.assertEqual(len(surface.points) % 3, 0)
        self.assertAlmostEqual(max(point.z for point in surface.points), 0.2, delta=0.02)
        heights = self.ear.all("/wavetank/height_map")[-1]
        self.assertEqual((heights.encoding, heights.height, heights.width, len(heights.data)), ("32FC1", 20, 1, 80))

    def test_07_transforms_markers_and_case(self):
        frames = {t.child_frame_id: t.header.frame_id for message in self.ear.all("/tf_static") for t in message.transforms}
        self.assertEqual(frames, {"tank/probes/P1": "tank", "tank/probes/P2": "tank", "tank/bodies/step": "tank"})
        self.assertEqual(len(self.ear.all("/wavetank/markers")), 1)
        self.assertIn('title: "A small tank at rest"', self.ear.all("/wavetank/case")[0].data)

    def test_08_status(self):
        status = self.ear.all("/wavetank/status")[-1]
        self.assertEqual(status.title, "A small tank at rest")
        self.assertAlmostEqual(status.duration, 0.3)
        self.assertGreaterEqual(status.time, 0.3)
        self.assertGreater(status.particles, 100)
        self.assertAlmostEqual(status.mass, status.particles * 0.4, delta=0.2 * status.mass)
        self.assertGreater(status.potential_energy, status.kinetic_energy)
        self.assertTrue(status.device)

    def test_09_diagnostics(self):
        found = [s for message in self.ear.all("/diagnostics") for s in message.status if s.name == "wavetank: solver"]
        self.assertTrue(found)
        self.assertEqual(found[-1].level, 0)
        self.assertEqual(found[-1].message, "finished")
        self.assertEqual(found[-1].hardware_id, self.ear.all("/wavetank/status")[-1].device)
        self.assertIn("real-time factor", [value.key for value in found[-1].values])

    def test_10_services(self):
        self.assertFalse(self.step().success, "a step while not paused")
        self.assertIn("pause it first", self.refused_advance(0.01))
        self.assertTrue(self.pause(True).success)
        answer = self.reset()
        self.assertTrue(answer.success, answer.message)
        self.wait_for_phase(SolverStatus.PAUSED)
        before = self.ear.all("/wavetank/status")[-1]
        self.assertEqual((before.step, before.time, before.paused), (0, 0.0, True))
        for _ in range(3):
            self.assertTrue(self.step().success)
        self.ear.wait(lambda: self.ear.all("/wavetank/status")[-1].step == 3, "three steps")
        answer = self.save()
        self.assertTrue(answer.success, answer.message)
        self.assertTrue(os.path.isabs(answer.message) and os.path.isfile(answer.message), answer.message)
        time.sleep(1.5)
        self.assertEqual(self.ear.all("/wavetank/status")[-1].step, 3, "paused is paused")
        self.step_by_two_hands()
        self.advance_in_spans()
        self.assertTrue(self.pause(False).success)
        self.wait_for_phase(SolverStatus.FINISHED)

    def step_by_two_hands(self):
        """By the menu of the handles, which take one hand after another though the simulated time stands still."""
        hand = rospy.Publisher("/wavetank/handles/feedback", InteractiveMarkerFeedback, queue_size=1)
        self.ear.wait(lambda: hand.get_num_connections() > 0, "the handles")
        before = self.ear.last("/wavetank/status").step
        for count, client in enumerate(("one", "another"), 1):
            time.sleep(1.1)  # which a hand must wait for another's word
            hand.publish(InteractiveMarkerFeedback(client_id=client, marker_name="run", event_type=InteractiveMarkerFeedback.MENU_SELECT, menu_entry_id=3))
            self.ear.wait(lambda: self.ear.last("/wavetank/status").step == before + count, "a step by %s" % client, 10)

    def refused_advance(self, seconds):
        answer = self.advance(seconds)
        self.assertFalse(answer.success, answer.message)
        return answer.message

    def advance_in_spans(self):
        """From after a few steps, paused."""
        begin = self.advance(0.0).time
        for n in range(1, 11):
            answer = self.advance(0.01)
            self.assertTrue(answer.success, answer.message)
            late = answer.time - (begin + 0.01 * n)
            self.assertTrue(-1e-9 <= late < 2e-3, "spans add up, to within a step of less than 2 ms: %g s late" % late)
            self.assertEqual(answer.stamp.to_nsec(), 1000000000 + round(answer.time * 1e9), "the second run's stamps")
        for seconds in (math.nan, math.inf, -0.01):
            self.assertIn("at least 0", self.refused_advance(seconds))
        self.assertIn("the run ends at 0.3 s", self.refused_advance(0.25))
        self.assertEqual(self.advance(0.0).time, answer.time)

    def test_11_the_second_run_follows_the_first_in_time_and_repeats_it(self):
        stamps = self.ear.stamps("/wavetank/probes")
        self.assertEqual(stamps[301:], [1000000000 + i * 1000000 for i in range(301)])
        messages = self.ear.all("/wavetank/probes")
        for first, second in zip(messages[:301], messages[301:]):
            self.assertEqual(first.pressures, second.pressures)

    def test_12_the_clock_never_ran_backwards(self):
        clocks = [message.clock.to_nsec() for message in self.ear.all("/clock")]
        self.assertGreater(len(clocks), 100)
        self.assertGreater(clocks[0], 0)
        self.assertEqual(clocks, sorted(clocks))


if __name__ == "__main__":
    rostest.rosrun("wavetank", "live_node", LiveNode, sys.argv)
