#!/usr/bin/env python3
"""Runs config/water_entry.yaml in a node of its own and looks at every particle again and again: watch_particles.py CSV [KEY=VALUE]...

Writes for each look the time (s), the number of particles, how deep the deepest of them is inside the ball (m; negative: none is), and the density
(kg/m³) farthest from that at rest with the place (m) of that particle from the ball's centre and its Shepard factor. Starts a ROS master
on a free port, and stops what it started.
"""

import csv
import os
import re
import socket
import subprocess
import sys
import tempfile
import threading
import time

import numpy
import yaml

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import compare_motion as compare  # noqa: E402

PACKAGE = os.path.realpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))
CASE = os.path.join(PACKAGE, "config", "water_entry.yaml")
NODE = os.path.join(PACKAGE, "devel", "lib", "wavetank", "wavetank_node")
FIELDS = ["x", "y", "z", "density", "shepard"]
REST = 1000.0  # kg/m³, the density of the case


def free_port():
    with socket.socket() as chosen:
        chosen.bind(("127.0.0.1", 0))
        return chosen.getsockname()[1]


class Watch:
    """Collects the ball's poses and the clouds. A cloud's look is taken at the end, when the poses around it are known."""

    def __init__(self, mesh):
        self.mesh = mesh
        self.poses, self.looks, self.pending = [], [], []
        self.lock = threading.Lock()

    def pose(self, message):
        at, turned = message.pose.pose.position, message.pose.pose.orientation
        with self.lock:
            self.poses.append((message.header.stamp.to_sec(), at.x, at.y, at.z, turned.x, turned.y, turned.z, turned.w))

    def cloud(self, message):
        offsets = {field.name: field.offset for field in message.fields}
        kind = numpy.dtype({"names": FIELDS, "formats": ["<f4"] * 5, "offsets": [offsets[name] for name in FIELDS], "itemsize": message.point_step})
        points = numpy.frombuffer(message.data, dtype=kind)
        with self.lock:
            self.pending.append((message.header.stamp.to_sec(), numpy.stack([points[name] for name in FIELDS], axis=1).astype(float)))
        self.look()

    def look(self):
        with self.lock:
            poses = numpy.array(self.poses).reshape(-1, 8)
            if not len(poses):
                return
            known = [cloud for cloud in self.pending if cloud[0] <= poses[-1, 0]]
            self.pending = [cloud for cloud in self.pending if cloud[0] > poses[-1, 0]]
        for when, points in known:
            pose = numpy.array([numpy.interp(when, poses[:, 0], poses[:, column]) for column in range(1, 8)])
            back = numpy.append(-pose[3:6], pose[6]) / numpy.linalg.norm(pose[3:])
            inside = compare.depth_inside(self.mesh, compare.rotated(back, points[:, :3] - pose[:3]))
            oddest = points[numpy.argmax(numpy.abs(points[:, 3] - REST))]
            self.looks.append((when, len(points), float(inside.max()), oddest[3], *(oddest[:3] - pose[:3]), oddest[4]))


def parameters(overrides):
    given = ["_case_file:=" + CASE, "_publish_clock:=false", "_max_points:=1000000", "_rates/cloud:=50", "_exit_at_end:=true", "_wait_for_subscribers:=20"]
    return given + ["_%s" % override.replace("=", ":=", 1) for override in overrides]


def run(mesh, overrides, environment):
    import rospy
    from nav_msgs.msg import Odometry
    from sensor_msgs.msg import PointCloud2

    watch = Watch(mesh)
    rospy.init_node("watch_particles", anonymous=True, disable_signals=True)
    rospy.Subscriber("/wavetank/bodies/ball/odom", Odometry, watch.pose, queue_size=1000)
    rospy.Subscriber("/wavetank/particles", PointCloud2, watch.cloud, queue_size=4, buff_size=1 << 24)
    rospy.Subscriber("/wavetank/probes", rospy.AnyMsg, lambda message: None)  # the node waits for a listener
    rospy.Subscriber("/wavetank/gauges", rospy.AnyMsg, lambda message: None)
    node = subprocess.Popen([NODE, "__name:=wavetank"] + parameters(overrides), env=environment)
    try:
        code = node.wait()
    finally:
        if node.poll() is None:
            node.terminate()
    time.sleep(1.0)  # for what is still on its way
    watch.look()
    rospy.signal_shutdown("done")
    return code, watch.looks


def main(arguments):
    if not arguments or not all(re.fullmatch(r"[\w/]+=\S+", override) for override in arguments[1:]):
        print(__doc__, file=sys.stderr)
        return 2
    with open(CASE) as file:
        mesh = compare.read_mesh(yaml.safe_load(file)["bodies"][0])
    port = free_port()
    os.environ.update(ROS_MASTER_URI="http://localhost:%d" % port, ROS_HOSTNAME="localhost")
    with tempfile.TemporaryDirectory() as home:
        os.environ["ROS_HOME"] = home
        # ROS's programs start "env python3": the interpreter that has ROS first.
        environment = dict(os.environ, PATH="/usr/bin:" + os.environ.get("PATH", ""))
        master = subprocess.Popen(["rosmaster", "--core", "-p", str(port)], env=environment, stdout=subprocess.DEVNULL)
        try:
            time.sleep(3.0)
            code, looks = run(mesh, arguments[1:], environment)
        finally:
            master.terminate()
            master.wait()
    with open(arguments[0], "w", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(["time", "particles", "deepest", "density", "x", "y", "z", "shepard"])
        writer.writerows(looks)
    print("%d looks at %d particles" % (len(looks), looks[-1][1] if looks else 0))
    return code


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
