#!/usr/bin/env python3
"""The reader of bags, against bags made here whose every bit is known, and export as a user runs it."""

import csv
import glob
import math
import os
import resource
import shutil
import struct
import subprocess
import sys
import tempfile
import unittest

import numpy
import rosbag
import rospy
import wavetank
from geometry_msgs.msg import Point, Vector3, Vector3Stamped, WrenchStamped
from nav_msgs.msg import Odometry
from sensor_msgs.msg import Imu, JointState
from std_msgs.msg import String
from wavetank.msg import MooringTension, OpeningFlow, ProbeArray, SectionFlow, SolverStatus, WaveGaugeArray
from wavetank.bag_file import BagFile
from wavetank.recording import Recording

SCRIPTS = os.path.join(os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__)))), "scripts")
COUNT = 500
RANDOM = numpy.random.default_rng(20).integers(0, 2**64, (COUNT, 8), dtype=numpy.uint64).view(numpy.float64)  # any bits: infinities, denormals
RANDOM[numpy.isnan(RANDOM)] = -0.0
SPEEDS = RANDOM[:, 0].copy()
SPEEDS[7] = math.nan  # of a velocity probe that is out of the water

try:
    import pandas
except ImportError:
    pandas = None
try:
    import h5py
except ImportError:
    h5py = None


def same_bits(a, b):
    return numpy.asarray(a, dtype=float).tobytes() == numpy.asarray(b, dtype=float).tobytes()


