#!/usr/bin/env python3
"""The page in the browser: what is sent, what may be asked for, and a bag as a user sees it."""

import asyncio
import http.client
import io
import json
import math
import os
import shutil
import socket
import struct
import subprocess
import sys
import tempfile
import threading
import time
import unittest
import unittest.mock
import urllib.error
import urllib.request
import xml.parsers.expat

import numpy
import rosbag
import rospy
from geometry_msgs.msg import Point
from nav_msgs.msg import Odometry
from page_browser import MISSING, NO_SERVER, WEB, Browser, end, start_server
from sensor_msgs.msg import PointCloud2, PointField
from std_msgs.msg import String
from visualization_msgs.msg import Marker, MarkerArray
from wavetank.msg import ProbeArray, SolverStatus
from wavetank import Failure
from wavetank.bag_file import BagFile
from wavetank.meshes import package_path, read_obj, read_stl, triangles_of
from wavetank.recording import Recording
from wavetank.web.drawing import Drawing
from wavetank.web.live import Live
from wavetank.web.mailbox import Mailbox
from wavetank.web.packets import cloud_packet, pack, surface_packet, unpack
from wavetank.web.replay import Replay, read_case
from wavetank.web.requests import LIVE, REPLAY, Refused, origin_is_ours, read_request
from wavetank.web.series import Series

RANDOM = numpy.random.default_rng(5)
KNOWN = {"bodies": ["boat"], "waters": ["particles", "surface"]}
PRESSURE = 1234.5678  # Pa, the last one


class Packets(unittest.TestCase):
    def test_arrays_come_back(self):
        arrays = {"a": numpy.arange(3, dtype="<u2"), "b": RANDOM.random((2, 3)), "c": numpy.array([1, 2**32 - 1], "<u4"), "d": numpy.array([7], "u1")}
        header, found = unpack(pack({"kind": "é"}, **arrays))
        self.assertEqual(header["kind"], "é")
        for name, values in arrays.items():
            self.assertEqual(found[name].tobytes(), values.tobytes())

    def test_positions_and_speeds_within_a_step_of_16_bits(self):
        cloud = {axis: RANDOM.uniform(-1, 2, 500).astype("f4") for axis in ("x", "y", "z", "vx", "vy", "vz")}
        header, arrays = unpack(cloud_packet("particles", 1500000000, cloud))
        packed = arrays["points"].reshape(-1, 4).astype(float)
        points = numpy.array(header["low"]) + packed[:, :3] / 65535 * header["size"]
        numpy.testing.assert_allclose(points, numpy.column_stack([cloud[axis] for axis in "xyz"]), atol=0.51 * 3 / 65535 + 1e-6)
        speeds = numpy.sqrt(sum(cloud[axis].astype(float) ** 2 for axis in ("vx", "vy", "vz")))
        numpy.testing.assert_allclose(packed[:, 3] / 65535 * header["top_speed"], speeds, atol=1.01 * speeds.max() / 65535)
        self.assertEqual(header["time"], 1.5)
        self.assertEqual((speeds > header["typical_speed"] * (1 + 1e-6)).sum(), 10, "one in fifty is faster")

    def test_clouds_of_nothing_of_the_plane_and_with_what_is_no_number(self):
        empty = {axis: numpy.empty(0, "f4") for axis in ("x", "y", "z", "vx", "vy", "vz")}
        self.assertEqual(len(unpack(cloud_packet("particles", 0, empty))[1]["points"]), 0)
        flat = {axis: numpy.array([0.5, numpy.nan, 1.5] if axis == "x" else [0.0] * 3, "f4") for axis in ("x", "y", "z", "vx", "vy", "vz")}
        header, arrays = unpack(cloud_packet("particles", 0, flat))
        self.assertEqual(arrays["points"].tolist(), [0, 0, 0, 0, 65535, 0, 0, 0])
        self.assertEqual((header["low"], header["size"]), ([0.5, 0, 0], [1.0, 0, 0]))

    def test_corners_of_a_surface_are_shared(self):
        square = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 0, 0), (1, 1, 0), (0, 1, 0)]
        kind = numpy.dtype([(axis, "<f8") for axis in "xyz"])
        colour = {"r": 0.0, "g": 0.5, "b": 1.0, "a": 1.0}
        marker = {"points": numpy.array(square, kind), "colors": numpy.empty(0), "color": colour, "ns": "surface"}
        header, arrays = unpack(surface_packet(marker, 0))
        points = numpy.array(header["low"]) + arrays["points"].reshape(-1, 4)[:, :3] / 65535 * header["size"]
        self.assertEqual(len(points), 4)
        numpy.testing.assert_allclose(points[arrays["corners"]], square, atol=1e-4)


class Samples(unittest.TestCase):
    def test_peaks_and_the_last_stay_in_bounded_memory(self):
        times = numpy.arange(50000) / 1000
        values = numpy.column_stack([numpy.sin(times), RANDOM.random(50000)])
        values[12345, 1], values[33333, 1], values[20000, 0] = 9.0, -9.0, numpy.nan
        series = Series(2, 1000)
        for begin in range(0, 50000, 70):
            series.add(times[begin : begin + 70], values[begin : begin + 70])
            self.assertLessEqual(len(series), 1000)
        self.assertGreater(len(series), 400)
        self.assertEqual((series.values[:, 1].max(), series.values[:, 1].min()), (9.0, -9.0))
        self.assertEqual((series.times[-1], series.times[0]), (times[-1], times[0]))
        numpy.testing.assert_array_equal(series.values[-100:], values[-100:])
        self.assertTrue((numpy.diff(series.times) > 0).all())

    def test_a_client_that_does_not_read_loses_pictures_and_nothing_else(self):
        mailbox = Mailbox()
        table = {"name": "probes", "columns": ["P1"], "units": ["Pa"]}
        for n in range(300):
            mailbox.put("cloud", b"cloud %d" % n)
            mailbox.put("poses", b"poses %d" % n)
            mailbox.add(table, numpy.array([n / 10]), numpy.array([[float(n)]]))
        mailbox.answer("yes")
        taken = [mailbox.take(pictures)[0] for pictures in (True, True, False, True, True, True)]
        self.assertEqual((taken[0], *taken[2:]), ("yes", None, b"cloud 299", b"poses 299", None))
        header, arrays = unpack(taken[1])
        self.assertEqual((header["name"], header["units"], header["clear"]), ("probes", ["Pa"], False))
        self.assertEqual(arrays["values"].tolist(), list(range(300)))

    def test_samples_of_another_run_take_the_place_of_those_that_wait(self):
        mailbox = Mailbox()
        table = {"name": "probes", "columns": ["P1"], "units": ["Pa"]}
        mailbox.add(table, numpy.array([5.0]), numpy.array([[1.0]]))
        mailbox.add(table, numpy.array([0.0]), numpy.array([[2.0]]), clear=True)
        mailbox.add(table, numpy.array([1.0]), numpy.array([[3.0]]))
        header, arrays = unpack(mailbox.take()[0])
        self.assertEqual((header["clear"], arrays["times"].tolist(), arrays["values"].tolist()), (True, [0.0, 1.0], [2.0, 3.0]))
        self.assertIsNone(mailbox.take()[0])


