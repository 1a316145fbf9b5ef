"""A tank that runs as the page's source: topics are taken as the bytes that come, and turned into numbers by the reader of bags, many at a time."""

import http.client
import threading
import time
import xml.parsers.expat
import xmlrpc.client
from collections import deque

import numpy
import rospy
from geometry_msgs.msg import WrenchStamped
from std_srvs.srv import SetBool, Trigger

from wavetank.message_decoding import decode, read_definition, read_tree
from wavetank.recording import cloud_of, matching, stamp_of
from wavetank.scenery import CLOUDS, SURFACE
from wavetank.web.drawing import Drawing, pose_numbers
from wavetank.web.packets import cloud_packet, spray_packet, surface_packet
from wavetank.web.replay import is_plotted, read_case, stamp_of_header
from wavetank.web.requests import LIVE, Refused
from wavetank.web.series import Series

HISTORY = 4096  # samples of an instrument that a new client gets
WAITING = 20000  # messages of a topic between two looks at them
CLOUD_ROOM = 64 * 1024 * 1024  # bytes that are read at once, so that what waits is one cloud and no more
STATUS = ("title", "device", "phase", "paused", "start_progress", "failure", "time", "duration", "step", "time_step", "particles")
RATES = ("real_time_factor", "steps_per_second", "greatest_speed")


class Instrument:
    """A topic with samples: what came and was not yet looked at, and the samples before."""

    def __init__(self, name, columns_of):
        self.name, self._columns_of = name, columns_of
        self.came = deque(maxlen=WAITING)
        self.table, self.history, self._start = None, None, 0.0

    def forget(self):
        self.came.clear()
        self.table, self.history = None, None

    def begin(self, start):
        """Another run has begun, whose time 0 is this ROS time (s): what is before it is of the run before. Its samples, as read() has them, or None."""
        before, self._start = self.history, start
        if before is None:
            return None
        self.history = Series(len(self.table["columns"]), HISTORY)
        of_run = before.times >= start
        self.history.add(before.times[of_run], before.values[of_run])
        return (*self.told(), True)

    def told(self):
        """(times, values) of the history: simulated time, s."""
        return self.history.times - self._start, self.history.values

    def read(self):
        """(times, values, clear) of what has come since, with the history brought up to it; clear: the history before is of another run. None without any."""
        came = [self.came.popleft() for _ in range(len(self.came))]
        decoded = self._decoded(came) if came else None
        if decoded is None:
            return None
        times, values = decoded
        clear = self.history is None or bool(len(self.history) and times[0] < self.history.times[-1])
        if clear:
            self.history = Series(len(self.table["columns"]), HISTORY)
        self.history.add(times, values)
        return times - self._start, values, clear

    def _decoded(self, came):
        """None where nothing is measured: a table without columns."""
        (kind, types), pieces = came[-1][0], []
        by_length = {}
        for _, data in came:
            by_length.setdefault(len(data), []).append(data)
        for rows in by_length.values():
            rows = numpy.frombuffer(b"".join(rows), numpy.uint8).reshape(len(rows), -1)
            for numbers, texts, _ in decode(types, kind, rows):
                columns, _ = self._columns_of(numbers, texts)
                if columns:
                    pieces.append((stamp_of(numbers) / 1e9, columns))
        if not pieces:
            return None
        table = {"name": self.name, "columns": list(pieces[-1][1]), "units": [unit for _, unit in pieces[-1][1].values()]}
        if table != self.table:
            self.table, self.history = table, None
        pieces = [(times, columns) for times, columns in pieces if list(columns) == table["columns"]]
        times = numpy.concatenate([times for times, _ in pieces])
        values = numpy.concatenate([numpy.column_stack([column for column, _ in columns.values()]) for _, columns in pieces])
        order = numpy.argsort(times, kind="stable")
        return times[order], values[order]


