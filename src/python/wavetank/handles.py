"""Handles in rviz on the bodies of a running tank: interactive markers that pull free bodies, drive commanded ones, and pause, step and reset the run."""

import argparse
import math
import threading
import time

import numpy
import rosgraph
import rospy
from geometry_msgs.msg import InertiaStamped, Pose, Twist, WrenchStamped
from interactive_markers.interactive_marker_server import InteractiveMarkerServer
from interactive_markers.menu_handler import MenuHandler
from nav_msgs.msg import Odometry
from std_msgs.msg import String
from std_srvs.srv import SetBool, Trigger
from tf2_msgs.msg import TFMessage
from visualization_msgs.msg import InteractiveMarker, InteractiveMarkerControl, InteractiveMarkerFeedback, Marker, MarkerArray

from wavetank import Failure
from wavetank.names import level_of
from wavetank.runs import read_yaml

QUICKNESS = 4.0  # rad/s, of the spring: a body is at its handle within a second or so
WATER_TOO = 2.0  # times the body's mass, which the spring is damped for: a body afloat takes about as much water with it
SHARE_OF_WEIGHT = 0.5  # greatest pull
SPEED, TURN = 1.0, 2.0  # m/s and rad/s, of commanded bodies that the case sets no limits
APPROACH = 2.0  # 1/s, at which a commanded body comes up to its handle
SILENCE = 2.0  # s of wall time without a word from rviz, which speaks four times a second while it drags, after which a handle is let go
PATIENCE = 3.0  # s of wall time between warnings of what is waited for
FOLLOWING = 0.05  # s of wall time, between which handles that are free follow their bodies
PARTS = {"x": (1.0, 0.0, 0.0), "y": (0.0, 0.0, 1.0), "z": (0.0, 1.0, 0.0)}  # what turns the x axis of a control to an axis, beside w = 1


def vector_of(message):
    return numpy.array([message.x, message.y, message.z])


def quaternion_of(message):
    return numpy.array([message.x, message.y, message.z, message.w])


def rotated(quaternion, vector):
    axis, w = quaternion[:3], quaternion[3]
    return vector + 2.0 * numpy.cross(axis, numpy.cross(axis, vector) + w * vector)


def conjugate(quaternion):
    return quaternion * numpy.array([-1.0, -1.0, -1.0, 1.0])


def turn_between(first, last):
    """The rotation vector (rad) that takes one orientation to another, by the shorter way."""
    a, b = conjugate(first), last
    product = numpy.append(b[3] * a[:3] + a[3] * b[:3] + numpy.cross(b[:3], a[:3]), b[3] * a[3] - b[:3] @ a[:3])
    product = product if product[3] >= 0 else -product
    length = numpy.linalg.norm(product[:3])
    return product[:3] * (2.0 * numpy.arctan2(length, product[3]) / length) if length > 1e-12 else 2.0 * product[:3]


def limited(vector, greatest):
    length = numpy.linalg.norm(vector)
    return vector if length <= greatest else vector * (greatest / length)


class Body:
    """How a body is, as odometry tells it: all in the tank's axes."""

    def __init__(self, odometry):
        self.frame = odometry.header.frame_id
        self.pose = odometry.pose.pose
        self.position = vector_of(self.pose.position)
        self.orientation = quaternion_of(self.pose.orientation)
        self.velocity = rotated(self.orientation, vector_of(odometry.twist.twist.linear))
        self.angular_velocity = rotated(self.orientation, vector_of(odometry.twist.twist.angular))


class Spring:
    """Between a free body and its handle, critically damped for a body that moves as much water as it weighs."""

    def __init__(self, inertia, gravity, greatest_force=None):
        self.mass = inertia.m
        self.inertia = numpy.array([[inertia.ixx, inertia.ixy, inertia.ixz], [inertia.ixy, inertia.iyy, inertia.iyz], [inertia.ixz, inertia.iyz, inertia.izz]])
        self.greatest_force = greatest_force if greatest_force is not None else SHARE_OF_WEIGHT * self.mass * (gravity or 9.81)
        self.greatest_torque = self.greatest_force * float(numpy.sqrt(numpy.max(numpy.diag(self.inertia)) / self.mass))

    def force(self, body, handle):
        acceleration = QUICKNESS**2 * (vector_of(handle.position) - body.position) - 2.0 * QUICKNESS * body.velocity
        return limited(WATER_TOO * self.mass * acceleration, self.greatest_force)

    def torque(self, body, handle):
        turn = turn_between(body.orientation, quaternion_of(handle.orientation))
        acceleration = QUICKNESS**2 * turn - 2.0 * QUICKNESS * body.angular_velocity
        back = conjugate(body.orientation)
        return limited(rotated(body.orientation, WATER_TOO * self.inertia @ rotated(back, acceleration)), self.greatest_torque)