def stamped(message, milliseconds):
    message.header.stamp = rospy.Time(milliseconds // 1000, milliseconds % 1000 * 1000000)
    message.header.frame_id = "tank"
    return message


def write_tank(bag, namespace, order):
    """Every kind of instrument, n-th sample at n ms, written in this order."""
    bag.write(namespace + "/case", String("title: made here"), rospy.Time(0, 1))
    for n in order:
        at = rospy.Time.from_sec(0.001 * (n + 1))
        row = RANDOM[n].tolist()
        probes = ProbeArray(names=["P%d" % k for k in range(8)], pressures=row, positions=[Point(k, 0, 0.5) for k in range(8)])
        bag.write(namespace + "/probes", stamped(probes, n), at)
        bag.write(namespace + "/gauges", stamped(WaveGaugeArray(names=["left", "right"], levels=row[:2], positions=[Point(1, 2, 3)] * 2), n), at)
        bag.write(namespace + "/velocities/V1", stamped(Vector3Stamped(vector=Vector3(SPEEDS[n], row[1], row[2])), n), at)
        bag.write(namespace + "/sections/weir", stamped(SectionFlow(discharge=row[3], area=row[4]), n), at)
        imu = stamped(Imu(), n)
        imu.orientation.w, imu.angular_velocity.y, imu.linear_acceleration.z = row[5], row[6], row[7]
        bag.write(namespace + "/bodies/hull/imu", imu, at)
        tension = MooringTension(tension=row[0], anchor_tension=row[1], lying=row[2])
        bag.write(namespace + "/bodies/hull/moorings/bow/tension", stamped(tension, n), at)
        wrench = stamped(WrenchStamped(), n)
        wrench.wrench.force.x, wrench.wrench.torque.z = row[2], row[3]
        bag.write(namespace + "/bodies/hull/wrench", wrench, at)
        odometry = stamped(Odometry(), n)
        odometry.pose.pose.position.y, odometry.twist.twist.angular.z = row[4], row[5]
        bag.write(namespace + "/bodies/hull/odom", odometry, at)
        bag.write(namespace + "/openings/hose/flow", stamped(OpeningFlow(discharge=row[6], volume=row[7]), n), at)
        bag.write(namespace + "/joint_states", stamped(JointState(name=["elbow"], position=row[:1], velocity=row[1:2], effort=row[2:3]), n), at)
        status = SolverStatus(title="made here", time=0.001 * n, step=n, kinetic_energy=row[0], failure="burst" if n == COUNT - 1 else "")
        bag.write(namespace + "/status", stamped(status, n), at)


class BagTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.mkdtemp()
        cls.bag = cls.path("one.bag")
        order = list(range(COUNT))
        order[10:20] = reversed(order[10:20])  # as a bag recorded over topics may have it
        with rosbag.Bag(cls.bag, "w", chunk_threshold=20000) as bag:
            write_tank(bag, "/wavetank", order)

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(cls.folder)

    @classmethod
    def path(cls, name):
        return os.path.join(cls.folder, name)


class Reader(BagTest):
    def test_has_the_bits_of_every_instrument_in_the_order_of_time(self):
        tables = wavetank.read_tables(self.bag)
        names = ["probes", "gauges", "velocities/V1", "sections/weir", "bodies/hull/odom", "bodies/hull/wrench", "bodies/hull/imu"]
        self.assertEqual(list(tables), names + ["bodies/hull/moorings/bow/tension", "openings/hose/flow", "joint_states", "status"])
        for name, column, number in (
            ("probes", "P7", 7),
            ("gauges", "right", 1),
            ("velocities/V1", "velocity_y", 1),
            ("velocities/V1", "velocity_z", 2),
            ("sections/weir", "discharge", 3),
            ("sections/weir", "area", 4),
            ("bodies/hull/imu", "orientation_w", 5),
            ("bodies/hull/imu", "angular_velocity_y", 6),
            ("bodies/hull/imu", "specific_force_z", 7),
            ("bodies/hull/moorings/bow/tension", "tension", 0),
            ("bodies/hull/moorings/bow/tension", "anchor_tension", 1),
            ("bodies/hull/moorings/bow/tension", "lying", 2),
            ("bodies/hull/odom", "position_y", 4),
            ("bodies/hull/odom", "angular_velocity_z", 5),
            ("bodies/hull/wrench", "force_x", 2),
            ("bodies/hull/wrench", "torque_z", 3),
            ("openings/hose/flow", "discharge", 6),
            ("joint_states", "elbow effort", 2),
            ("status", "kinetic_energy", 0),
        ):
            self.assertTrue(same_bits(tables[name].columns[column], RANDOM[:, number]), "%s of %s" % (column, name))
        self.assertTrue(same_bits(tables["velocities/V1"].columns["velocity_x"], SPEEDS))
        for table in tables.values():
            self.assertEqual(table.stamps.tolist(), [n * 1000000 for n in range(COUNT)])
            self.assertEqual(table.times.tolist(), [float("0.%03d" % n) for n in range(COUNT)])
        self.assertEqual(tables["probes"].positions["P3"], (3.0, 0.0, 0.5))
        self.assertEqual(tables["probes"].units["P3"], "Pa")
        self.assertEqual(tables["status"].columns["step"].tolist(), list(range(COUNT)))
        self.assertEqual(tables["status"].texts["failure"], "burst")
        self.assertEqual(Recording(self.bag).text("case"), "title: made here")

    def test_reads_compressed_bags_and_tells_where_they_are_damaged(self):
        packed = self.path("packed.bag")
        for compression in (rosbag.Compression.BZ2, rosbag.Compression.LZ4):
            with rosbag.Bag(packed, "w", compression=compression) as bag:
                write_tank(bag, "/wavetank", range(COUNT))
            self.assertTrue(same_bits(wavetank.read_tables(packed)["probes"].columns["P0"], RANDOM[:, 0]))
            (place, *_) = BagFile(packed)._scan()
            with open(packed, "r+b") as file:
                file.seek(place[1])
                file.write(b"damaged")
            with self.assertRaisesRegex(wavetank.Failure, "packed.bag' is not whole"):
                wavetank.read_tables(packed)

    def test_takes_the_tank_that_is_named(self):
        two = self.path("two.bag")
        with rosbag.Bag(two, "w") as bag:
            write_tank(bag, "/first", range(3))
            write_tank(bag, "/lab/second", range(5))
        self.assertEqual(len(wavetank.read_tables(two, "lab/second")["probes"]), 5)
        with self.assertRaisesRegex(wavetank.Failure, "several tanks: choose one of /first, /lab/second by --namespace"):
            wavetank.read_tables(two)

    def test_what_cannot_be_read_is_one_sentence(self):
        unfinished, text, empty = self.path("died.bag.active"), self.path("text.bag"), self.path("empty.bag")
        bag = rosbag.Bag(self.path("cut.bag"), "w")
        write_tank(bag, "/wavetank", range(3))
        bag.flush()
        shutil.copy(self.path("cut.bag"), unfinished)
        bag.close()
        with open(unfinished, "r+b") as file:  # as a run that was killed leaves it: no index yet
            content = file.read()
            place = content.index(b"index_pos=") + len(b"index_pos=")
            file.seek(place)
            file.write(struct.pack("<Q", 0))
        with open(text, "w") as file:
            file.write("no bag\n")
        open(empty, "w").close()
        for path, words in (
            (self.path("none.bag"), "there is no bag '.*none.bag'$"),
            (self.path("died.bag"), "there is no bag '.*died.bag' but '.*died.bag.active': it is being written, or the run .* died; .*rosbag reindex"),
            (unfinished, "is not whole: it is being written, or .* rosbag reindex makes it readable"),
            (self.folder, "is a folder, not a bag"),
            (text, "is no bag: it does not begin with '#ROSBAG V2.0'"),
            (empty, "is no bag"),
        ):
            with self.assertRaisesRegex(wavetank.Failure, words) as caught:
                wavetank.read_tables(path)
            self.assertEqual(len(str(caught.exception).splitlines()), 1)
        with open(self.bag, "rb") as whole, open(self.path("half.bag"), "wb") as half:
            half.write(whole.read()[:40000])
        with self.assertRaisesRegex(wavetank.Failure, "is not whole and has no index: rosbag reindex makes it readable"):
            wavetank.read_tables(self.path("half.bag"))

    @unittest.skipUnless(pandas, "python3-pandas is not installed: scripts/install --tools")
    def test_gives_data_frames(self):
        frames = wavetank.read_bag(self.bag)
        self.assertTrue(same_bits(frames["probes"]["P5"], RANDOM[:, 5]))
        self.assertEqual(frames["probes"].index.name, "time")
        self.assertEqual(frames["probes"].index[7], 0.007)
        self.assertEqual(frames["gauges"].attrs["units"], {"left": "m", "right": "m"})


class Export(BagTest):
    def run_export(self, *arguments):
        return subprocess.run(
            [sys.executable, os.path.join(SCRIPTS, "export")] + list(arguments), stdout=subprocess.PIPE, stderr=subprocess.PIPE, universal_newlines=True
        )

    def test_csv_has_units_and_every_bit(self):
        out = self.path("csv")
        done = self.run_export(self.bag, "--csv", out)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(len(glob.glob(os.path.join(out, "*.csv"))), 11)
        for name, head in (
            ("velocities.V1", "time (s),velocity_x (m/s),velocity_y (m/s),velocity_z (m/s)"),
            ("sections.weir", "time (s),discharge (m^3/s),area (m^2)"),
            ("bodies.hull.moorings.bow.tension", "time (s),tension (N),anchor_tension (N),lying (m)"),
        ):
            with open(os.path.join(out, name + ".csv")) as file:
                self.assertEqual(file.readline().strip(), head)
        with open(os.path.join(out, "bodies.hull.imu.csv"), newline="") as file:
            imu = list(csv.DictReader(file))
        self.assertTrue(same_bits([float(row["specific_force_z (m/s^2)"]) for row in imu], RANDOM[:, 7]))
        with open(os.path.join(out, "velocities.V1.csv"), newline="") as file:
            speeds = numpy.array([float(row["velocity_x (m/s)"]) for row in csv.DictReader(file)])
        self.assertTrue(numpy.array_equal(speeds, SPEEDS, equal_nan=True))
        with open(os.path.join(out, "probes.csv"), newline="") as file:
            head, *rows = csv.reader(file)
        self.assertEqual(head, ["time (s)"] + ["P%d (Pa)" % k for k in range(8)])
        self.assertEqual([row[0] for row in rows[:3]], ["0", "0.001", "0.002"])
        self.assertTrue(same_bits([[float(cell) for cell in row[1:]] for row in rows], RANDOM))
        if pandas:
            frame = pandas.read_csv(os.path.join(out, "probes.csv"), float_precision="round_trip")
            self.assertTrue(same_bits(frame.iloc[:, 1:].to_numpy(), RANDOM))

    @unittest.skipUnless(h5py, "python3-h5py is not installed: scripts/install --tools")
    def test_hdf5_has_units_and_every_bit(self):
        out = self.path("out.h5")
        done = self.run_export(self.bag, "--hdf5", out)
        self.assertEqual(done.returncode, 0, done.stderr)
        with h5py.File(out, "r") as file:
            self.assertTrue(same_bits(file["bodies/hull/wrench/force_x"][()], RANDOM[:, 2]))
            self.assertEqual(file["probes/P1"].attrs["unit"], "Pa")
            self.assertEqual(file["probes/P1"].attrs["position"].tolist(), [1.0, 0.0, 0.5])
            self.assertEqual(file["probes/_stamp"][3], 3000000)

    def test_long_records_take_little_time_and_memory(self):
        # a quarter of 25 000 samples; measured for all of them in docs/tools.md
        bag_path, count = self.path("long.bag"), 6250
        message = ProbeArray(names=["P%d" % k for k in range(8)], positions=[Point()] * 8)
        with rosbag.Bag(bag_path, "w") as bag:
            for n in range(count):
                message.pressures = (math.pi * (n + numpy.arange(8))).tolist()
                bag.write("/wavetank/probes", stamped(message, n), rospy.Time.from_sec(0.001 * (n + 1)))
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        self.assertEqual(self.run_export(bag_path, "--csv", self.path("long")).returncode, 0)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        self.assertLess(after.ru_utime - before.ru_utime, 2.5)
        self.assertLess(after.ru_maxrss, 300 * 1024)

    def test_what_is_wrong_is_one_sentence(self):
        for arguments, sentence in (
            ([self.bag, "--vtk", "x"], "holds no water, neither a surface nor point clouds: write it with wavetank_run --surface, --particles or --clouds"),
            (["/no/such.bag", "--csv", "x"], "export: there is no bag '/no/such.bag'"),
            ([self.bag, "--csv", self.bag], "export: cannot write '%s': File exists" % self.bag),
            ([self.bag, "--csv", "x", "--instrument", "thermometer"], "holds no thermometer under /wavetank, only probes, gauges"),
        ):
            done = self.run_export(*arguments)
            self.assertEqual(done.returncode, 2)
            self.assertEqual(len(done.stderr.splitlines()), 1, done.stderr)
            self.assertIn(sentence, done.stderr)


if __name__ == "__main__":
    unittest.main()
