"""Makes small bags of water, a tank and a body that turns, whose every place is known."""

import math

import numpy
import rosbag
import rospy
from geometry_msgs.msg import Point
from nav_msgs.msg import Odometry
from sensor_msgs.msg import PointCloud2, PointField
from std_msgs.msg import String
from visualization_msgs.msg import Marker, MarkerArray
from wavetank.msg import ProbeArray, WaveGaugeArray

CASE = """# made here
title: made here
dimensions: 3
gravity: [0, 0, -9.81]
fluid: {spacing: 0.1}
bodies: [{name: hull}]
instruments: {pressure_probes: [{name: P1, position: [0, 0, 0], body: hull}, {name: P2, position: [0.5, 0, 0]}]}
"""
FIELDS = "x y z vx vy vz pressure".split()
ORIGIN = numpy.array([0.5, 0.5, 0.5])  # of the hull, where the case has it
TIMES = (50, 150)  # ms, of the water


def stamped(message, milliseconds, frame="tank"):
    message.header.stamp = rospy.Time(milliseconds // 1000, milliseconds % 1000 * 1000000)
    message.header.frame_id = frame
    return message


def box(low, high):
    """Corners of twelve triangles, m."""
    quads = []
    for axis in range(3):
        for side in (low, high):
            corners = []
            for u, v in ((0, 0), (1, 0), (1, 1), (0, 1)):
                corner = numpy.zeros(3)
                corner[axis] = side[axis]
                corner[(axis + 1) % 3] = (low, high)[u][(axis + 1) % 3]
                corner[(axis + 2) % 3] = (low, high)[v][(axis + 2) % 3]
                corners.append(corner)
            quads += [corners[k] for k in (0, 1, 2, 0, 2, 3)]
    return numpy.array(quads)


def points_of(rows):
    return [Point(*row) for row in rows.tolist()]


def particles():
    """A block of water: rows of FIELDS."""
    places = numpy.array([(x, y, z) for x in range(10) for y in range(10) for z in range(4)]) * 0.1 + 0.05
    return numpy.column_stack([places, 0.5 * places, 9810 * (0.4 - places[:, 2])]).astype("<f4")


def cloud_of(rows):
    fields = [PointField(name, 4 * n, PointField.FLOAT32, 1) for n, name in enumerate(FIELDS)]
    return PointCloud2(height=1, width=len(rows), point_step=4 * len(FIELDS), fields=fields, data=rows.tobytes())


def markers():
    tank = Marker(ns="tank", type=Marker.TRIANGLE_LIST, points=points_of(box(numpy.zeros(3), numpy.array([1.0, 1.0, 1.0]))[:-6]))  # open at the top
    hull = Marker(ns="bodies", id=0, type=Marker.TRIANGLE_LIST, points=points_of(box(ORIGIN - 0.1, ORIGIN + 0.1)))
    tank.header.frame_id, hull.header.frame_id = "tank", "tank/bodies/hull"
    tank.pose.orientation.w = hull.pose.orientation.w = 1.0
    hull.pose.position = Point(*(-ORIGIN).tolist())  # from the body's frame to its mesh
    probes = [Marker(ns="probes", id=n, type=Marker.SPHERE) for n in range(2)]
    probes[0].header.frame_id, probes[1].header.frame_id = hull.header.frame_id, "tank"
    probes[0].pose.position, probes[1].pose.position = Point(0.1, 0, 0), Point(0.5, 0, 0)
    for probe in probes:
        probe.pose.orientation.w = 1.0
    return MarkerArray([tank, hull] + probes)


def hull_at(milliseconds):
    """(position, angle about y): it rises and turns."""
    return ORIGIN + [0.0, 0.0, 1.5e-3 * milliseconds], math.pi / 2 * milliseconds / 150


def surface_markers(milliseconds):
    """A sheet over the tank, and a drop of spray."""
    grid = [(0.1 * n, 0.1 * k) for n in range(10) for k in range(10)]
    corners = [(x + u, y + v, 0.45 + 0.1 * math.sin(6 * (x + u))) for x, y in grid for u, v in ((0, 0), (0.1, 0), (0.1, 0.1), (0, 0), (0.1, 0.1), (0, 0.1))]
    for name, kind, rows in (("surface", Marker.TRIANGLE_LIST, corners), ("spray", Marker.POINTS, [(0.5, 0.5, 0.9)])):
        marker = stamped(Marker(ns=name, type=kind, points=[Point(*row) for row in rows]), milliseconds)
        marker.pose.orientation.w = 1.0
        yield marker


def mooring_markers(milliseconds):
    """A line from the tank's lower corner, that swings over the water from one side to the other."""
    line = stamped(Marker(ns="moorings", type=Marker.LINE_STRIP), milliseconds)
    line.points = points_of(numpy.array([[0.0, 0.0, 0.5], [0.5 if milliseconds < 100 else -0.3, 0.0, 0.9], [1.0, 0.0, 0.5]]))
    line.pose.orientation.w = 1.0
    return MarkerArray([line])


def write_bag(path, clouds=True, surface=False, case=CASE, odometry=True, moorings=False):
    with rosbag.Bag(path, "w") as bag:
        bag.write("/wavetank/case", String(case), rospy.Time(0, 1))
        bag.write("/wavetank/markers", markers(), rospy.Time(0, 1))
        for n in range(5):
            position, angle = hull_at(50 * n)
            pose = stamped(Odometry(), 50 * n)
            pose.pose.pose.position = Point(*position.tolist())
            pose.pose.pose.orientation.y, pose.pose.pose.orientation.w = math.sin(angle / 2), math.cos(angle / 2)
            at = rospy.Time.from_sec(1 + n)
            if odometry:
                bag.write("/wavetank/bodies/hull/odom", pose, at)
            probes = ProbeArray(names=["P1", "P2"], pressures=[100.0 * n, 7.0], positions=[Point(*(ORIGIN + [0.1, 0, 0])), Point(0.5, 0, 0)])
            bag.write("/wavetank/probes", stamped(probes, 50 * n), at)
            bag.write("/wavetank/gauges", stamped(WaveGaugeArray(names=["G"], levels=[0.4 + 0.01 * n], positions=[Point(0.2, 0.3, 0)]), 50 * n), at)
        for n, time in enumerate(TIMES):
            at = rospy.Time.from_sec(1 + n)
            if moorings:
                bag.write("/wavetank/markers", mooring_markers(time), at)
            if clouds:
                bag.write("/wavetank/free_surface", stamped(cloud_of(particles()[: 400 - n]), time), at)
            if surface:
                for marker in surface_markers(time):
                    bag.write("/wavetank/surface_mesh", marker, at)