class Puller:
    """Sends what a handle does to a free body."""

    def __init__(self, topic, spring):
        self.spring = spring
        self.publisher = rospy.Publisher(topic + "/external_wrench", WrenchStamped, queue_size=1, tcp_nodelay=True)

    def send(self, body, handle, turns):
        message = WrenchStamped()
        message.header.frame_id = body.frame
        if handle is not None and turns:
            message.wrench.torque.x, message.wrench.torque.y, message.wrench.torque.z = self.spring.torque(body, handle)
        elif handle is not None:
            message.wrench.force.x, message.wrench.force.y, message.wrench.force.z = self.spring.force(body, handle)
        self.publisher.publish(message)


def limit_of(value, otherwise):
    """Of a case, which has a word where there is no limit."""
    return float(value) if isinstance(value, (int, float)) else otherwise


class Driver:
    """The same of a commanded body, which comes up to its handle at a speed that is the less the nearer it is."""

    def __init__(self, topic, limits):
        self.speed = limit_of(limits.get("greatest_speed"), SPEED)
        self.turn = limit_of(limits.get("greatest_angular_speed"), TURN)
        self.publisher = rospy.Publisher(topic + "/cmd_vel", Twist, queue_size=1, tcp_nodelay=True)

    def send(self, body, handle, turns):
        message = Twist()
        back = conjugate(body.orientation)
        if handle is not None and turns:
            turn = limited(APPROACH * turn_between(body.orientation, quaternion_of(handle.orientation)), self.turn)
            message.angular.x, message.angular.y, message.angular.z = rotated(back, turn)
        elif handle is not None:
            velocity = limited(APPROACH * (vector_of(handle.position) - body.position), self.speed)
            message.linear.x, message.linear.y, message.linear.z = rotated(back, velocity)
        self.publisher.publish(message)


class Handle:
    """A body's interactive marker: with the body until it is held, then what the body is drawn to. Nothing is sent of one that nobody holds."""

    def __init__(self, server, menu, name, topic, frame, sender, size, plane):
        self.server, self.name, self.frame, self.sender, self.size, self.plane = server, name, frame, sender, size, plane
        self.lock = threading.RLock()
        self.body = None  # none has been heard of yet
        self.held_at = None  # a pose; none: nobody holds it
        self.turns = False
        self.heard = 0.0  # s of wall time
        self.menu = menu
        self.subscriber = rospy.Subscriber(topic + "/odom", Odometry, self.hear, queue_size=1, tcp_nodelay=True)

    def hear(self, odometry, only_first=False):
        with self.lock:
            begins = self.body is None
            if only_first and not begins:
                return
            self.body = Body(odometry)
            if self.held_at is not None:
                self.sender.send(self.body, self.held_at, self.turns)
        if begins:  # without the lock: the server calls feel() under its own
            self.server.insert(self.marker(), self.feel)
            self.menu.apply(self.server, self.name)
            self.server.applyChanges()

    def find(self, transforms):
        """Its first pose, of a tank that stands: late listeners get the last transforms, but no odometry, which goes on from there."""
        for transform in transforms.transforms:
            if transform.child_frame_id != self.frame:
                continue
            odometry = Odometry(header=transform.header, child_frame_id=self.frame)
            odometry.pose.pose = Pose(transform.transform.translation, transform.transform.rotation)
            self.hear(odometry, only_first=True)

    def feel(self, feedback):
        with self.lock:
            self.heard = time.monotonic()
            if feedback.event_type == InteractiveMarkerFeedback.MOUSE_UP:
                self.let_go()
            elif feedback.event_type in (InteractiveMarkerFeedback.MOUSE_DOWN, InteractiveMarkerFeedback.POSE_UPDATE):
                if feedback.header.frame_id not in ("", self.body.frame):
                    rospy.logwarn_throttle(1.0, "a handle's pose in frame '%s' is ignored: it must be in '%s'" % (feedback.header.frame_id, self.body.frame))
                    return
                self.held_at = feedback.pose
                self.turns = feedback.control_name.startswith("turn")
                self.sender.send(self.body, self.held_at, self.turns)

    def let_go(self):
        if self.held_at is None:
            return
        self.held_at = None
        self.sender.send(self.body, None, False)

    def end(self):
        """Once its case is another's."""
        self.subscriber.unregister()
        with self.lock:
            self.let_go()
            self.sender.publisher.unregister()

    def follow(self):
        with self.lock:
            if self.body is None:
                return
            if self.held_at is not None and time.monotonic() - self.heard > SILENCE:
                self.let_go()
            pose = self.body.pose if self.held_at is None else None
        if pose is not None:
            self.server.setPose(self.name, pose)

    def marker(self):
        marker = InteractiveMarker()
        marker.header.frame_id = self.body.frame
        marker.name, marker.description = self.name, ""
        marker.scale, marker.pose = self.size, self.body.pose
        for axis in "xz" if self.plane else "xyz":
            marker.controls.append(control("move_" + axis, InteractiveMarkerControl.MOVE_AXIS, axis))
        if self.plane:
            marker.controls.append(control("move_plane", InteractiveMarkerControl.MOVE_PLANE, "y"))
        for axis in "y" if self.plane else "xyz":
            marker.controls.append(control("turn_" + axis, InteractiveMarkerControl.ROTATE_AXIS, axis))
        return marker