class Requests(unittest.TestCase):
    def test_what_is_allowed(self):
        push = {"do": "push", "body": "boat", "force": [1, 0, -2.5], "torque": [0, 0, 0]}
        self.assertEqual(read_request(json.dumps(push), LIVE, KNOWN), push)
        for request in ({"do": "pause", "value": True}, {"do": "step"}, {"do": "reset"}, {"do": "seen"}, {"do": "show", "water": "surface"}):
            self.assertEqual(read_request(json.dumps(request), LIVE, KNOWN), request)
        self.assertEqual(read_request('{"do": "frame", "time": 1, "water": "particles"}', REPLAY, KNOWN)["time"], 1.0)

    def test_all_else_is_refused_in_a_sentence(self):
        push = '{"do": "push", "body": "boat", "force": %s, "torque": [0, 0, 0]}'
        bad = {
            b'{"do": "step"}': "text",
            "": "JSON",
            "{": "JSON",
            "[" * 3000: "JSON",
            "[]": "object",
            '"step"': "object",
            "{}": "'do'",
            '{"do": ["step"]}': "'do'",
            '{"do": "save"}': "'do'",
            '{"do": "frame", "time": 0, "water": "particles"}': "'do'",
            '{"do": "step", "more": 1}': "no other",
            '{"do": "step", "do": "reset"}': "once",
            '{"do": "pause"}': "keys",
            '{"do": "pause", "value": 1}': "true or false",
            '{"do": "show", "water": "tea"}': "particles, surface",
            '{"do": "show", "water": ["surface"]}': "particles, surface",
            push % "[1, 2]": "three",
            push % '"much"': "three",
            push % "[1, 2, NaN]": "no number",
            push % "[1, 2, 1e999]": "number from",
            push % "[1, 2, true]": "number from",
            push % ("[1, 2, 1%s]" % ("0" * 400)): "number from",
            push % ("[1, 2, -1%s]" % ("0" * 4000)): "number from",
            push % '[1, 2, "3"]': "number from",
            push.replace("boat", "tank") % "[1, 2, 3]": "boat",
            '{"do": "step", "x": "%s"}' % ("a" * 5000): "4096",
        }
        for text, word in bad.items():
            with self.assertRaises(Refused, msg=str(text)[:80]) as raised:
                read_request(text, LIVE, KNOWN)
            self.assertIn(word, str(raised.exception), str(text)[:80])
        with self.assertRaises(Refused):
            read_request('{"do": "frame", "time": -1, "water": "particles"}', REPLAY, KNOWN)

    def test_only_pages_of_this_server_may_ask(self):
        names = {"localhost", "127.0.0.1", "::1"}
        for origin, host in (
            ("http://localhost:8780", "localhost:8780"),
            ("http://127.0.0.1:1", "127.0.0.1:1"),
            ("http://[::1]:80", "[::1]:80"),
            ("http://LOCALHOST", "localhost"),
        ):
            self.assertTrue(origin_is_ours(origin, host, names), origin)
        for origin, host in (
            (None, "localhost:8780"),
            ("", "localhost:8780"),
            ("null", "localhost:8780"),
            ("http://localhost:8781", "localhost:8780"),
            ("https://localhost:8780", "localhost:8780"),
            ("http://elsewhere.org", "localhost:8780"),
            ("http://localhost:8780.elsewhere.org", "localhost:8780"),
            ("http://elsewhere.org:8780", "elsewhere.org:8780"),  # whose name leads here
            ("http://localhost:8780", None),
        ):
            self.assertFalse(origin_is_ours(origin, host, names), "%s %s" % (origin, host))


TRIANGLE = [[0, 0, 0], [1, 0, 0], [0, 1, 0.5]]


