"""Writes the clouds, the tank and the bodies of a bag as files that ParaView reads: VTK's XML format of polygons, its numbers appended in binary."""

import os

import numpy
import yaml

from wavetank import Failure

CLOUDS = ("particles", "free_surface")
MARKERS = "visualization_msgs/MarkerArray"
ADD, TRIANGLES, LINES = 0, 11, 5  # of visualization_msgs/Marker
COLLECTION = "case.pvd"
VIEW = '''"""For ParaView: pvpython view.py, or File, Load State: the water coloured by its speed, the tank and the bodies."""

import os

from paraview.simple import ColorBy, GetActiveViewOrCreate, GetAnimationScene, Interact, PVDReader, Render, ResetCamera, Show

reader = PVDReader(FileName=os.path.join(os.path.dirname(os.path.abspath(__file__)), "case.pvd"))
view = GetActiveViewOrCreate("RenderView")
display = Show(reader, view)
display.PointSize = 4.0
ColorBy(display, ("POINTS", "velocity", "Magnitude"))
display.RescaleTransferFunctionToDataRange(False, True)
GetAnimationScene().UpdateAnimationUsingDataTimeSteps()
ResetCamera(view)
Render(view)
if __name__ == "__main__":
    Interact(view)
'''


class PolyData:
    """points: rows x y z (m). fields: arrays by name, a row or a value a point. cells: of "Verts", "Lines" or "Polys", each point in one, `size` points each."""

    def __init__(self, points, fields, cells, size):
        self.points, self.fields, self.cells, self.size = numpy.ascontiguousarray(points, dtype="<f4"), fields, cells, size

    def write(self, path):
        """Replaces the file when it is whole."""
        count = len(self.points) // self.size
        blocks = []

        def array(name, values):
            blocks.append(numpy.ascontiguousarray(values))
            offset = sum(8 + block.nbytes for block in blocks[:-1])
            kind = {"f": "Float%d", "i": "Int%d", "u": "UInt%d"}[blocks[-1].dtype.kind] % (8 * blocks[-1].dtype.itemsize)
            width = blocks[-1].shape[1] if blocks[-1].ndim > 1 else 1
            return '<DataArray type="%s" Name="%s" NumberOfComponents="%d" format="appended" offset="%d"/>' % (kind, name, width, offset)

        parts = ["<PointData>"] + [array(name, values) for name, values in self.fields.items()] + ["</PointData>"]
        parts += ["<Points>", array("points", self.points), "</Points>"]
        cells = [array("connectivity", numpy.arange(count * self.size, dtype="<i8")), array("offsets", self.size * numpy.arange(1, count + 1, dtype="<i8"))]
        parts += ["<%s>" % self.cells] + cells + ["</%s>" % self.cells]
        numbers = " ".join('NumberOf%s="%d"' % (kind, count if kind == self.cells else 0) for kind in ("Verts", "Lines", "Strips", "Polys"))
        head = (
            '<?xml version="1.0"?>\n<VTKFile type="PolyData" version="1.0" byte_order="LittleEndian" header_type="UInt64">\n<PolyData>\n'
            '<Piece NumberOfPoints="%d" %s>\n%s\n</Piece>\n</PolyData>\n<AppendedData encoding="raw">\n_' % (len(self.points), numbers, "\n".join(parts))
        )
        with open(path + ".part", "wb") as file:
            file.write(head.encode("ascii"))
            for block in blocks:
                file.write(numpy.array(block.nbytes, dtype="<u8").tobytes())
                file.write(block.tobytes())
            file.write(b"\n</AppendedData>\n</VTKFile>\n")
        os.replace(path + ".part", path)


def cloud_data(cloud):
    fields = {name: values for name, values in cloud.items() if name not in ("x", "y", "z", "vx", "vy", "vz")}
    if {"vx", "vy", "vz"} <= set(cloud):
        fields["velocity"] = numpy.column_stack([cloud["vx"], cloud["vy"], cloud["vz"]])
    return PolyData(numpy.column_stack([cloud["x"], cloud["y"], cloud["z"]]), fields, "Verts", 1)


def turned(quaternion, vectors):
    """Rows of vectors turned by x y z w."""
    axis, real = quaternion[:3], quaternion[3]
    first = 2.0 * numpy.cross(axis, vectors)
    return vectors + real * first + numpy.cross(axis, first)