def control(name, mode, axis):
    result = InteractiveMarkerControl(name=name, interaction_mode=mode)
    turn = numpy.array(PARTS[axis] + (1.0,))
    result.orientation.x, result.orientation.y, result.orientation.z, result.orientation.w = turn / numpy.linalg.norm(turn)
    return result


class Menu:
    """Pause, step and reset: on every handle, and on a small cube over a corner of the tank."""

    def __init__(self, server, tank):
        self.handler = MenuHandler()
        for title, service, kind, arguments in (
            ("Pause", "pause", SetBool, [True]),
            ("Go on", "pause", SetBool, [False]),
            ("Step", "step", Trigger, []),
            ("Reset", "reset", Trigger, []),
        ):
            self.handler.insert(title, callback=self.caller(rospy.ServiceProxy(tank + "/" + service, kind), arguments))
        self.server = server

    @staticmethod
    def caller(service, arguments):
        def call(_):
            try:
                answer = service(*arguments)
                (rospy.loginfo if answer.success else rospy.logwarn)(answer.message)
            except rospy.ServiceException as error:
                rospy.logwarn("%s: %s" % (service.resolved_name, error))

        return call

    def apply(self, server, name):
        self.handler.apply(server, name)

    def put_over(self, frame, places):
        low, high = numpy.min(places, axis=0), numpy.max(places, axis=0)
        size = 0.03 * float(numpy.linalg.norm(high - low))
        cube = Marker(type=Marker.CUBE)
        cube.scale.x = cube.scale.y = cube.scale.z = size
        cube.color.r, cube.color.g, cube.color.b, cube.color.a = 0.3, 0.6, 0.9, 1.0
        marker = InteractiveMarker(name="run", description="run", scale=3.0 * size)
        marker.header.frame_id = frame
        marker.pose = Pose()
        marker.pose.position.x, marker.pose.position.y = low[0], low[1]  # at a corner, where it is in nobody's way
        marker.pose.position.z = high[2] + 2.0 * size
        marker.pose.orientation.w = 1.0
        marker.controls.append(InteractiveMarkerControl(name="menu", interaction_mode=InteractiveMarkerControl.MENU, always_visible=True, markers=[cube]))
        self.server.insert(marker, lambda feedback: None)  # the menu has callbacks of its own
        self.apply(self.server, "run")


def edges_of(drawing, group, number):
    """The ends of a body's or the tank's edges, m, and the frame that they are in."""
    for marker in drawing.markers:
        if marker.ns == group and marker.id == number and marker.points:
            return numpy.array([[point.x, point.y, point.z] for point in marker.points]), marker.header.frame_id
    return numpy.array([[0.0, 0.0, 0.0], [0.5, 0.5, 0.5]]), ""


