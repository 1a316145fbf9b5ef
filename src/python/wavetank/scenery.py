"""What a bag shows: tank and bodies as meshes where they are, the water as a surface or as particles."""

import sys

import numpy

from wavetank import Failure
from wavetank.meshes import triangles_of
from wavetank.runs import read_yaml

CLOUDS = ("particles", "free_surface")
SURFACE = "surface_mesh"
MARKER, MARKERS = "visualization_msgs/Marker", "visualization_msgs/MarkerArray"
ADD, STRIP, LINES, POINTS, RESOURCE, TRIANGLES = 0, 4, 5, 8, 10, 11  # of visualization_msgs/Marker
TANK = "tank"


def turned(quaternion, vectors):
    """Rows of vectors turned by x y z w."""
    axis, real = quaternion[:3], quaternion[3]
    first = 2.0 * numpy.cross(axis, vectors)
    return vectors + real * first + numpy.cross(axis, first)


def vector(message):
    return numpy.array([message[axis] for axis in "xyz"], dtype=float)


def rows(points):
    """Of an array of geometry_msgs/Point."""
    return numpy.column_stack([points[axis] for axis in "xyz"]) if len(points) else numpy.empty((0, 3))


def placed(marker, points):
    pose = marker["pose"]
    return turned(numpy.array([pose["orientation"][axis] for axis in "xyzw"], dtype=float), points) + vector(pose["position"])


def resource_points(marker):
    """Of a mesh that a marker only names, as those of a live node do; None where it cannot be read here."""
    triangles = triangles_of(marker["mesh_resource"])
    return None if triangles is None else triangles * vector(marker["scale"])


class Pose:
    """Where a body that moves is at a time."""

    def __init__(self, table):
        self._times = table.stamps
        self._positions = table.array("position_x", "position_y", "position_z")
        self._turns = table.array("orientation_x", "orientation_y", "orientation_z", "orientation_w")

    def at(self, stamp):
        """(position, x y z w). Between two samples in even parts; samples are so near to each other that turns need no better."""
        after = int(numpy.clip(numpy.searchsorted(self._times, stamp), 1, max(len(self._times) - 1, 1)))
        before = after - 1
        after = min(after, len(self._times) - 1)
        gap = self._times[after] - self._times[before]
        share = min(max((stamp - self._times[before]) / gap, 0.0), 1.0) if gap else 0.0
        position = self._positions[before] + share * (self._positions[after] - self._positions[before])
        first, second = self._turns[before], self._turns[after]
        turn = first + share * ((second if first @ second >= 0 else -second) - first)
        return position, turn / numpy.linalg.norm(turn)

    def place(self, points, stamp):
        position, turn = self.at(stamp)
        return turned(turn, points) + position


class Shape:
    """Triangles, three points each, or lines, two points each, of the tank or a body. pose: of what moves, in whose frame the points are, or None."""

    def __init__(self, name, kind, points, pose=None):
        self.name, self.kind, self.points, self.pose = name, kind, points, pose

    def at(self, stamp):
        """The points in the tank's frame."""
        return self.points if self.pose is None else self.pose.place(self.points, stamp)


