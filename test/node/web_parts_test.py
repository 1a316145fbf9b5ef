#!/usr/bin/env python3
"""The parts of the page's server: what is sent, what may be asked for, and where pictures and samples come from."""

import http.client
import io
import json
import math
import os
import shutil
import struct
import tempfile
import time
import unittest
import unittest.mock
import xml.parsers.expat
import numpy
import rospy
from geometry_msgs.msg import Point
from nav_msgs.msg import Odometry
from page_browser import NO_SERVER
from std_msgs.msg import String
from visualization_msgs.msg import Marker, MarkerArray
from wavetank.msg import ProbeArray, SolverStatus
from wavetank.meshes import package_path, read_obj, read_stl, triangles_of
from wavetank.recording import Recording
from wavetank.web.drawing import Drawing
from wavetank.web.live import Live
from wavetank.web.mailbox import Mailbox
from wavetank.web.packets import cloud_packet, pack, surface_packet, unpack
from wavetank.web.replay import Replay, read_case
from wavetank.web.requests import LIVE, REPLAY, Refused, origin_is_ours, read_request
from wavetank.web.series import Series
from web_bags import KNOWN, PRESSURE, WithBag, box_marker, write_bag

RANDOM = numpy.random.default_rng(5)


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


if __name__ == "__main__":
    unittest.main()
