#!/usr/bin/env python3
"""Two nodes at once do not hear of each other."""

import sys
import time
import unittest

import rospy
import rostest
from std_srvs.srv import SetBool
from tf2_msgs.msg import TFMessage
from wavetank.msg import ProbeArray, SolverStatus


class TwoTanks(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node("two_tanks_test")

    def listen(self, topic, kind, seconds=60.0):
        return rospy.wait_for_message(topic, kind, seconds)

    def test_each_has_its_own_topics_frames_and_rate(self):
        for name, period in [("north", 1), ("south", 2)]:
            message = self.listen("/%s/tank/probes" % name, ProbeArray)
            self.assertEqual(message.header.frame_id, name)
            self.assertEqual(message.header.stamp.to_nsec() % (period * 1000000), 0)
        frames = set()
        subscriber = rospy.Subscriber("/tf_static", TFMessage, lambda message: frames.update(t.child_frame_id for t in message.transforms))
        end = time.time() + 20
        while len(frames) < 6 and time.time() < end:
            time.sleep(0.05)
        subscriber.unregister()
        self.assertEqual(frames, {"%s/%s" % (tank, part) for tank in ("north", "south") for part in ("probes/P1", "probes/P2", "bodies/step")})

    def test_pausing_one_leaves_the_other_running(self):
        for name in ("north", "south"):
            self.listen("/%s/tank/probes" % name, ProbeArray)
        rospy.wait_for_service("/north/tank/pause")
        self.assertTrue(rospy.ServiceProxy("/north/tank/pause", SetBool)(True).success)
        first = {name: self.listen("/%s/tank/status" % name, SolverStatus) for name in ("north", "south")}
        time.sleep(1.2)
        second = {name: self.listen("/%s/tank/status" % name, SolverStatus) for name in ("north", "south")}
        self.assertEqual(first["north"].step, second["north"].step)
        self.assertGreater(second["south"].step, first["south"].step)


if __name__ == "__main__":
    rostest.rosrun("wavetank", "two_tanks", TwoTanks, sys.argv)