class Drawings(unittest.TestCase):
    def test_meshes(self):
        data = b"solid in name only".ljust(80) + struct.pack("<I12fH", 1, 0, 0, 1, *sum(TRIANGLE, []), 0)
        self.assertEqual(read_stl(data).tolist(), TRIANGLE)
        text = "solid a\nfacet normal 0 0 1\nouter loop\n%s\nendloop\nendfacet\nendsolid" % "\n".join("vertex %g %g %g" % tuple(row) for row in TRIANGLE)
        self.assertEqual(read_stl(text.encode()).tolist(), TRIANGLE)
        square = b"v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1/1 2/2 3/3 -1//4\n"
        self.assertEqual(read_obj(square).tolist(), [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 0, 0], [1, 1, 0], [0, 1, 0]])
        for reader, bad in ((read_stl, b""), (read_stl, data[:-1]), (read_obj, b"v 0 0\nf 1 2 3\n"), (read_obj, square.replace(b"f 1/1", b"f 0/1"))):
            with self.assertRaises((ValueError, IndexError)):
                reader(bad)

    def test_only_files_of_packages(self):
        self.assertEqual(triangles_of("package://wavetank/meshes/sphere.stl").shape[1], 3)
        for uri in (
            "file:///etc/passwd",
            "/etc/passwd",
            "package://wavetank/../../etc/a.stl",
            "package://no_such_package/a.stl",
            "package://wavetank/package.xml",
            "package://wavetank/\0.stl",
        ):
            self.assertIsNone(triangles_of(uri), uri)

    def test_no_way_leads_out_of_a_package(self):
        mesh = os.path.realpath(package_path("package://wavetank/meshes/sphere.stl"))
        with tempfile.TemporaryDirectory(prefix="wavetank_test_") as folder:
            package = os.path.join(folder, "made_package")
            os.mkdir(package)
            with open(os.path.join(package, "package.xml"), "w") as file:
                file.write("<package><name>made_package</name></package>")
            shutil.copy(mesh, os.path.join(folder, "outside.stl"))
            shutil.copy(mesh, os.path.join(package, "inside.stl"))
            os.symlink(os.path.join(folder, "outside.stl"), os.path.join(package, "link.stl"))
            os.mkfifo(os.path.join(package, "pipe.stl"))  # nobody writes into it
            with unittest.mock.patch.dict(os.environ, {"ROS_PACKAGE_PATH": folder}):
                self.assertIsNotNone(triangles_of("package://made_package/inside.stl"))
                for name in (os.path.join(folder, "outside.stl"), mesh, "../outside.stl", "link.stl", "pipe.stl", "none.stl"):
                    self.assertIsNone(triangles_of("package://made_package/" + name), name)

    def test_markers_come_and_go(self):
        drawing = Drawing()
        colour, zero = {part: 0.5 for part in "rgba"}, {axis: 0.0 for axis in "xyzw"}
        marker = {
            "ns": "bodies", "id": numpy.int32(3), "type": numpy.int32(10), "action": numpy.int32(0), "header": {"frame_id": "tank/bodies/boat"}, "color": colour, "text": "",
            "pose": {"position": zero, "orientation": zero}, "scale": zero, "points": [], "mesh_resource": "package://wavetank/meshes/sphere.stl",
        }  # fmt: skip
        erase = dict(marker, action=numpy.int32(3))
        self.assertEqual(drawing.follow({"markers": [erase, marker, dict(marker, id=numpy.int32(4), type=numpy.int32(2))]}), "drawing")
        header, arrays = unpack(drawing.packet())
        self.assertEqual([(part["number"], part["body"]) for part in header["parts"]], [(3, "boat"), (4, "boat")])
        self.assertEqual(len(arrays[header["parts"][0]["points"]]) % 9, 0)
        for n in (7, 8, 8):  # a mooring's line, again and again
            self.assertEqual(drawing.follow({"markers": [dict(marker, id=numpy.int32(n), ns="moorings", type=numpy.int32(4))]}), "lines")
        self.assertEqual([part["number"] for part in unpack(drawing.packet("lines"))[0]["parts"]], [7, 8])
        drawing.follow({"markers": [dict(marker, id=numpy.int32(7), ns="moorings", action=numpy.int32(2))]})
        self.assertEqual([part["number"] for part in unpack(drawing.packet("lines"))[0]["parts"]], [8])
        self.assertEqual(len(unpack(drawing.packet())[0]["parts"]), 2)
        drawing.follow({"markers": [erase, marker]})
        self.assertEqual(len(unpack(drawing.packet())[0]["parts"]), 1)
        self.assertEqual(unpack(drawing.packet("lines"))[0]["parts"], [])


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


class Cases(unittest.TestCase):
    def test_whatever_a_bag_has_in_its_place(self):
        nothing = {"title": "", "dimensions": 3, "spacing": None, "world_frame": "tank", "free": {}}
        for text in (None, "", "[", "- a", "3", "tank: water\nbodies: 3", "tank: [1]\nbodies: {a: b}", "fluid: [0.1]", "fluid: {spacing: .nan}", "fluid: {spacing: true}",
                     "fluid: {spacing: 1%s}" % ("0" * 400), "bodies: [{motion: free}, 3, {name: [a], motion: free}]", "a: 2001-99-99", "? [1]\n: 2", "[" * 5000):  # fmt: skip
            self.assertEqual(read_case(text), nothing, str(text)[:80])
        found = read_case("tank: {motion: free, mass: .inf}\nbodies: [{name: a, motion: free, mass: 2}, {name: b}]\nworld_frame: pool\nfluid: {spacing: 0.1}")
        self.assertEqual(found, dict(nothing, spacing=0.1, world_frame="pool", free={"tank": None, "a": 2.0}))

    def test_a_push_is_along_the_axes_of_the_tank(self):
        for text, frame in (("bodies: [{name: a, motion: free}]", "tank"), ("bodies: [{name: a, motion: free}]\nworld_frame: pool", "pool")):
            with unittest.mock.patch("rospy.Subscriber"), unittest.mock.patch("rospy.Publisher") as publisher:
                live = Live("wavetank", lambda kind, packet: None)
                live._case_came(Came(String(text)))
                live.call({"do": "push", "body": "a", "force": [1.0, 0.0, 0.0], "torque": [0.0, 0.0, 0.0]})
            self.assertEqual(publisher.return_value.publish.call_args[0][0].header.frame_id, frame)


class Messages(WithBag):
    def test_messages_one_by_one(self):
        recording = Recording(self.bag)
        drawings = recording.stream("markers", "visualization_msgs/MarkerArray", header_at=4, take_recorded=True)
        self.assertEqual(drawings.stamps.tolist(), [1, 500000000, 750000000])
        self.assertEqual([marker["ns"] for marker in drawings.read(1)["markers"]], ["moorings"])

    def test_lines_are_those_of_the_time_also_back(self):
        stamped = self.bag + ".stamped.bag"
        write_bag(stamped, stamped_lines=True)
        for bag in (self.bag, stamped):
            replay = Replay(bag)
            for time, heights in ((0.9, [1.0]), (0.6, [0.0]), (0.2, []), (0.75, [1.0]), (0.0, [])):
                header, arrays = unpack(replay.pictures(time, "free_surface")["lines"])
                self.assertEqual([arrays[part["points"]][5] for part in header["parts"]], heights, "%s %g" % (bag, time))
            self.assertEqual(len(unpack(replay.pictures(0.9, "free_surface")["lines"])[0]["parts"]), 1)

    def test_plots_are_thinned_evenly_and_values_are_exact(self):
        replay, mailbox = Replay(self.bag), Mailbox()
        with unittest.mock.patch("wavetank.web.replay.SHOWN_SAMPLES", 60):
            replay.greet(mailbox)
        arrays = unpack(mailbox.take()[0])[1]
        times = arrays["times"]
        self.assertTrue(40 < len(times) <= 60, len(times))
        self.assertEqual((times[0], times[-1], arrays["values"][-1]), (0.0, 1.0, PRESSURE))
        self.assertLess(numpy.diff(times).max(), 0.04)
        for water, time, seen in (("free_surface", 0.6, 0.6), ("free_surface", 0.7, 0.6), ("surface", 0.6, 0.5)):
            kind = "cloud" if water == "free_surface" else "surface"
            self.assertEqual(unpack(replay.pictures(time, water)[kind])[0]["values"], {"probes": [10.0 * round(seen * 200)]})


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