def vector(message):
    return numpy.array([message[axis] for axis in "xyz"])


def shapes_of(recording):
    """Of the tank and the bodies as the markers draw them, by group and number: (frame, points, (cells, size)). What the markers only name, a mesh in a
    package, has its edges."""
    message = recording.first("markers", MARKERS)
    shapes = {}
    for marker in message["markers"] if message else []:
        if marker["action"] != ADD or not marker["points"] or marker["ns"] not in ("tank", "tank edges", "bodies", "body edges"):
            continue
        points = numpy.array([vector(point) for point in marker["points"]])
        pose = marker["pose"]
        points = turned(numpy.array([pose["orientation"][axis] for axis in "xyzw"]), points) + vector(pose["position"])
        owner = (marker["ns"].split()[0].replace("body", "bodies"), marker["id"])
        cells = {TRIANGLES: ("Polys", 3), LINES: ("Lines", 2)}.get(marker["type"])
        if cells and (owner not in shapes or cells[0] == "Polys"):
            shapes[owner] = (marker["header"]["frame_id"], points, cells)
    return shapes


def names_of_bodies(recording):
    """In the case's order, as far as the bag has its case."""
    case = yaml.safe_load(recording.text("case") or "")
    return [body["name"] for body in case.get("bodies") or []] if isinstance(case, dict) else []


class Pose:
    """Where a body that moves is at a time."""

    def __init__(self, table):
        self._times = table.stamps
        self._positions = table.array("position_x", "position_y", "position_z")
        self._turns = table.array("orientation_x", "orientation_y", "orientation_z", "orientation_w")

    def place(self, points, stamp):
        """Between two samples in even parts; samples are so near to each other that turns need no better."""
        after = int(numpy.clip(numpy.searchsorted(self._times, stamp), 1, max(len(self._times) - 1, 1)))
        before = after - 1
        after = min(after, len(self._times) - 1)
        gap = self._times[after] - self._times[before]
        share = min(max((stamp - self._times[before]) / gap, 0.0), 1.0) if gap else 0.0
        position = self._positions[before] + share * (self._positions[after] - self._positions[before])
        first, second = self._turns[before], self._turns[after]
        turn = first + share * ((second if first @ second >= 0 else -second) - first)
        return turned(turn / numpy.linalg.norm(turn), points) + position


def write_vtk(recording, folder):
    """Writes a file for each cloud, one for each body that moves at each cloud's time, one for each that does not, case.pvd over all and view.py."""
    name = next((each for each in CLOUDS if recording.has_cloud(each)), None)
    if name is None:
        raise Failure("'%s' holds no point clouds: write it with wavetank_run --clouds" % recording.path)
    os.makedirs(folder, exist_ok=True)
    poses = {each.split("/")[1]: Pose(recording.table(each)) for each in recording.names if each.endswith("/odom")}
    names = names_of_bodies(recording)
    fixed, moving = [], []
    for (group, number), (frame, points, (cells, size)) in shapes_of(recording).items():
        title = "tank" if group == "tank" else names[number] if number < len(names) else "body_%d" % number
        if "/bodies/" in frame and title in poses:  # drawn in the frame of a body that moves
            moving.append((title, poses[title], points, cells, size))
        else:
            fixed.append(title + ".vtp")
            PolyData(points, {}, cells, size).write(os.path.join(folder, fixed[-1]))
    entries = []
    for count, (stamp, cloud) in enumerate(recording.clouds(name)):
        files = ["%s_%05d.vtp" % (name, count)]
        cloud_data(cloud).write(os.path.join(folder, files[0]))
        for title, pose, points, cells, size in moving:
            files.append("%s_%05d.vtp" % (title, count))
            PolyData(pose.place(points, stamp), {}, cells, size).write(os.path.join(folder, files[-1]))
        entries += ['<DataSet timestep="%.9g" part="%d" file="%s"/>' % (stamp / 1e9, part, file) for part, file in enumerate(files + fixed)]
    with open(os.path.join(folder, COLLECTION), "w", encoding="ascii") as file:
        file.write('<?xml version="1.0"?>\n<VTKFile type="Collection" version="0.1">\n<Collection>\n%s\n</Collection>\n</VTKFile>\n' % "\n".join(entries))
    with open(os.path.join(folder, "view.py"), "w", encoding="ascii") as file:
        file.write(VIEW)
    return os.path.join(folder, COLLECTION)
