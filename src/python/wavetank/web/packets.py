"""What goes to the page as binary messages: a line of JSON and arrays after it.

Layout: length of the JSON (uint32, little-endian), the JSON padded with blanks so that what follows lies at a multiple of eight, then the arrays one after the
other, each padded likewise. The JSON has "kind", what the kind says, and "arrays": of each name, type and count.
"""

import json
import struct

import numpy

TYPES = {"f4": "float32", "f8": "float64", "u1": "uint8", "u2": "uint16", "u4": "uint32"}
STEPS = 65535  # of a quantised coordinate


def padded(data):
    return data + b" " * (-len(data) % 8)


def pack(header, **arrays):
    """A packet. header: a dictionary with "kind". arrays: of numpy, of one of TYPES; rows one after the other."""
    arrays = {name: numpy.ascontiguousarray(values) for name, values in arrays.items()}
    described = [{"name": name, "type": TYPES[values.dtype.str[1:]], "count": values.size} for name, values in arrays.items()]
    text = json.dumps(dict(header, arrays=described), separators=(",", ":"), allow_nan=False).encode("utf-8")
    text += b" " * (-(len(text) + 4) % 8)
    return b"".join([struct.pack("<I", len(text)), text] + [padded(values.tobytes()) for values in arrays.values()])


def unpack(data):
    """The header and the arrays by name."""
    (length,) = struct.unpack_from("<I", data)
    header, place, arrays = json.loads(data[4 : 4 + length].decode("utf-8")), 4 + length, {}
    for each in header["arrays"]:
        kind = numpy.dtype(each["type"]).newbyteorder("<")
        arrays[each["name"]] = numpy.frombuffer(data, kind, each["count"], place)
        place += each["count"] * kind.itemsize
        place += -place % 8
    return header, arrays


class Box:
    """The box about points (rows x y z), in which they are quantised to 16 bits a coordinate: to 0.05 mm in a tank of 3 m."""

    def __init__(self, points):
        self.low = points.min(axis=0).astype(float) if len(points) else numpy.zeros(3)
        self.size = (points.max(axis=0) - self.low).astype(float) if len(points) else numpy.zeros(3)

    def described(self):
        return {"low": self.low.tolist(), "size": self.size.tolist()}

    def quantised(self, points):
        factor = numpy.divide(STEPS, self.size, out=numpy.zeros(3), where=self.size > 0)
        return ((points - self.low.astype(points.dtype)) * factor.astype(points.dtype) + 0.5).astype("<u2")


def cloud_packet(name, stamp, cloud, header=None):
    """A point cloud by its fields: positions and speed, 16 bits each. name: its topic. stamp: ns. "typical_speed": which one particle in fifty is faster than."""
    points = numpy.column_stack([cloud[axis] for axis in "xyz"])
    velocity = numpy.column_stack([cloud[axis] for axis in ("vx", "vy", "vz")]) if "vx" in cloud else numpy.zeros_like(points)
    sound = numpy.isfinite(points).all(axis=1) & numpy.isfinite(velocity).all(axis=1)
    if not sound.all():
        points, velocity = points[sound], velocity[sound]
    speeds = numpy.sqrt(numpy.einsum("ij,ij->i", velocity, velocity))
    top = float(speeds.max()) if len(speeds) else 0.0
    typical = float(numpy.partition(speeds, len(speeds) - 1 - len(speeds) // 50)[len(speeds) - 1 - len(speeds) // 50]) if len(speeds) else 0.0
    box = Box(points)
    packed = numpy.empty((len(points), 4), "<u2")
    packed[:, :3] = box.quantised(points)
    packed[:, 3] = speeds * (STEPS / top) if top > 0 else 0
    described = dict(header or {}, kind="cloud", water=name, time=stamp / 1e9, top_speed=top, typical_speed=typical, **box.described())
    return pack(described, points=packed)


def rows_of(records, names="xyz"):
    """An array of records (read_tree) as rows."""
    return numpy.column_stack([records[name] for name in names]).astype("<f4")


def colours_of(marker):
    colours = marker["colors"]
    if not len(marker["points"]) or len(colours) != len(marker["points"]):
        return None
    return (numpy.clip(rows_of(colours, "rgba"), 0, 1) * 255 + 0.5).astype("u1")


def surface_packet(marker, stamp, header=None):
    """The triangles of a visualization_msgs/Marker (read_tree). Corners that fall on one place of the quantised box are one, so that the page can shade it
    smoothly."""
    points = rows_of(marker["points"]) if len(marker["points"]) else numpy.empty((0, 3), "<f4")
    points = points[: len(points) // 3 * 3]
    box = Box(points)
    places = box.quantised(points).astype(numpy.int64)
    _, first, inverse = numpy.unique((places[:, 0] << 32) | (places[:, 1] << 16) | places[:, 2], return_index=True, return_inverse=True)
    packed = numpy.zeros((len(first), 4), "<u2")
    packed[:, :3] = places[first]
    arrays = {"points": packed, "corners": inverse.astype("<u4")}
    colours = colours_of(marker)
    if colours is not None:
        arrays["colours"] = colours[first]
    return pack(dict(header or {}, kind="surface", time=stamp / 1e9, colour=colour_of(marker), **box.described()), **arrays)


def spray_packet(marker, stamp, header=None):
    """The points of a visualization_msgs/Marker."""
    points = rows_of(marker["points"]) if len(marker["points"]) else numpy.empty((0, 3), "<f4")
    return pack(dict(header or {}, kind="spray", time=stamp / 1e9, colour=colour_of(marker), size=finite(marker["scale"]["x"])), points=points)


def colour_of(marker):
    return [finite(marker["color"][part]) for part in "rgba"]


def finite(value):
    return float(value) if numpy.isfinite(value) else 0.0


def series_packet(table, times, values, clear=False):
    """Samples of an instrument: values has a row a time. table: a dictionary with name, columns and units. clear: those before are of another run."""
    return pack(dict(table, kind="series", clear=clear), times=times.astype("<f8"), values=values.astype("<f8"))