class Came:
    """A message as rospy.AnyMsg has it."""

    def __init__(self, message, cut=None):
        self._connection_header = {"type": message._type, "md5sum": message._md5sum, "message_definition": message._full_text}
        buffer = io.BytesIO()
        message.serialize(buffer)
        self._buff = buffer.getvalue()[:cut]


class LiveTank(unittest.TestCase):
    """A tank that runs as the page's source, its topics played by hand."""

    def setUp(self):
        self.sent, self.heard = [], {}
        self.warned = []

        def subscribe(topic, kind, hear, callback_args=None, **more):
            self.heard[topic] = hear if callback_args is None else lambda message: hear(message, callback_args)
            return unittest.mock.Mock()

        patches = (
            unittest.mock.patch("rospy.Subscriber", subscribe),
            unittest.mock.patch("rospy.Publisher"),
            unittest.mock.patch(
                "rospy.get_published_topics", lambda: [("/wavetank/probes", "wavetank/ProbeArray"), ("/wavetank/bodies/boat/odom", "nav_msgs/Odometry")]
            ),
            unittest.mock.patch("rospy.logwarn", lambda text, *values: self.warned.append(text % values)),
        )
        for patch in patches:
            patch.start()
            self.addCleanup(patch.stop)
        self.live = Live("wavetank", lambda kind, packet: self.sent.append((kind, packet)))
        self.live.look_around()

    def hear(self, name, message, cut=None):
        self.heard["/wavetank/" + name](Came(message, cut))

    def probe(self, stamp, names=("P1",), pressures=(0.0,), cut=None):
        message = ProbeArray(names=list(names), positions=[Point() for _ in names], pressures=list(pressures))
        message.header.stamp = rospy.Time.from_sec(stamp)
        self.hear("probes", message, cut)

    def samples(self):
        return [(times.tolist(), values.ravel().tolist(), clear) for _, times, values, clear in self.live.samples()]

    def pose(self, x, cut=None):
        odometry = Odometry()
        odometry.pose.pose.position.x, odometry.pose.pose.orientation.w = x, 1.0
        self.hear("bodies/boat/odom", odometry, cut)

    def test_what_cannot_be_read_is_left_out_and_told_once(self):
        self.probe(1.0, pressures=[5.0])
        self.assertEqual(self.samples(), [([1.0], [5.0], True)])
        for n in range(2):
            self.probe(1.1, pressures=[])  # a name without a value
            self.assertEqual(self.samples(), [])
            self.probe(1.1, cut=30)
            self.assertEqual(self.samples(), [])
            for x, cut in ((1.0, 40), (math.nan, None)):
                self.pose(x, cut)
                self.assertEqual(self.live.poses()["poses"], {})
            self.hear("case", String("title: a"), cut=2)
        self.probe(1.2, names=[], pressures=[])  # nothing is measured
        self.probe(1.3, pressures=[6.0])
        self.assertEqual(self.samples(), [([1.3], [6.0], False)])
        self.pose(2.0)
        self.assertEqual(self.live.poses()["poses"], {"boat": [2.0, 0, 0, 0, 0, 0, 1]})
        self.assertEqual([text.split()[0] for text in self.warned], ["/wavetank/probes", "/wavetank/bodies/boat/odom", "/wavetank/case"])

    @unittest.skipIf(NO_SERVER, NO_SERVER)
    def test_another_tank_begins_with_nothing_of_the_one_before(self):
        from wavetank.web.server import Hub

        hub, mailbox = Hub(1), Mailbox()
        hub.run_changed = self.live.forget
        hub.clients.add(unittest.mock.Mock(mailbox=mailbox, wants=lambda kind: kind != "free_surface"))

        def play():
            for sent in self.sent:
                hub.publish(*sent)
            self.sent.clear()
            for sample in self.live.samples():
                hub.add(*sample)

        erase = Marker(action=Marker.DELETEALL)
        self.hear("case", String("title: first"))
        self.hear("markers", MarkerArray([erase, box_marker("tank", "tank", (0, 0, 0), (1, 1, 1), (1, 1, 1, 1))]))
        self.hear("markers", MarkerArray([box_marker("moorings", "tank", (0, 0, 0), (1, 1, 1), (1, 1, 1, 1))]))
        self.probe(1.0)
        self.pose(1.0)
        play()
        hub.publish("poses", self.live.poses())
        hub.publish("particles", b"first")
        hub.publish("free_surface", b"nobody wants it")
        self.hear("case", String("title: first"))  # as it comes again when the connection breaks
        play()
        self.assertEqual(set(hub.newest), {"hello", "drawing", "lines", "silence", "poses", "particles"})

        self.hear("case", String("title: second"))
        self.hear("markers", MarkerArray([erase, box_marker("tank", "tank", (0, 0, 0), (2, 1, 1), (1, 1, 1, 1))]))
        play()
        self.assertEqual(set(hub.newest), {"hello", "drawing", "silence"})
        self.assertEqual(json.loads(hub.newest["hello"])["title"], "second")
        late = Mailbox()
        self.live.greet(late)
        self.assertEqual(late.take(), (None, False))
        self.probe(0.5)
        play()
        taken = []
        while True:
            packet, _ = mailbox.take()
            if packet is None:
                break
            taken.append(unpack(packet)[0] if isinstance(packet, bytes) else json.loads(packet))
        self.assertEqual([packet.get("title", packet["kind"]) for packet in taken], ["first", "first", "second", "series", "silence", "drawing"])
        self.assertEqual((taken[2]["run"] - taken[1]["run"], taken[3]["clear"]), (1, True))

    def status(self, stamp, time):
        message = SolverStatus(time=time, phase=SolverStatus.RUNNING)
        message.header.stamp = rospy.Time.from_sec(stamp)
        self.hear("status", message)

    def test_after_a_reset_samples_begin_at_time_0(self):
        self.status(0.5, 0.5)
        self.probe(0.0, pressures=[1.0])
        self.probe(2.25, pressures=[2.0])
        self.assertEqual(self.samples(), [([0.0, 2.25], [1.0, 2.0], True)])
        self.status(2.25, 2.25)
        self.probe(3.0, pressures=[3.0])  # whose status is still on its way
        self.assertEqual(self.samples(), [([3.0], [3.0], False)])
        self.probe(3.5, pressures=[4.0])
        self.status(3.5, 0.5)
        self.assertEqual(self.samples(), [([0.0, 0.5], [3.0, 4.0], True)])
        self.probe(3.75, pressures=[5.0])
        self.assertEqual(self.samples(), [([0.75], [5.0], False)])
        mailbox = Mailbox()
        self.live.greet(mailbox)
        self.assertEqual(unpack(mailbox.take()[0])[1]["times"].tolist(), [0.0, 0.5, 0.75])
        self.status(4.0, 0.0)  # and again, with nothing sampled yet
        self.assertEqual(self.samples(), [([], [], True)])
        self.status(0.25, 0.25)  # the node was started again
        self.probe(0.25, pressures=[6.0])
        self.samples()
        self.probe(0.5, pressures=[7.0])
        self.assertEqual(self.samples(), [([0.5], [7.0], False)])

    def test_a_master_that_is_none(self):
        for error in (http.client.BadStatusLine("x"), xml.parsers.expat.ExpatError("x"), ConnectionRefusedError()):
            with unittest.mock.patch("rospy.get_published_topics", unittest.mock.Mock(side_effect=error)):
                self.live.look_around()
            self.assertFalse(self.sent[-1][1]["master"])


