"""The samples of a tank in a bag, instrument by instrument."""

import struct

import numpy

from wavetank import Failure
from wavetank.bag_file import BagFile
from wavetank.message_decoding import decode, read_definition, read_tree

AXES = ("x", "y", "z")
STATUS_UNITS = {
    "start_progress": "", "time": "s", "duration": "s", "step": "", "time_step": "s", "particles": "", "mass": "kg", "kinetic_energy": "J",
    "potential_energy": "J", "compression_energy": "J", "damper_power": "W", "greatest_speed": "m/s", "real_time_factor": "",
    "steps_per_second": "1/s", "guard_hits": "", "shepard_bounded": "",
}  # fmt: skip


class Table:
    """Samples of one instrument, or of those that are sampled together.

    name: its topic without the tank's namespace. stamps: ns of simulated time, increasing; times: the same in s. columns: arrays by name, of one value a stamp.
    units: by column, "" of what has none; in 2-D those of one metre of width. positions: of probes and gauges by column, m. frame: that the values are in.
    texts: of the last sample, by field (status alone)."""

    def __init__(self, name, stamps, columns, units, frame="", positions=None, texts=None):
        self.name, self.stamps, self.columns, self.units, self.frame = name, stamps, columns, units, frame
        self.positions, self.texts = positions or {}, texts or {}
        self.times = stamps / 1e9

    def __len__(self):
        return len(self.stamps)

    def array(self, *names):
        """Columns side by side."""
        return numpy.column_stack([self.columns[name] for name in names])

    def data_frame(self):
        try:
            import pandas
        except ImportError:
            raise Failure("data frames need pandas: install python3-pandas, or read tables of numpy by wavetank.read_tables")
        result = pandas.DataFrame(self.columns, index=pandas.Index(self.times, name="time"))
        result.attrs.update(units=dict(self.units), frame=self.frame, positions=dict(self.positions))
        return result


def stamp_of(numbers):
    return numbers["header.stamp.secs"][:, 0].astype(numpy.int64) * 1000000000 + numbers["header.stamp.nsecs"][:, 0]


def listed(field, unit):
    """Of messages with names and one list of values."""

    def columns(numbers, texts):
        names = texts.get("names", [])
        values = numbers[field]
        places = {name: tuple(float(numbers["positions." + axis][0, n]) for axis in AXES) for n, name in enumerate(names)}
        return {name: (values[:, n], unit) for n, name in enumerate(names)}, places

    return columns


def joint_columns(numbers, texts):
    columns = {}
    for n, name in enumerate(texts.get("name", [])):
        for field, unit in (("position", "rad or m"), ("velocity", "rad/s or m/s"), ("effort", "N m or N")):
            if numbers[field].shape[1] > n:
                columns["%s %s" % (name, field)] = (numbers[field][:, n], unit)
    return columns, {}


def plain(fields):
    """Of messages whose numbers are columns: (path, column, unit)."""
    return lambda numbers, texts: ({column: (numbers[path][:, 0], unit) for path, column, unit in fields}, {})


def status_columns(numbers, texts):
    fields = [path for path in numbers if "." not in path and path != "paused"]
    # the message's time is the simulation's own, which a reset sets back, while stamps go on
    return {"simulated_time" if path == "time" else path: (numbers[path][:, 0], STATUS_UNITS.get(path, "")) for path in fields}, {}


WRENCH = [("wrench.%s.%s" % (part, axis), "%s_%s" % (part, axis), unit) for part, unit in (("force", "N"), ("torque", "N m")) for axis in AXES]
ODOMETRY = (
    [("pose.pose.position." + axis, "position_" + axis, "m") for axis in AXES]
    + [("pose.pose.orientation." + axis, "orientation_" + axis, "") for axis in AXES + ("w",)]
    + [("twist.twist.linear." + axis, "velocity_" + axis, "m/s") for axis in AXES]
    + [("twist.twist.angular." + axis, "angular_velocity_" + axis, "rad/s") for axis in AXES]
)
IMU = (
    [("orientation." + axis, "orientation_" + axis, "") for axis in AXES + ("w",)]
    + [("angular_velocity." + axis, "angular_velocity_" + axis, "rad/s") for axis in AXES]
    + [("linear_acceleration." + axis, "specific_force_" + axis, "m/s^2") for axis in AXES]
)
TENSION = [("tension", "tension", "N"), ("anchor_tension", "anchor_tension", "N"), ("lying", "lying", "m")]