class Live:
    """tank: the node's name. publish: called from any thread with (kind, packet) of a picture, packet being a dictionary where it is no binary one."""

    requests, mode = LIVE, "live"

    def __init__(self, tank, publish):
        self.tank = "/" + tank.strip("/")
        self._publish = publish
        self._types, self._lock = {}, threading.Lock()
        self._unread = set()  # names of topics of which that was told
        self._drawing, self._case = Drawing(), read_case(None)
        self._text, self._run = None, 0  # of the case, and how many times it has been another one
        self._instruments, self._subscribers, self._pushes = {}, {}, {}
        self._poses_came, self._poses = {}, {}
        self._has_surface, self._master = False, True
        self._cloud_stamps, self._status_came = {}, None
        self._start, self._start_told = 0.0, 0.0  # ROS time of simulated time 0, s: as samples are told, and as the tank said last
        self._subscribe("markers", self._drawn)
        self._subscribe("case", self._case_came)
        self._subscribe("status", self._status)

    def _subscribe(self, name, hear, **more):
        def hear_safely(message, *arguments):
            try:
                hear(message, *arguments)
            except Exception as error:  # whatever a publisher of that name may send
                self._leave_out(name, error)

        self._subscribers[name] = rospy.Subscriber(self.tank + "/" + name, rospy.AnyMsg, hear_safely, **more)

    def _leave_out(self, name, error):
        """Tells once that what a topic sends cannot be read."""
        if name not in self._unread:
            self._unread.add(name)
            rospy.logwarn("%s/%s sends what cannot be read, which is left out: %s: %s", self.tank, name, type(error).__name__, error)

    def stop(self):
        for subscriber in list(self._subscribers.values()):
            subscriber.unregister()

    # ---------------------------------------------------------------- from threads of rospy

    def _definition(self, message):
        header = message._connection_header
        key = (header["type"], header["md5sum"])
        if key not in self._types:
            self._types[key] = (header["type"], read_definition(header["type"], header["message_definition"]))
        return self._types[key]

    def _tree(self, message):
        kind, types = self._definition(message)
        return read_tree(types, kind, message._buff)

    def _drawn(self, message):
        with self._lock:
            kind = self._drawing.follow(self._tree(message))
            packet = self._drawing.packet(kind)
        self._publish(kind, packet)

    def _case_came(self, message):
        text = self._tree(message)["data"]
        if self._text not in (None, text):
            self._run += 1
        self._text, self._case = text, read_case(text)
        for body in self._case["free"]:
            if body not in self._pushes:
                self._pushes[body] = rospy.Publisher("%s/bodies/%s/external_wrench" % (self.tank, body), WrenchStamped, queue_size=1)
        self._publish("hello", self.hello())

    def _status(self, message):
        self._status_came = time.monotonic()
        status = self._tree(message)
        # a reset sets the simulation's time back, while stamps go on from a whole second
        self._start_told = float(round(stamp_of_header(status) / 1e9 - float(status["time"])))
        told = {name: plain(status[name]) for name in STATUS + RATES if name in status}
        self._publish("status", dict(told, kind="status", stamp=stamp_of_header(status) / 1e9))

    def _cloud(self, message, name):
        cloud = self._tree(message)
        stamp = stamp_of_header(cloud)
        seen = (stamp, len(cloud["data"]))
        if self._cloud_stamps.get(name) == seen:
            return  # a paused tank sends the same again and again
        self._cloud_stamps[name] = seen
        self._publish(name, cloud_packet(name, stamp, cloud_of(cloud)))

    def _surface(self, message):
        marker = self._tree(message)
        packet = {"surface": surface_packet, "spray": spray_packet}.get(marker["ns"])
        if packet:
            self._publish(marker["ns"], packet(marker, stamp_of_header(marker)))

    def _pose(self, message, body):
        self._poses_came[body] = message  # read when it is sent: most are not

    # ---------------------------------------------------------------- from the server

    @property
    def waters(self):
        return list(CLOUDS) + (["surface"] if self._has_surface else [])

    def known(self):
        return {"waters": self.waters, "bodies": list(self._case["free"])}

    def hello(self):
        return {
            "kind": "hello",
            "run": self._run,
            "mode": self.mode,
            "source": self.tank,
            "tank": self.tank,
            "title": self._case["title"],
            "dimensions": self._case["dimensions"],
            "spacing": self._case["spacing"],
            "waters": self.waters,
            "bodies": [{"name": name, "mass": mass} for name, mass in self._case["free"].items()],
            "times": [],
        }

    def greet(self, mailbox):
        for instrument in list(self._instruments.values()):
            if instrument.history is not None:
                mailbox.add(instrument.table, *instrument.told(), clear=True)

    def forget(self):
        """What came of another tank, whose samples and bodies are not this one's."""
        self._poses_came.clear()
        self._poses.clear()
        for instrument in list(self._instruments.values()):
            instrument.forget()

    def look_around(self):
        """Once a second: subscribes to what the tank has; tells what does not answer."""
        try:
            topics = rospy.get_published_topics()
            self._master = True
        except (OSError, rospy.ROSException, xmlrpc.client.Error, http.client.HTTPException, xml.parsers.expat.ExpatError):
            # there is no master, or something else in its place
            topics, self._master = [], False
        within = self.tank + "/"
        surface = any(topic == within + SURFACE for topic, _ in topics)
        for topic, kind in topics:
            match = matching(topic, kind) if topic.startswith(within) else None
            if match and match[0] == self.tank and match[1] not in self._subscribers:
                self._follow(match[1], kind, match[3])
        if surface != self._has_surface and self._master:
            self._has_surface = surface
            self._publish("hello", self.hello())
        silent = self._status_came is None or time.monotonic() - self._status_came > 4.0
        self._publish("silence", {"kind": "silence", "silent": silent, "master": self._master})

    def _follow(self, name, kind, columns_of):
        if name.endswith("/odom"):
            body = name.split("/")[1]
            self._subscribe(name, self._pose, callback_args=body, queue_size=1)
        elif is_plotted(name):
            instrument = Instrument(name, columns_of)
            instrument.begin(self._start)
            self._instruments[name] = instrument
            self._subscribe(name, lambda message: instrument.came.append((self._definition(message), message._buff)), tcp_nodelay=True)

    def show(self, wanted):
        """Listens to the clouds and the surface that any client wants to see, and to no other: the tank makes only those that someone listens to."""
        topics = {SURFACE if water == "surface" else water for water in wanted}
        for name in (*CLOUDS, SURFACE):
            if name in topics and name not in self._subscribers:
                if name == SURFACE:
                    self._subscribe(name, self._surface, queue_size=2, buff_size=CLOUD_ROOM)
                else:
                    self._subscribe(name, self._cloud, callback_args=name, queue_size=1, buff_size=CLOUD_ROOM)
            elif name not in topics and name in self._subscribers:
                self._subscribers.pop(name).unregister()
                self._cloud_stamps.pop(name, None)

    def samples(self):
        """(table, times, values, clear) of each instrument that has new ones, or whose run has begun again."""
        begins, self._start = self._start_told != self._start, self._start_told
        for instrument in list(self._instruments.values()):
            try:
                read = instrument.read()
            except Exception as error:  # the same
                self._leave_out(instrument.name, error)
                read = None
            if begins:
                read = instrument.begin(self._start)
            if read:
                yield (instrument.table, *read)

    def poses(self):
        """Of all bodies, if any has moved since: the packet, or None."""
        came = [(body, self._poses_came.pop(body)) for body in list(self._poses_came)]
        for body, message in came:
            try:
                pose = self._tree(message)["pose"]["pose"]
                numbers = pose_numbers([pose["position"][axis] for axis in "xyz"], [pose["orientation"][axis] for axis in "xyzw"])
            except Exception as error:  # the same
                self._leave_out("bodies/%s/odom" % body, error)
                continue
            if numbers:
                self._poses[body] = numbers
        return {"kind": "poses", "poses": dict(self._poses)} if came else None

    def call(self, request):
        """Does what a client asked for, and returns the answer's sentence; takes as long as the tank's step in progress. Raises Refused."""
        if request["do"] == "push":
            return self._push(request)
        proxy = rospy.ServiceProxy(self.tank + "/" + request["do"], SetBool if request["do"] == "pause" else Trigger)
        try:
            answer = proxy(request["value"]) if request["do"] == "pause" else proxy()
        except (OSError, rospy.ServiceException, rospy.ROSException) as error:
            raise Refused("%s does not answer: %s" % (self.tank, error))
        if not answer.success:
            raise Refused(answer.message or "%s refused" % self.tank)
        return answer.message

    def _push(self, request):
        publisher = self._pushes[request["body"]]
        if not publisher.get_num_connections():
            raise Refused("%s does not listen to pushes of %s" % (self.tank, request["body"]))
        message = WrenchStamped()
        message.header.frame_id = self._case["world_frame"]
        for part, values in (("force", request["force"]), ("torque", request["torque"])):
            vector = getattr(message.wrench, part)
            vector.x, vector.y, vector.z = values
        publisher.publish(message)
        return ""


def plain(value):
    return value if isinstance(value, (str, int)) else float(value) if numpy.isfinite(value) else None