@unittest.skipIf(NO_SERVER, NO_SERVER)
class Server(WithBag):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.process, cls.url = start_server(cls.bag, "--clients", "2")
        cls.addClassCleanup(end, cls.process)
        cls.host = cls.url[len("http://") : -1]

    def connect(self, origin=None, url=None):
        from tornado.httpclient import HTTPRequest
        from tornado.websocket import websocket_connect

        url = url or self.url
        return websocket_connect(HTTPRequest(url.replace("http", "ws") + "socket", headers={"Origin": origin or url[:-1]}))

    @staticmethod
    async def next_of(connection, kind):
        while True:
            packet = await asyncio.wait_for(connection.read_message(), 10)
            if packet is None:
                raise AssertionError("closed before a %s came" % kind)
            header, arrays = unpack(packet) if isinstance(packet, bytes) else (json.loads(packet), {})
            if header["kind"] not in ("answer", "series"):
                await connection.write_message('{"do": "seen"}')
            if header["kind"] == kind:
                return header, arrays

    def test_pictures_of_a_time(self):
        async def talk():
            connection = await self.connect()
            hello, _ = await self.next_of(connection, "hello")
            self.assertEqual((hello["waters"], hello["spacing"], len(hello["times"])), (["free_surface", "surface"], 0.04, 7))
            series, arrays = await self.next_of(connection, "series")
            self.assertEqual((series["name"], series["units"], arrays["values"][-1], len(arrays["times"])), ("probes", ["Pa"], PRESSURE, 201))
            for time, expected in ((0, 0.0), (0.39, 0.2), (0.4, 0.4), (99, 1.0), (0.5, 0.4), (0.7, 0.6)):
                await connection.write_message(json.dumps({"do": "frame", "time": time, "water": "free_surface"}))
                cloud, arrays = await self.next_of(connection, "cloud")
                self.assertEqual((cloud["time"], len(arrays["points"])), (expected, 4 * 4875))
                numpy.testing.assert_allclose(cloud["poses"]["boat"], [1.5, 0, expected, 0, 0, 0, 1])
                lines, _ = await self.next_of(connection, "lines")
                self.assertEqual([part["group"] for part in lines["parts"]], ["moorings"] if time >= 0.5 else [])
            for time, expected, corners, drops in ((0.4, 0.0, 0, 0), (0.6, 0.5, 36, 2)):
                await connection.write_message(json.dumps({"do": "frame", "time": time, "water": "surface"}))
                surface, arrays = await self.next_of(connection, "surface")
                self.assertEqual((surface["time"], len(arrays["corners"]), len(arrays["points"])), (expected, corners, 4 * 8 if corners else 0))
                spray, arrays = await self.next_of(connection, "spray")
                self.assertEqual((len(arrays["points"]), surface["poses"].keys()), (3 * drops, {"boat"}))
            connection.close()

        asyncio.run(talk())

    def test_what_cannot_be_read_gets_an_answer_and_the_next_is_heard(self):
        bag = self.bag + ".damaged.bag"
        write_bag(bag, compression="bz2", chunk_threshold=100000, broken_at=40)
        process, url = start_server(bag)
        self.addCleanup(end, process)
        chunks = BagFile(bag)._all_chunks()
        place = Recording(bag).stream("free_surface", "sensor_msgs/PointCloud2")._found[3][1][0]
        with open(bag, "r+b") as file:  # of the cloud at 0.6 s
            file.seek(chunks[place][1])
            file.write(bytes(1000))

        async def talk():
            connection = await self.connect(url=url)
            for time, ok, word in ((0.4, True, ""), (0.6, False, "is not whole"), (0.2, False, "failed in the server"), (0.0, True, "")):
                await connection.write_message(json.dumps({"do": "frame", "time": time, "water": "free_surface"}))
                answer, _ = await self.next_of(connection, "answer")
                self.assertEqual(answer["ok"], ok, "%g: %s" % (time, answer))
                self.assertIn(word, answer["text"])
            connection.close()

        asyncio.run(talk())

    def test_a_pose_that_is_no_number_is_left_out(self):
        from wavetank.web.server import text_of

        bag = self.bag + ".lost.bag"
        write_bag(bag, lost_at=200)
        replay = Replay(bag)
        for time, bodies in ((0.2, ["boat"]), (1.0, [])):
            self.assertEqual(list(unpack(replay.pictures(time, "free_surface")["cloud"])[0]["poses"]), bodies)
        with self.assertRaises(ValueError):
            text_of({"kind": "poses", "poses": {"boat": [math.nan] * 7}})

    def test_what_is_not_allowed_gets_an_answer_and_the_next_is_heard(self):
        async def talk():
            connection = await self.connect()
            for bad in ("{", '{"do": "push"}', b"\x00", '{"do": "frame", "time": 0, "water": "particles"}', "x" * 5000):
                await connection.write_message(bad, binary=isinstance(bad, bytes))
                answer, _ = await self.next_of(connection, "answer")
                self.assertFalse(answer["ok"])
                self.assertGreater(len(answer["text"]), 10)
            await connection.write_message('{"do": "frame", "time": 0, "water": "free_surface"}')
            self.assertTrue((await self.next_of(connection, "answer"))[0]["ok"])
            connection.close()

        asyncio.run(talk())

    def test_a_foreign_page_is_not_let_in(self):
        from tornado.httpclient import HTTPClientError

        async def talk(origin):
            connection = await self.connect(origin)
            connection.close()

        for origin in ("http://elsewhere.org", "null", "http://localhost:1"):
            with self.assertRaises(HTTPClientError) as raised:
                asyncio.run(talk(origin))
            self.assertEqual(raised.exception.code, 403, origin)

    def test_no_more_pages_than_allowed(self):
        async def talk():
            first, second, third = [await self.connect() for _ in range(3)]
            await self.next_of(first, "hello")
            await self.next_of(second, "hello")
            self.assertIsNone(await asyncio.wait_for(third.read_message(), 10))
            self.assertEqual(third.close_code, 1013)
            self.assertIn("2 pages", third.close_reason)
            first.close()
            await asyncio.sleep(0.2)
            fourth = await self.connect()
            await self.next_of(fourth, "hello")
            second.close()
            fourth.close()
            await asyncio.sleep(0.2)

        asyncio.run(talk())

    def test_what_is_shown_follows_the_newest_wish_and_holds_nothing_up(self):
        from wavetank.web.server import Server

        class Slow(MadeTank):
            mode, shown, may_go_on = "live", [], threading.Event()
            samples = staticmethod(lambda: [])
            poses = look_around = forget = staticmethod(lambda: None)

            def show(self, wanted):
                self.shown.append(wanted)
                self.may_go_on.wait(10)

        async def talk():
            server, source, stopped = Server("127.0.0.1", 0, 1), Slow(), asyncio.Event()
            work = asyncio.ensure_future(server.serve(source, stopped))
            connection = await self.connect(url=server.url)
            for water in ("particles", "surface", "particles", "surface"):
                await connection.write_message(json.dumps({"do": "show", "water": water}))
                self.assertTrue((await self.next_of(connection, "answer"))[0]["ok"])
            self.assertEqual(source.shown, [{"particles"}], "the first is still waiting")
            source.may_go_on.set()
            await asyncio.sleep(0.1)
            self.assertEqual(source.shown, [{"particles"}, {"surface"}])
            connection.close()
            stopped.set()
            await work

        asyncio.run(talk())

    def test_a_page_that_does_not_take_its_pictures_is_made_none(self):
        from unittest import mock

        from wavetank.web import server as web
        from wavetank.web.server import Server

        class Noting(MadeTank):
            mode, shown = "live", []
            samples = staticmethod(lambda: [])
            poses = look_around = forget = staticmethod(lambda: None)

            def show(self, wanted):
                self.shown.append(wanted)

        async def talk():
            server, source, stopped = Server("127.0.0.1", 0, 1), Noting(), asyncio.Event()
            work = asyncio.ensure_future(server.serve(source, stopped))
            connection = await self.connect(url=server.url)
            await connection.write_message('{"do": "show", "water": "particles"}')
            await self.next_of(connection, "answer")
            for number in range(web.AHEAD + 1):
                server.hub.publish("particles", b"%d" % number)
                await asyncio.sleep(0.05)
            self.assertEqual(source.shown, [{"particles"}])
            await asyncio.sleep(0.6)
            self.assertEqual(source.shown, [{"particles"}, set()], "it was sent as many as may be ahead of what it has drawn")
            await connection.write_message('{"do": "seen"}')
            await asyncio.sleep(0.3)
            self.assertEqual(source.shown, [{"particles"}, set(), {"particles"}])
            connection.close()
            stopped.set()
            await work

        with mock.patch.multiple(web, PATIENCE=0.3, LOOK_EVERY=0.1):
            asyncio.run(talk())

    def test_ends_while_a_bag_is_being_read(self):
        code = "import os, signal, sys, time; import wavetank.web.replay as replay\nclass Slow:\n  def __init__(self, *more):\n    os.kill(os.getpid(), signal.SIGTERM); time.sleep(30)\nreplay.Replay = Slow\nfrom wavetank.web import command\nfrom wavetank import program\nsys.exit(program.run('web', command.main, ['any.bag', '--port', '0']))"
        done = subprocess.run([sys.executable, "-c", code], stdout=subprocess.PIPE, stderr=subprocess.PIPE, universal_newlines=True, timeout=20)
        self.assertEqual((done.returncode, done.stdout, done.stderr), (0, "", ""))

    def test_a_page_above_the_number_is_not_obeyed(self):
        from wavetank.web.server import Server

        async def talk():
            server, source, stopped = Server("127.0.0.1", 0, 1), MadeTank(), asyncio.Event()
            work = asyncio.ensure_future(server.serve(source, stopped))
            connection = await self.connect(url=server.url)
            await self.next_of(connection, "hello")
            push = {"do": "push", "body": "boat", "force": [1.0, 0.0, 0.0], "torque": [0.0, 0.0, 0.0]}
            reader, writer = await asyncio.open_connection("127.0.0.1", server.port)
            head = "GET /socket HTTP/1.1\r\nHost: %s\r\nOrigin: %s\r\nUpgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n"
            text = json.dumps(dict(push, force=[2, 0, 0])).encode()
            writer.write(
                (head % (server.url[len("http://") : -1], server.url[:-1])).encode() + bytes([0x81, 0x80 | len(text)]) + bytes(4) + text
            )  # masked by zeros
            self.assertIn(b"1 pages are open", await asyncio.wait_for(reader.readuntil(b"may be"), 10))
            await asyncio.sleep(0.1)
            await connection.write_message(json.dumps(push))
            self.assertTrue((await self.next_of(connection, "answer"))[0]["ok"])
            self.assertEqual(source.calls, [push])
            writer.close()
            connection.close()
            stopped.set()
            await work

        asyncio.run(talk())

    def test_by_any_address_of_this_machine_but_by_no_foreign_name(self):
        process, url = start_server(self.bag, "--address", "0.0.0.0")
        self.addCleanup(end, process)
        port = int(url[:-1].rpartition(":")[2])

        async def talk(url):
            connection = await self.connect(url=url)
            await self.next_of(connection, "hello")
            connection.close()

        own = "http://127.0.0.2:%d/" % port
        with urllib.request.urlopen(own) as page:
            self.assertEqual(page.status, 200)
        asyncio.run(talk(own))
        for host in ("elsewhere.org:%d" % port, "127.0.0.3"):
            with self.assertRaises(urllib.error.HTTPError, msg=host) as raised:
                urllib.request.urlopen(urllib.request.Request(own, headers={"Host": host}))
            self.assertEqual(raised.exception.code, 403, host)
            self.assertIn("--name", raised.exception.read().decode())

    def test_files(self):
        for name in ("", "page.js", "style.css", "library/three.js", "library/orbit.js", "library/dygraph.js", "library/dygraph.css"):
            with urllib.request.urlopen(self.url + name) as answer:
                self.assertGreater(len(answer.read()), 500)
                self.assertIn("default-src 'self'", answer.headers["Content-Security-Policy"])
        for name in ("../server.py", "%2e%2e/server.py", "library/..%2f..%2fpasswd", "library/jquery.js", "/etc/passwd"):
            with self.assertRaises(urllib.error.HTTPError, msg=name) as raised:
                urllib.request.urlopen(self.url + name)
            self.assertIn(raised.exception.code, (403, 404), name)

    def test_only_this_machine_is_listened_to(self):
        with socket.socket() as outside:
            outside.settimeout(2)
            own = socket.gethostbyname(socket.gethostname())
            if own.startswith("127."):
                self.skipTest("this machine has no other address by its name")
            self.assertNotEqual(outside.connect_ex((own, int(self.host.rpartition(":")[2]))), 0)

    def test_what_is_wrong_is_one_sentence(self):
        self.assertIn("is taken", self.refused(self.bag, "--port", self.host.rpartition(":")[2]))
        self.assertIn("no address of this machine", self.refused(self.bag, "--port", "0", "--address", "203.0.113.1"))
        self.assertIn("is empty", self.refused(self.bag, "--port", "0", "--address", ""))
        self.assertIn("0 to 65535", self.refused(self.bag, "--port", "99999"))
        self.assertIn("there is no bag", self.refused(self.bag + ".not", "--port", "0"))
        dry = self.bag + ".dry.bag"
        write_bag(dry, clouds=False)
        self.assertIn("no point clouds: write it with wavetank_run --clouds", self.refused(dry, "--port", "0"))
        short = self.bag + ".short.bag"
        for topic, message in (("markers", MarkerArray([Marker()])), ("surface_mesh", Marker()), ("probes", ProbeArray(names=["P1"]))):
            shutil.copy(self.bag, short)
            with rosbag.Bag(short, "a") as bag:
                buffer = io.BytesIO()
                message.serialize(buffer)
                bag.write("/wavetank/" + topic, (message._type, buffer.getvalue()[:6], message._md5sum, type(message)), rospy.Time(0, 1), raw=True)
            with self.assertRaises(Failure, msg=topic) as raised:
                Replay(short)
            self.assertIn("cannot be read", str(raised.exception))

    def test_ends_cleanly_with_a_page_open(self):
        process, url = start_server(self.bag)
        self.addCleanup(end, process)

        async def talk():
            connection = await self.connect(url=url)
            await self.next_of(connection, "hello")
            process.terminate()
            while await asyncio.wait_for(connection.read_message(), 10) is not None:
                pass
            return connection.close_code

        self.assertEqual(asyncio.run(talk()), 1001)
        process.communicate(timeout=10)
        self.assertEqual(process.returncode, 0)