# Which topics of a tank are instruments: by type, the place under its namespace (* is a name) and what makes columns of it.
INSTRUMENTS = [
    ("wavetank/ProbeArray", "probes", listed("pressures", "Pa")),
    ("wavetank/WaveGaugeArray", "gauges", listed("levels", "m")),
    ("geometry_msgs/Vector3Stamped", "velocities/*", plain([("vector." + axis, "velocity_" + axis, "m/s") for axis in AXES])),
    ("wavetank/SectionFlow", "sections/*", plain([("discharge", "discharge", "m^3/s"), ("area", "area", "m^2")])),
    ("nav_msgs/Odometry", "bodies/*/odom", plain(ODOMETRY)),
    ("geometry_msgs/WrenchStamped", "bodies/*/wrench", plain(WRENCH)),
    ("geometry_msgs/WrenchStamped", "bodies/*/wrench/pressure", plain(WRENCH)),
    ("geometry_msgs/WrenchStamped", "bodies/*/wrench/viscous", plain(WRENCH)),
    ("sensor_msgs/Imu", "bodies/*/imu", plain(IMU)),
    ("wavetank/MooringTension", "bodies/*/moorings/*/tension", plain(TENSION)),
    ("wavetank/OpeningFlow", "openings/*/flow", plain([("discharge", "discharge", "m^3/s"), ("volume", "volume", "m^3")])),
    ("sensor_msgs/JointState", "joint_states", joint_columns),
    ("wavetank/SolverStatus", "status", status_columns),
]


def matching(topic, kind):
    """(namespace, name, order and columns) of an instrument's topic, or None."""
    words = topic.strip("/").split("/")
    for order, (wanted, pattern, columns) in enumerate(INSTRUMENTS):
        parts = pattern.split("/")
        tail = words[len(words) - len(parts) :]
        if kind == wanted and len(words) > len(parts) and all(part in ("*", word) for part, word in zip(parts, tail)):
            return "/" + "/".join(words[: len(words) - len(parts)]), "/".join(tail), order, columns
    return None


class Recording:
    """A tank's part of a bag. namespace: of the tank. names: of its instruments, as topics without the namespace. Raises Failure."""

    def __init__(self, path, namespace=None):
        self.path = path
        self._bag = BagFile(path)
        found = {}  # by namespace and name: order, columns, connections
        for number, connection in self._bag.connections.items():
            match = matching(connection.topic, connection.kind)
            if match:
                of, name, order, columns = match
                found.setdefault(of, {}).setdefault(name, (order, columns, []))[2].append(number)
        self.namespace = self._choose(sorted(found), namespace)
        chosen = found.get(self.namespace, {})
        self._instruments = {name: chosen[name] for name in sorted(chosen, key=lambda name: (chosen[name][0], name))}
        self.names = list(self._instruments)

    def _choose(self, found, wanted):
        if wanted is not None:
            wanted = "/" + wanted.strip("/")
            if wanted not in found:
                raise Failure("'%s' holds nothing of %s, only of %s" % (self.path, wanted, ", ".join(found) or "no tank"))
            return wanted
        if not found:
            raise Failure("'%s' holds no topics of a wave tank" % self.path)
        if len(found) > 1:
            raise Failure("'%s' holds several tanks: choose one of %s by --namespace" % (self.path, ", ".join(found)))
        return found[0]

    def _connections(self, name, kind):
        topic = self.namespace.rstrip("/") + "/" + name
        return [number for number, connection in self._bag.connections.items() if connection.topic == topic and connection.kind == kind]

    def has_cloud(self, name):
        return bool(self._connections(name, CLOUD))

    def stream(self, name, kind, header_at=0, take_recorded=False):
        """The messages of that name and type, one at a time. header_at: bytes before their header. take_recorded: see Stream."""
        return Stream(self._bag, self._connections(name, kind), kind, header_at, take_recorded)

    def first(self, name, kind):
        """The first message of that name and type under the namespace, as nested dictionaries and lists; None if there is none."""
        for number in self._connections(name, kind):
            with self._bag.reading(kind):
                types = read_definition(kind, self._bag.connections[number].definition)
                for place, _ in self._bag.places(number):
                    return read_tree(types, kind, self._bag.message(place))
        return None

    def text(self, name):
        """Of the first std_msgs/String of that name, such as "case"; None if there is none."""
        message = self.first(name, "std_msgs/String")
        return message and message["data"]

    def clouds(self, name):
        """The point clouds of that name, such as "free_surface", in the order of their stamps: (ns, arrays by field)."""
        stream = self.stream(name, CLOUD)
        return ((int(stamp), cloud_of(stream.read(n))) for n, stamp in enumerate(stream.stamps))

    def table(self, name):
        """The samples of an instrument, in the order of their stamps."""
        if name not in self._instruments:
            raise Failure("'%s' holds no %s under %s, only %s" % (self.path, name, self.namespace, ", ".join(self.names)))
        _, columns_of, numbers = self._instruments[name]
        pieces = []
        for number, blocks in self._bag.messages(set(numbers)).items():
            connection = self._bag.connections[number]
            with self._bag.reading(connection.kind):
                types = read_definition(connection.kind, connection.definition)
                for rows in joined(blocks):
                    pieces.extend((which, *columns_of(values, texts), stamp_of(values), texts) for values, texts, which in decode(types, connection.kind, rows))
        return self._put_together(name, [piece for piece in pieces if piece[1]] or pieces)

    def _put_together(self, name, pieces):
        if not pieces:
            return Table(name, numpy.empty(0, numpy.int64), {}, {})
        first = list(pieces[0][1])
        if any(list(piece[1]) != first for piece in pieces):
            raise Failure("'%s': %s does not have the same instruments from beginning to end" % (self.path, name))
        stamps = numpy.concatenate([piece[3] for piece in pieces])
        order = numpy.argsort(stamps, kind="stable")
        columns = {column: numpy.concatenate([piece[1][column][0] for piece in pieces])[order] for column in first}
        units = {column: pieces[0][1][column][1] for column in first}
        last = max(pieces, key=lambda piece: piece[3].max())
        texts = {path: values[0] for path, values in last[4].items() if values and "." not in path} if name == "status" else {}
        frame = pieces[0][4].get("header.frame_id", [""])[0]
        return Table(name, stamps[order], columns, units, frame, pieces[0][2], texts)