class Scenery:
    """title; case: the case as read from YAML; meshes, edges: Shape by the name of its owner; probes: points as Shape, in the case's order, as far as the
    bag has its markers, None for one on a body whose poses it does not have; tank_pose: of a tank that moves, else None. What cannot be placed is told once
    on standard error."""

    def __init__(self, recording):
        self._recording = recording
        self.text = recording.text("case") or ""
        case = read_yaml(self.text)
        self.case = case if isinstance(case, dict) else {}
        self.title = str(self.case.get("title", ""))
        odometries = {name.split("/")[1]: recording.table(name) for name in recording.names if name.endswith("/odom")}
        self.poses = {name: Pose(table) for name, table in odometries.items() if len(table)}
        self.tank_pose = self.poses.get(TANK)
        self.meshes, self.edges, self.probes = {}, {}, []
        self._drawings = None  # all messages of markers, read when they are first asked for
        self._lost = set()  # bodies that move in a way the bag does not tell
        message = recording.first("markers", MARKERS)
        for marker in message["markers"] if message else []:
            if marker["action"] == ADD:
                self._add(marker)

    def _add(self, marker):
        group, number = marker["ns"], int(marker["id"])
        body = marker["header"]["frame_id"].partition("/bodies/")[2]  # that it is drawn in the frame of
        is_lost = bool(body) and body not in self.poses
        if is_lost and body not in self._lost:
            self._lost.add(body)
            print(
                "warning: '%s' does not tell where body '%s' is: it has no bodies/%s/odom; left out, with its probes" % (self._recording.path, body, body),
                file=sys.stderr,
            )
        if group == "probes":
            self.probes.append(None if is_lost else Shape(group, "Verts", placed(marker, numpy.zeros((1, 3))), self.poses.get(body)))
        if is_lost:
            return
        if group not in ("tank", "tank edges", "bodies", "body edges"):
            return
        names = [each["name"] for each in self.case.get("bodies") or []]
        name = TANK if group.startswith(TANK) else names[number] if number < len(names) else "body_%d" % number
        points = resource_points(marker) if marker["type"] == RESOURCE else rows(marker["points"])
        if points is not None and len(points):
            kind = "Lines" if marker["type"] == LINES else "Polys"
            (self.edges if kind == "Lines" else self.meshes)[name] = Shape(name, kind, placed(marker, points), self.poses.get(body))

    def moorings_at(self, stamp):
        """Their lines in the world as they were drawn last, two points a segment; none before they are first."""
        if self._drawings is None:
            self._drawings = self._recording.stream("markers", MARKERS, header_at=4)
        last = int(numpy.searchsorted(self._drawings.stamps, stamp, side="right")) - 1
        markers = self._drawings.read(last)["markers"] if last > 0 else []  # the first draws the tank and what stands in it
        lines = [placed(marker, rows(marker["points"])) for marker in markers if marker["ns"] == "moorings" and marker["type"] == STRIP]
        segments = [numpy.stack([line[:-1], line[1:]], axis=1).reshape(-1, 3) for line in lines if len(line) > 1]
        return numpy.concatenate(segments) if segments else numpy.empty((0, 3))

    def shapes(self):
        """Meshes, and the edges of what has no mesh here."""
        return list(self.meshes.values()) + [edge for name, edge in self.edges.items() if name not in self.meshes]

    def number(self, *path):
        """A number of the case, by its keys, or None."""
        value = self.case
        for key in path:
            value = value.get(key) if isinstance(value, dict) else None
        return float(value) if isinstance(value, (int, float)) else None

    def water(self):
        """What the bag has of it: a Surface, or else Particles. Raises Failure."""
        return self.waters()[0]

    def waters(self):
        """The same water as often as the bag has it: a Surface, and Particles; one of them at least. Raises Failure."""
        clouds = (Particles(self._recording, name) for name in CLOUDS if self._recording.has_cloud(name))
        particles = [cloud for cloud in clouds if len(cloud.stamps)][:1]
        found = [each for each in (Surface(self._recording),) if len(each.stamps)] + particles
        if not found:
            raise Failure(
                "'%s' holds no water, neither a surface nor point clouds: write it with wavetank_run --surface, --particles or --clouds" % self._recording.path
            )
        return found

    def particles(self):
        """Likewise Particles alone."""
        for each in self.waters():
            if isinstance(each, Particles):
                return each
        raise Failure("'%s' holds no particles of the water: write them with wavetank_run --particles or --clouds" % self._recording.path)


class Particles:
    """stamps: ns. name: of the cloud."""

    def __init__(self, recording, name):
        self.name = name
        self._stream = recording.stream(name, "sensor_msgs/PointCloud2")
        self.stamps = self._stream.stamps

    def cloud(self, n):
        from wavetank.recording import cloud_of

        return cloud_of(self._stream.read(n))


class Surface:
    """The water's surface as triangles, and the spray beside it. stamps: ns."""

    name = "surface"

    def __init__(self, recording):
        self._stream = recording.stream(SURFACE, MARKER)
        self.stamps = numpy.unique(self._stream.stamps)

    def at(self, n):
        """(corners of triangles, points of spray): rows x y z."""
        found = {"surface": numpy.empty((0, 3)), "spray": numpy.empty((0, 3))}
        first, last = numpy.searchsorted(self._stream.stamps, [self.stamps[n], self.stamps[n] + 1])
        for place in range(first, last):
            marker = self._stream.read(place)
            if marker["action"] == ADD and marker["ns"] in found and marker["type"] in (TRIANGLES, POINTS):
                found[marker["ns"]] = placed(marker, rows(marker["points"]))
        return found["surface"], found["spray"]