class MissingPackages(WithBag):
    def test_the_package_is_named(self):
        code = "import sys; sys.modules['tornado'] = None; import wavetank.web.libraries as l; l.JAVASCRIPT = '/no'\nfrom wavetank.web import command\nfrom wavetank import program\nsys.exit(program.run('web', command.main, sys.argv[1:]))"
        done = subprocess.run([sys.executable, "-c", code, self.bag], stdout=subprocess.PIPE, stderr=subprocess.PIPE, universal_newlines=True, timeout=30)
        self.assertEqual(done.returncode, 2, done.stderr)
        self.assertIn("apt-get install libjs-dygraphs libjs-three python3-tornado", done.stderr)
        self.assertEqual(len(done.stderr.splitlines()), 1, done.stderr)


# A block of water with spray over it, as all its particles are drawn and as those in sight alone are: whether the pictures are the same, and how many were drawn.
CLOUD_WITH_AND_WITHOUT_HIDDEN = """
    const view = wavetank.view, points = new Uint16Array(4 * 30000);
    let state = 7;
    const next = () => (state = (state * 48271) % 2147483647) / 2147483647;
    for (let i = 0; i < points.length; i += 4) {
      points[i] = 65535 * next();
      points[i + 1] = 65535 * next();
      points[i + 2] = 65535 * next() * (next() < 0.01 ? 1 : 0.4);
      points[i + 3] = 65535 * next();
    }
    view.showCloud({ points, low: [0.2, 0.1, 0.1], size: [1.6, 0.8, 0.8], top_speed: 2, typical_speed: 1, poses: null });
    view.diameter = view.water.material.uniforms.diameter.value = 0.03;
    const drawn = [true, false].map((slow) => {
      view.slow = slow;
      view._fillWater();
      view.renderer.render(view.scene, view.camera);
      return [view.canvas.toDataURL(), view.water.geometry.drawRange.count];
    });
    view.slow = true;
    return [drawn[0][0] === drawn[1][0], drawn[1][1], drawn[0][1], points.length / 4];"""


