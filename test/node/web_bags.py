"""What the tests of the page in the browser have in common: a bag that is made, and a tank that does nothing by itself."""

import math
import os
import subprocess
import sys
import tempfile
import unittest
import numpy
import rosbag
import rospy
from geometry_msgs.msg import Point
from nav_msgs.msg import Odometry
from page_browser import WEB
from sensor_msgs.msg import PointCloud2, PointField
from std_msgs.msg import String
from visualization_msgs.msg import Marker, MarkerArray
from wavetank.msg import ProbeArray
from wavetank.web.requests import LIVE

KNOWN = {"bodies": ["boat"], "waters": ["particles", "surface"]}
PRESSURE = 1234.5678  # Pa, the last one


def box_marker(group, frame, low, high, colour):
    corners = [[(high if bit >> axis & 1 else low)[axis] for axis in range(3)] for bit in range(8)]
    faces = [(0, 1, 3, 2), (4, 5, 7, 6), (0, 1, 5, 4), (2, 3, 7, 6), (0, 2, 6, 4), (1, 3, 7, 5)]
    marker = Marker(ns=group, type=Marker.TRIANGLE_LIST)
    marker.header.frame_id = frame
    marker.pose.orientation.w = marker.scale.x = marker.scale.y = marker.scale.z = 1.0
    marker.color.r, marker.color.g, marker.color.b, marker.color.a = colour
    for a, b, c, d in faces:
        marker.points += [Point(*corners[n]) for n in (a, b, c, a, c, d)]
    return marker


def surface_markers(stamp, ahead):
    """A box of water, and two drops over it; at the start neither."""
    surface = box_marker("surface", "tank", (ahead, 0, 0), (ahead + 1, 0.6, 0.52), (0.25, 0.55, 0.85, 1))
    spray = Marker(ns="spray", type=Marker.POINTS, points=[Point(ahead, 0.3, 0.5), Point(ahead + 0.1, 0.3, 0.5)])
    spray.scale.x = 0.02
    for marker in (surface, spray):
        marker.header.stamp = stamp
        if ahead == 0:
            marker.action, marker.points = Marker.DELETE, []
    return surface, spray


def write_bag(path, clouds=True, stamped_lines=False, broken_at=None, lost_at=None, **how):
    """Water of 1 × 0.6 × 0.52 m that moves ahead in a tank of 2 m, a body that rises out of it, a probe."""
    with rosbag.Bag(path, "w", **how) as bag:
        start = rospy.Time(0, 1)
        text = (
            'title: "A <b>made</b> bag"\ndimensions: 3\nfluid:\n  spacing: 0.04\nworld_frame: tank\nbodies:\n  - name: boat\n    motion: free\n    mass: 3.0\n'
        )
        bag.write("/wavetank/case", String(text), start)
        shapes = [
            box_marker("tank", "tank", (0, 0, 0), (2, 0.6, 0.6), (0.5, 0.7, 0.8, 0.12)),
            box_marker("bodies", "tank/bodies/boat", (-0.1, -0.1, -0.1), (0.1, 0.1, 0.1), (0.95, 0.6, 0.15, 1.0)),
        ]
        bag.write("/wavetank/markers", MarkerArray(shapes), start)
        for n in (0, 1):  # as earlier versions wrote them, without a stamp
            line = Marker(ns="moorings", type=Marker.LINE_STRIP, points=[Point(0, 0, 0), Point(1, 0, n)])
            line.pose.orientation.w = 1.0
            if stamped_lines:
                line.header.stamp = rospy.Time.from_sec(0.5 + 0.25 * n)
            bag.write("/wavetank/markers", MarkerArray([line]), rospy.Time.from_sec(0.5 + 0.25 * n))
        lattice = numpy.stack(numpy.meshgrid(numpy.arange(25), numpy.arange(15), numpy.arange(13), indexing="ij"), axis=-1).reshape(-1, 3) * 0.04 + 0.02
        for n in range(201):
            stamp = rospy.Time.from_sec(n / 200)
            probes = ProbeArray(names=["P1"], positions=[Point()], pressures=[PRESSURE if n == 200 else 10.0 * n])
            probes.header.stamp = stamp
            bag.write("/wavetank/probes", probes, stamp if n else start)
            odometry = Odometry()
            odometry.header.stamp = stamp
            odometry.pose.pose.position.x, odometry.pose.pose.position.z, odometry.pose.pose.orientation.w = 1.5, n / 200, math.nan if n == lost_at else 1.0
            bag.write("/wavetank/bodies/boat/odom", odometry, stamp if n else start)
            if clouds and n % 100 == 0:
                for marker in surface_markers(stamp, n / 200):
                    bag.write("/wavetank/surface_mesh", marker, stamp if n else start)
            if clouds and n % 40 == 0:
                points = numpy.zeros((len(lattice), 6), "<f4")
                points[:, :3] = lattice + [n / 200, 0, 0]
                points[:, 3] = 0.1 + 0.5 * lattice[:, 2]
                points[::40, 3] = 2.0  # some are fast, so that the others have the colours of slow water
                fields = [PointField(name, 4 * place, PointField.FLOAT32, 1) for place, name in enumerate(("x", "y", "z", "vx", "vy", "vz"))]
                cloud = PointCloud2(height=1, width=len(points), fields=fields, point_step=24, row_step=24 * len(points), data=points.tobytes())
                if n == broken_at:
                    fields[0].datatype = 99
                cloud.header.stamp = stamp
                bag.write("/wavetank/free_surface", cloud, stamp if n else start)


class WithBag(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory(prefix="wavetank_test_")
        cls.addClassCleanup(folder.cleanup)
        cls.bag = os.path.join(folder.name, "made.bag")
        write_bag(cls.bag)

    def refused(self, *arguments):
        done = subprocess.run([sys.executable, WEB, *arguments], stdout=subprocess.PIPE, stderr=subprocess.PIPE, universal_newlines=True, timeout=30)
        self.assertEqual(done.returncode, 2, done.stderr)
        self.assertEqual(len(done.stderr.splitlines()), 1, done.stderr)
        return done.stderr


class MadeTank:
    """A tank as the server's source, which does nothing by itself."""

    requests, mode = LIVE, "of a test"

    def __init__(self):
        self.run, self.calls = 0, []

    def known(self):
        return KNOWN

    def hello(self):
        hello = {
            "kind": "hello",
            "run": self.run,
            "mode": "live",
            "source": "/wavetank",
            "tank": "/wavetank",
            "title": "run %d" % self.run,
            "dimensions": 3,
            "spacing": 0.1,
        }
        return dict(hello, waters=KNOWN["waters"], bodies=[{"name": "boat", "mass": 1.0}], times=[])

    def greet(self, mailbox):
        pass

    def call(self, request):
        self.calls.append(request)