def wait_for(topic, kind):
    """A topic's first message, and a word now and then while there is none."""
    while True:
        try:
            return rospy.wait_for_message(topic, kind, PATIENCE)
        except rospy.ROSInterruptException:
            raise
        except rospy.ROSException:
            rospy.logwarn("nothing is heard on %s yet: is a tank of that name (--tank) running?" % topic)


def put_handles(server, tank, case, greatest_force):
    """On all bodies that can be moved from outside."""
    drawing = wait_for(tank + "/markers", MarkerArray)
    menu = Menu(server, tank)
    places, frame = edges_of(drawing, "tank edges", 0)
    menu.put_over(frame or case.get("world_frame", "tank"), places)
    gravity = float(numpy.linalg.norm(case["gravity"]))
    handles = []
    for number, body in enumerate(case.get("bodies") or []):
        topic = "%s/bodies/%s" % (tank, level_of(body["name"]))
        if body["motion"] == "free":
            inertia = wait_for(topic + "/inertia", InertiaStamped).inertia
            sender = Puller(topic, Spring(inertia, gravity, greatest_force))
        elif body["motion"] == "commanded":
            sender = Driver(topic, body.get("command") or {})
        else:
            continue
        places, _ = edges_of(drawing, "body edges", number)
        size = float(numpy.linalg.norm(numpy.ptp(places, axis=0)))
        body_frame = "%s/bodies/%s" % (case.get("world_frame", "tank"), level_of(body["name"]))
        handles.append(Handle(server, menu, "bodies/" + body["name"], topic, body_frame, sender, size, case["dimensions"] == 2))
    server.applyChanges()
    return handles


class Handles:
    """Those of the tank's newest case: a node that is started again may have another."""

    def __init__(self, tank, greatest_force):
        self.server = InteractiveMarkerServer(tank + "/handles")
        self.tank, self.greatest_force = tank, greatest_force
        self.case = self.newest = wait_for(tank + "/case", String).data
        self.handles = put_handles(self.server, tank, read_yaml(self.case), greatest_force)
        rospy.Subscriber(tank + "/case", String, self.hear, queue_size=1)
        self.look_for_poses()

    def hear(self, case):
        self.newest = case.data

    def look_for_poses(self):
        """With a connection of its own, which the last transforms are sent to."""
        handles = self.handles
        self.transforms = rospy.Subscriber("/tf", TFMessage, lambda transforms: [handle.find(transforms) for handle in handles], queue_size=100)

    def follow(self):
        if self.newest != self.case:
            self.begin_again()
        for handle in self.handles:
            handle.follow()
        self.server.applyChanges()

    def begin_again(self):
        self.case = self.newest
        self.transforms.unregister()
        for handle in self.handles:
            handle.end()
        self.server.clear()
        self.server.applyChanges()
        self.handles = put_handles(self.server, self.tank, read_yaml(self.case), self.greatest_force)
        self.look_for_poses()


def main(arguments):
    parser = argparse.ArgumentParser(prog="handles", description=__doc__)
    parser.add_argument("--tank", default="/wavetank", help="namespace of the wave tank's node (default /wavetank)")
    parser.add_argument("--force", type=float, help="greatest force on a free body, N (2-D: N/m); half of its weight unless set")
    options = parser.parse_args(arguments)
    if options.force is not None and not (math.isfinite(options.force) and options.force > 0):
        raise Failure("--force must be a finite number of newtons greater than 0, not %g" % options.force)
    if not rosgraph.is_master_online():
        raise Failure("there is no ROS master; start a tank first, as in: roslaunch wavetank floating_box.launch rviz:=true handles:=true")
    # By the clock on the wall: the server of the markers takes a hand's word only a second after another's, and the simulated time may stand still.
    rospy.init_node("handles", anonymous=True, disable_rostime=True)
    try:
        handles = Handles(options.tank.rstrip("/"), options.force)
        while not rospy.is_shutdown():  # by the clock on the wall: the simulated one may stand still
            handles.follow()
            time.sleep(FOLLOWING)
    except rospy.ROSInterruptException:
        pass