def joined(blocks):
    """Blocks of rows of one length each, put together where the lengths are the same."""
    by_length = {}
    for rows in blocks:
        by_length.setdefault(rows.shape[1], []).append(rows)
    return [numpy.concatenate(same) for same in by_length.values()]


class Stream:
    """Messages that are too large to be read all at once. stamps: ns of simulated time, in order.

    take_recorded: where none of them has a stamp, as the markers of earlier versions, the times that they were recorded."""

    def __init__(self, bag, connections, kind, header_at=0, take_recorded=False):
        self._bag, self._kind = bag, kind
        found = []
        for number in connections:
            with bag.reading(kind):
                types = read_definition(kind, bag.connections[number].definition)
                for place, recorded in bag.places(number):
                    seconds, nanoseconds = struct.unpack_from("<II", bag.message(place, header_at + 12), header_at + 4)  # after the header's count
                    found.append((seconds * 1000000000 + nanoseconds, place, types, recorded))
        if take_recorded and not any(each[0] for each in found):
            found = [(recorded, place, types, recorded) for _, place, types, recorded in found]
        found.sort(key=lambda each: each[0])
        self.stamps = numpy.array([each[0] for each in found], numpy.int64)
        self._found = found

    def __len__(self):
        return len(self._found)

    def read(self, n):
        """The n-th as read_tree has it."""
        _, place, types, _ = self._found[n]
        with self._bag.reading(self._kind):
            return read_tree(types, self._kind, self._bag.message(place))

    def group(self, n):
        """The namespace of the n-th, a visualization_msgs/Marker, without its points, which are many."""
        _, place, _, _ = self._found[n]
        with self._bag.reading(self._kind):
            end = 12
            for _ in range(2):  # the header's frame, and the namespace
                begin = end + 4
                end = begin + struct.unpack_from("<I", self._bag.message(place, begin), begin - 4)[0]
            return self._bag.message(place, end)[begin:].decode("utf-8", "replace")


CLOUD = "sensor_msgs/PointCloud2"
POINT_FIELDS = {1: "i1", 2: "u1", 3: "<i2", 4: "<u2", 5: "<i4", 6: "<u4", 7: "<f4", 8: "<f8"}


def cloud_of(message):
    """The points of a cloud, by field."""
    fields = message["fields"]
    kind = numpy.dtype(
        {
            "names": [field["name"] for field in fields],
            "formats": [POINT_FIELDS[int(field["datatype"])] for field in fields],
            "offsets": [int(field["offset"]) for field in fields],
            "itemsize": int(message["point_step"]),
        }
    )
    points = message["data"].view(kind)
    return {field: points[field] for field in kind.names}
