"""A bag as the page's source: each client asks for the pictures of the times that it shows."""

import bisect
import math
import os
import sys

import yaml

from wavetank import Failure
from wavetank.recording import CLOUD, Recording, cloud_of
from wavetank.scenery import CLOUDS, MARKER, MARKERS, SURFACE, Pose
from wavetank.web.drawing import Drawing, pose_numbers
from wavetank.web.packets import cloud_packet, spray_packet, surface_packet
from wavetank.web.requests import REPLAY
from wavetank.web.series import thinned

HIDDEN = ("/pressure", "/viscous", "/odom", "status", "joint_states")  # ends of names that have no plot
SHOWN_SAMPLES = 4096  # of an instrument


def is_plotted(name):
    return not name.endswith(HIDDEN)


def table_of(table):
    return {"name": table.name, "columns": list(table.columns), "units": [table.units[column] for column in table.columns]}


class Replay:
    """waters: which clouds, or "surface", the bag has. Raises Failure, also of a bag without any."""

    requests, mode = REPLAY, "replay"

    def __init__(self, path, namespace=None):
        self._recording = Recording(path, namespace)
        self._clouds = {name: self._recording.stream(name, CLOUD) for name in CLOUDS if self._recording.has_cloud(name)}
        self._surface, self._spray = self._split_surface()
        self.waters = list(self._clouds) + (["surface"] if self._surface else [])
        if not self.waters:
            raise Failure(
                "'%s' holds no water to show: write it with wavetank_run --clouds, --particles or --surface, or record:=true clouds:=true of a launch file"
                % path
            )
        self._case = read_case(self._recording.text("case"))
        odometry = [self._recording.table(name) for name in self._recording.names if name.endswith("/odom")]
        self._poses = {table.name.split("/")[1]: Pose(table) for table in odometry if len(table)}
        self._drawings, self._drawing = self._recording.stream("markers", MARKERS, header_at=4, take_recorded=True), Drawing()
        if len(self._drawings):
            self._drawing.follow(self._drawings.read(0))
        tables = (self._recording.table(name) for name in self._recording.names if is_plotted(name))
        self._tables = [(table, table.array(*table.columns)) for table in tables if len(table) and table.columns]

    def _split_surface(self):
        """Numbers of the messages that draw the surface, and those that draw the spray, with their times."""
        self._markers = self._recording.stream(SURFACE, MARKER)
        found = {"surface": [], "spray": []}
        for n, stamp in enumerate(self._markers.stamps.tolist()):
            found.get(self._markers.group(n), []).append((stamp, n))
        return found["surface"], found["spray"]

    def known(self):
        return {"waters": self.waters, "bodies": []}

    def hello(self):
        stamps = sorted({stamp for messages in self._clouds.values() for stamp in messages.stamps.tolist()} | {stamp for stamp, _ in self._surface})
        return {
            "kind": "hello",
            "run": 0,
            "mode": self.mode,
            "source": os.path.basename(self._recording.path),
            "tank": self._recording.namespace,
            "title": self._case["title"],
            "dimensions": self._case["dimensions"],
            "spacing": self._case["spacing"],
            "waters": self.waters,
            "bodies": [],
            "times": [stamp / 1e9 for stamp in stamps],
        }

    def greet(self, mailbox):
        """What a new client gets."""
        mailbox.put("drawing", self._drawing.packet())
        for table, values in self._tables:
            times = table.times
            while len(times) > SHOWN_SAMPLES:  # as fine at the beginning as at the end
                times, values = thinned(times, values)
            mailbox.add(table_of(table), times, values)

    def pictures(self, time, water):
        """Packets by kind of what the bag has last at a time (s), or first where that is later."""
        stamp = int(round(time * 1e9))
        pictures = self._surface_pictures(stamp) if water == "surface" else self._cloud_pictures(stamp, water)
        if len(self._drawings) > 1:
            pictures["lines"] = self._lines_at(stamp)
        return pictures

    def _lines_at(self, stamp):
        """Each message draws them all; before the first there are none."""
        self._drawing.forget_lines()
        lines = bisect.bisect_right(self._drawings.stamps, stamp) - 1
        if lines > 0:
            self._drawing.follow(self._drawings.read(lines))
        return self._drawing.packet("lines")

    def _cloud_pictures(self, stamp, water):
        messages = self._clouds[water]
        cloud = messages.read(max(bisect.bisect_right(messages.stamps, stamp) - 1, 0))
        at = stamp_of_header(cloud)
        return {"cloud": cloud_packet(water, at, cloud_of(cloud), self._all_at(at))}

    def _surface_pictures(self, stamp):
        pictures, at = {}, stamp
        for kind, numbers, packet in (("surface", self._surface, surface_packet), ("spray", self._spray, spray_packet)):
            if numbers:
                at, n = numbers[max(bisect.bisect_right(numbers, (stamp, len(self._markers))) - 1, 0)]
                pictures[kind] = packet(self._markers.read(n), at, self._all_at(at))
        return pictures

    def _all_at(self, stamp):
        return {"poses": self._poses_at(stamp), "values": self._values_at(stamp)}

    def _values_at(self, stamp):
        """Of each instrument what it measured last at that time, or first: plots are thinned. None of what is no number."""
        rows = {table.name: values[max(bisect.bisect_right(table.stamps, stamp) - 1, 0)] for table, values in self._tables}
        return {name: [float(value) if math.isfinite(value) else None for value in row] for name, row in rows.items()}

    def _poses_at(self, stamp):
        poses = {name: pose_numbers(*pose.at(stamp)) for name, pose in self._poses.items()}
        return {name: pose for name, pose in poses.items() if pose}


def stamp_of_header(message):
    secs, nsecs = message["header"]["stamp"]
    return secs * 1000000000 + nsecs


def read_case(text):
    """What the page wants to know of a case: title, dimensions, spacing (m), free bodies with their mass (kg; None where it is not told); each has a default where
    the bag or node does not tell."""
    try:
        case = mapping(yaml.load(text or "", Loader=getattr(yaml, "CSafeLoader", yaml.SafeLoader)))
    except (yaml.YAMLError, ValueError, TypeError, RecursionError):  # the loader's own, and those of dates that are none and the like
        case = {}
    bodies = case.get("bodies") if isinstance(case.get("bodies"), list) else []
    owners = [dict(mapping(case.get("tank")), name="tank")] + [body for body in map(mapping, bodies) if isinstance(body.get("name"), str)]
    return {
        "title": str(case.get("title") or ""),
        "dimensions": 2 if case.get("dimensions") == 2 else 3,
        "spacing": number_of(mapping(case.get("fluid")).get("spacing")),
        "world_frame": str(case.get("world_frame") or "tank"),  # the case's default: an empty one would be the body's own in a push
        "free": {owner["name"]: number_of(owner.get("mass")) for owner in owners if owner.get("motion") == "free"},
    }


def mapping(value):
    return value if isinstance(value, dict) else {}


def number_of(value):
    """A finite one, or None."""
    if isinstance(value, bool) or not isinstance(value, (int, float)) or not abs(value) <= sys.float_info.max:
        return None
    return float(value)
