"""Writes a bag's water, tank, bodies and instruments as files that ParaView reads: VTK's XML format of polygons, its numbers appended in binary.

wavetank_run --vtk writes the same (src/node/vtk_recorder.cpp); docs/pictures.md says what there is."""

import os
import shutil
import time
import zlib
from xml.sax.saxutils import escape

import numpy

from wavetank import Failure
from wavetank.meshes import package_path
from wavetank.scenery import TANK, Scenery, Surface

COLLECTION, VIEW, DATA = "case.pvd", "view.py", "data"
SCRIPT = "package://wavetank/config/paraview/view.py"
RENAMED = {"shepard": "gamma", "eigenvalue": "lambda"}
PACKED = ("mass", "id", "gamma", "surface")  # few different values, or such that differ little; other numbers pack badly, and cost time
LISTING_PERIOD = 5.0  # s of wall time between two writings of the collections
CELLS = {"Verts": 1, "Lines": 2, "Polys": 3}


class PolyData:
    """points: rows x y z (m). fields: arrays by name, a row or a value a point, or lists of texts. kind: of "Verts", "Lines" or "Polys", each point in one."""

    def __init__(self, points, fields, kind):
        self.points, self.fields, self.kind = numpy.ascontiguousarray(points), fields, kind

    def write(self, path):
        """Replaces the file when it is whole."""
        blocks, length = [], 0

        def array(name, values, packed):
            nonlocal length
            if isinstance(values, list):
                kind, width, data = "String", 1, b"".join(text.encode("utf-8") + b"\0" for text in values)
                more = ' NumberOfTuples="%d"' % len(values)
            else:
                values = numpy.ascontiguousarray(values)
                kind = {"f": "Float%d", "i": "Int%d", "u": "UInt%d"}[values.dtype.kind] % (8 * values.dtype.itemsize)
                width, data, more = values.shape[1] if values.ndim > 1 else 1, values.tobytes(), ""
            place = length
            if data:
                block = zlib.compress(data, 1 if packed else 0)
                head = [1, len(data), 0, len(block)]  # how many blocks, their length, that of a shorter last one, packed lengths
            else:
                block, head = b"", [0]
            blocks.extend([numpy.array(head, dtype="<u8").tobytes(), block])
            length += 8 * len(head) + len(block)
            return '<DataArray type="%s" Name="%s" NumberOfComponents="%d" format="appended" offset="%d"%s/>' % (
                kind,
                escape(name, {'"': "&quot;"}),
                width,
                place,
                more,
            )

        count, size = len(self.points), CELLS[self.kind]
        # one cell of all points costs less than one of each, and is drawn alike
        offsets = numpy.array([count] if count else [], "<i4") if size == 1 else size * numpy.arange(1, count // size + 1, dtype="<i4")
        parts = ["<PointData>"] + [array(name, values, name in PACKED) for name, values in self.fields.items()] + ["</PointData>"]
        parts += ["<Points>", array("points", self.points, False), "</Points>", "<%s>" % self.kind]
        parts += [array("connectivity", numpy.arange(count, dtype="<i4"), True), array("offsets", offsets, True), "</%s>" % self.kind]
        numbers = " ".join('NumberOf%s="%d"' % (kind, len(offsets) if kind == self.kind else 0) for kind in ("Verts", "Lines", "Strips", "Polys"))
        head = (
            '<?xml version="1.0"?>\n'
            '<VTKFile type="PolyData" version="1.0" byte_order="LittleEndian" header_type="UInt64" compressor="vtkZLibDataCompressor">\n<PolyData>\n'
            '<Piece NumberOfPoints="%d" %s>\n%s\n</Piece>\n</PolyData>\n<AppendedData encoding="raw">\n_' % (count, numbers, "\n".join(parts))
        )
        write_whole(path, [head.encode("ascii")] + blocks + [b"\n</AppendedData>\n</VTKFile>\n"])


def write_whole(path, parts):
    try:
        with open(path + ".part", "wb") as file:
            file.writelines(parts)
        os.replace(path + ".part", path)
    except OSError:
        if os.path.exists(path + ".part"):
            os.remove(path + ".part")
        raise


class Collection:
    """Files of a run by their times."""

    def __init__(self):
        self._entries = []

    def add(self, time, part, name, file):
        self._entries.append('<DataSet timestep="%.9g" part="%d" name="%s" file="%s"/>' % (time, part, name, file))

    def write(self, path):
        text = '<?xml version="1.0"?>\n<VTKFile type="Collection" version="0.1">\n<Collection>\n%s\n</Collection>\n</VTKFile>\n' % "\n".join(self._entries)
        write_whole(path, [text.encode("ascii")])


class Folder:
    """Where the files of a run are put: case.pvd over all, and data/ with a collection for each thing that is drawn."""

    def __init__(self, path):
        self.path = path
        what = "cannot write files for ParaView into '%s': " % path
        if os.path.isdir(path):
            if os.listdir(path):
                raise Failure(what + "it is not empty; give a new folder, or empty it")
        elif os.path.exists(path):
            raise Failure(what + "it is no folder")
        try:
            os.makedirs(os.path.join(path, DATA))
        except OSError as error:
            raise Failure(what + (error.strerror or str(error)))
        self._all, self._parts, self._places, self._still = Collection(), {}, {}, set()
        self._time, self._count, self._listed = 0.0, -1, time.monotonic()

    def begin(self, stamp):
        """The frame of a time, s. What there was before is listed from time to time."""
        self._time, self._count = stamp, self._count + 1
        if time.monotonic() - self._listed > LISTING_PERIOD:
            self.write_collections()

    def write(self, name, data):
        """Of this time alone."""
        self._list(name, "%s_%05d.vtp" % (name, self._count), data)

    def write_still(self, name, data):
        """The same at all times."""
        self._list(name, name + ".vtp", None if name in self._still else data)
        self._still.add(name)

    def _list(self, name, file, data):
        if data is not None:
            data.write(os.path.join(self.path, DATA, file))
        self._parts.setdefault(name, Collection()).add(self._time, 0, name, file)
        # a name keeps its place in all frames
        self._all.add(self._time, self._places.setdefault(name, len(self._places)), name, DATA + "/" + file)

    def write_collections(self):
        """Replaces the collections: ParaView sees what these have."""
        self._listed = time.monotonic()
        for name, collection in self._parts.items():
            collection.write(os.path.join(self.path, DATA, name + ".pvd"))
        self._all.write(os.path.join(self.path, COLLECTION))


def cloud_data(cloud):
    fields = {}
    if {"vx", "vy", "vz"} <= set(cloud):
        fields["velocity"] = numpy.column_stack([cloud["vx"], cloud["vy"], cloud["vz"]])
    for name, values in cloud.items():
        if name not in ("x", "y", "z", "vx", "vy", "vz"):
            fields[RENAMED.get(name, name)] = values.astype("u1") if name == "surface" else values
    return PolyData(numpy.column_stack([cloud["x"], cloud["y"], cloud["z"]]), fields, "Verts")


class Readings:
    """What an instrument with many points told last, as points with values."""

    def __init__(self, name, value, table, place):
        self.name, self._value, self._table, self._place = name, value, table, place

    def at(self, stamp):
        row = int(numpy.searchsorted(self._table.stamps, stamp, side="right")) - 1
        values = {column: float(samples[max(row, 0)]) for column, samples in self._table.columns.items()}
        places = {column: self._place(column, value, stamp) for column, value in values.items()}
        values = {column: value for column, value in values.items() if places[column] is not None}
        points = numpy.array([places[column] for column in values], dtype=float).reshape(-1, 3)
        return PolyData(points, {self._value: numpy.array(list(values.values())), "name": list(values)}, "Verts")


def readings_of(recording, scenery):
    found = []
    if "probes" in recording.names:
        table = recording.table("probes")
        drawn = dict(zip(table.columns, scenery.probes))

        def place_of_probe(name, value, stamp):
            if name not in drawn:
                return numpy.array(table.positions[name])
            return None if drawn[name] is None else drawn[name].at(stamp)[0]

        found.append(Readings("probes", "pressure", table, place_of_probe))
    if "gauges" in recording.names:
        levels = recording.table("gauges")
        axis = up_axis(scenery.case)

        def place_on_surface(name, value, stamp):
            place = numpy.array(levels.positions[name])
            place[axis] = value
            return place

        found.append(Readings("gauges", "level", levels, place_on_surface))
    return [each for each in found if len(each._table)]


def up_axis(case):
    """Along which levels are told: 0, 1 or 2, as src/scene/upward.cpp has it: the axis nearest to that of the gravity that the water can rest in, which is
    without the parts along which the tank repeats itself; of two that are alike z before y and y before x, and z without any."""
    tank = case.get("tank")
    periodic = tank.get("periodic") if isinstance(tank, dict) else None
    gravity = case.get("gravity")
    if not isinstance(gravity, list) or len(gravity) not in (2, 3):
        return 2
    gravity = numpy.abs(numpy.array([gravity[0], 0.0, gravity[1]] if len(gravity) == 2 else gravity, dtype=float))
    for axis, name in enumerate("xyz"):
        if name in (periodic or []) or (name == "y" and case.get("dimensions") == 2):
            gravity[axis] = 0.0
    return max((2, 1, 0), key=lambda axis: gravity[axis])  # the first of the greatest


def write_vtk(recording, path):
    """Writes all of a bag that can be seen, at the times that it has of the water, and returns the file to open."""
    scenery = Scenery(recording)
    water, readings = scenery.waters(), readings_of(recording, scenery)
    script = package_path(SCRIPT)
    if script is None or not os.path.isfile(script):
        raise Failure("the package wavetank is not to be found, whose view for ParaView goes beside the files: source setup.bash")
    folder = Folder(path)  # last, so that what is wrong leaves none that is in the way of another try
    shutil.copyfile(script, os.path.join(path, VIEW))
    try:
        for stamp in sorted(set().union(*(each.stamps.tolist() for each in water))):
            write_frame(folder, scenery, water, readings, stamp)
    finally:
        folder.write_collections()
    return os.path.join(path, COLLECTION)


def write_frame(folder, scenery, water, readings, stamp):
    folder.begin(stamp / 1e9)
    for each in water:
        write_water(folder, each, stamp)
    for shape in scenery.shapes():
        name = shape.name if shape.name == TANK else "body_" + shape.name
        if shape.pose is None:
            folder.write_still(name, PolyData(shape.points, {}, shape.kind))
        else:
            folder.write(name, PolyData(shape.at(stamp), {}, shape.kind))
    for each in readings:
        folder.write(each.name, each.at(stamp))


def write_water(folder, water, stamp):
    n = int(numpy.searchsorted(water.stamps, stamp, side="right")) - 1  # of the last time that has it
    n = max(n, 0)
    if isinstance(water, Surface):
        corners, spray = water.at(n)
        folder.write("surface", PolyData(corners.astype("<f4"), {}, "Polys"))
        folder.write("spray", PolyData(spray.astype("<f4"), {}, "Verts"))
    else:
        folder.write("water", cloud_data(water.cloud(n)))