@unittest.skipIf(NO_SERVER or MISSING, NO_SERVER or MISSING)
class InTheBrowser(WithBag):
    def test_a_bag(self):
        process, url = start_server(self.bag)
        self.addCleanup(end, process)
        browser = Browser()
        self.addCleanup(browser.quit)
        browser.driver.get(url)
        browser.wait("window.wavetank && wavetank.received > 0 && !wavetank.player.playing && wavetank.time === 1", 30)
        self.assertEqual(browser.get("document.getElementById('title').textContent"), "A <b>made</b> bag")
        self.assertEqual(browser.get("[...wavetank.plots.all.values()][0].rows.slice(-1)[0]"), [1.0, PRESSURE])
        browser.wait("document.querySelector('.plot .values').textContent.includes('1235')")
        self.assertGreater(browser.water_share(), 0.05)
        self.assertEqual(browser.get("wavetank.view.drawn.get('boat').position.toArray()"), [1.5, 0, 1])
        browser.driver.execute_script("const water = document.getElementById('water'); water.value = 'surface'; water.dispatchEvent(new Event('change'))")
        browser.wait("wavetank.what === '12 triangles' && wavetank.view.surface.visible")
        self.assertGreater(browser.water_share(), 0.05)
        browser.driver.execute_script("wavetank.view.hideWater()")
        self.assertLess(browser.water_share(), 0.02)
        browser.press("reset")
        browser.wait("wavetank.time < 1e-8 && wavetank.view.drawn.get('boat').position.z === 0")
        browser.driver.execute_script("const water = document.getElementById('water'); water.value = 'free_surface'; water.dispatchEvent(new Event('change'))")
        browser.press("step")
        browser.wait("wavetank.time === 0.2")
        self.assertEqual(browser.get("document.querySelector('.plot .values').textContent.trim()").split()[0], "P1")
        self.assertTrue(math.isclose(browser.get("[...wavetank.plots.all.values()][0].row()[1]"), 400.0))
        same, all_drawn, drawn, given = browser.driver.execute_script(CLOUD_WITH_AND_WITHOUT_HIDDEN)
        self.assertTrue(same)
        self.assertEqual(all_drawn, given)
        self.assertTrue(1000 < drawn < given / 2, drawn)
        self.assertEqual(browser.errors(), [])
        bad = ("wavetank._hear('{')", """wavetank._hear('{"kind": "poses", "poses": {"boat": null}}')""", "wavetank._hear(new ArrayBuffer(2))")
        self.assertEqual(browser.driver.execute_script("const before = wavetank.unseen; %s; return wavetank.unseen - before" % "; ".join(bad)), 3)
        self.assertIn("cannot be shown", browser.get("document.getElementById('answer').textContent"))
        self.assertEqual(len(browser.errors()), 3)
        browser.press("step")
        browser.wait("wavetank.time === 0.4")
        browser.quit()
        self.assertEqual(end(process), 0)

    def test_a_tank_that_is_reset_falls_silent_and_is_another(self):
        from selenium.webdriver import ActionChains
        from wavetank.web.server import Server

        source, ready, running = MadeTank(), threading.Event(), {}

        async def serve():
            running.update(server=Server("127.0.0.1", 0, 1), stopped=asyncio.Event(), loop=asyncio.get_running_loop())
            ready.set()
            await running["server"].serve(source, running["stopped"])

        thread = threading.Thread(target=asyncio.run, args=(serve(),))
        thread.start()
        ready.wait()
        hub = running["server"].hub

        def do(function, *arguments):
            running["loop"].call_soon_threadsafe(function, *arguments)

        def status(stamp, time):
            do(hub.publish, "status", {"kind": "status", "stamp": stamp, "time": time, "step": 1, "phase": 1, "paused": False, "real_time_factor": None})

        def silent(is_so):
            do(hub.publish, "silence", {"kind": "silence", "silent": is_so, "master": True})

        def sample(times, clear):
            do(hub.add, {"name": "probes", "columns": ["P"], "units": ["Pa"]}, numpy.array(times), numpy.array([times]).T, clear)

        self.addCleanup(thread.join)
        self.addCleanup(do, running["stopped"].set)
        browser = Browser()
        self.addCleanup(browser.quit)
        browser.driver.get(running["server"].url)
        browser.wait("window.wavetank && wavetank.hello")
        clock, values = "document.getElementById('clock').textContent", "document.querySelector('.plot .values').textContent"
        status(5.5, 5.5)
        sample([1.0, 2.0], True)
        browser.wait("wavetank.plots.all.size && %s === 't = 5.500 s' && %s === 'P 2'" % (clock, values))
        status(6.0, 0.0)
        sample([], True)
        browser.wait("%s === 't = 0.000 s' && %s === 'P –'" % (clock, values))
        sample([0.5], False)
        browser.wait(values + " === 'P 0.5'")

        silent(False)
        button = browser.driver.find_element("css selector", "#pushes button")
        browser.wait("!document.querySelector('#pushes button').disabled")
        ActionChains(browser.driver).click_and_hold(button).perform()
        while len(source.calls) < 3:
            time.sleep(0.01)
        silent(True)  # so that the button is disabled while it is held
        browser.wait("document.querySelector('#pushes button').disabled")
        time.sleep(0.3)
        self.assertEqual(source.calls[-1]["force"], [0, 0, 0])
        pushes = len(source.calls)
        ActionChains(browser.driver).release().perform()
        silent(False)
        time.sleep(0.3)
        self.assertEqual(len(source.calls), pushes, "it is not held any more")

        source.run = 1
        do(hub.publish, "hello", source.hello())
        browser.wait("document.title.startsWith('run 1') && !wavetank.plots.all.size")
        self.assertEqual(browser.errors(), [])
        browser.quit()


if __name__ == "__main__":
    unittest.main()
