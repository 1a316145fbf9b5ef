"""Mesh files that a drawing names by package://, as triangles: STL in both its forms, and the faces of OBJ. Of others the page has the edges."""

import os
import struct

import numpy

LARGEST = 64 * 1024 * 1024  # bytes


def triangles_of(uri):
    """Corners, a row x y z each and three a triangle, in the file's own units; None if it cannot be read."""
    path = path_of(uri)
    reader = {".stl": read_stl, ".obj": read_obj}.get(os.path.splitext(uri)[1].lower())
    if path is None or reader is None:
        return None
    try:
        if os.path.getsize(path) > LARGEST:
            return None
        with open(path, "rb") as file:
            return reader(file.read())
    except (OSError, ValueError, IndexError, struct.error):
        return None


def path_of(uri):
    """A file of a package; a drawing of a bag from elsewhere is not to name any other, so nothing that leaves the package's folder."""
    package, _, name = uri[len("package://") :].partition("/")
    if not uri.startswith("package://") or ".." in name.split("/"):
        return None
    try:
        import rospkg

        return os.path.join(rospkg.RosPack().get_path(package), name)
    except Exception:  # of rospkg, which may also be missing
        return None


def read_stl(data):
    count = struct.unpack_from("<I", data, 80)[0] if len(data) >= 84 else -1
    if len(data) == 84 + 50 * count:
        kind = numpy.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("more", "<u2")])
        return numpy.frombuffer(data, kind, count, 84)["corners"].reshape(-1, 3)
    words = [line.split() for line in data.decode("ascii", "replace").lower().splitlines()]
    return corners([[float(word) for word in line[1:4]] for line in words if line[:1] == ["vertex"]])


def read_obj(data):
    places, found = [], []
    for line in data.decode("utf-8", "replace").splitlines():
        words = line.split()
        if words[:1] == ["v"]:
            places.append([float(word) for word in words[1:4]])
        elif words[:1] == ["f"]:
            numbers = [int(word.split("/")[0]) for word in words[1:]]
            face = [places[number - 1 if number > 0 else number] for number in numbers]
            for n in range(1, len(face) - 1):
                found += [face[0], face[n], face[n + 1]]
    return corners(found)


def corners(rows):
    if not rows or len(rows) % 3:
        raise ValueError
    return numpy.array(rows, "<f4")
