"""Mesh files that a drawing names by package://, as triangles: STL in both its forms, and the faces of OBJ. Of others the page has the edges."""

import os
import stat
import struct

import numpy

LARGEST = 64 * 1024 * 1024  # bytes


def triangles_of(uri):
    """Corners, a row x y z each and three a triangle, in the file's own units; None if it cannot be read."""
    path = package_path(uri)
    reader = {".stl": read_stl, ".obj": read_obj}.get(os.path.splitext(uri)[1].lower())
    if path is None or reader is None:
        return None
    try:
        triangles = reader(content_of(path))
    except (OSError, ValueError, IndexError, struct.error):
        return None
    return triangles if numpy.isfinite(triangles).all() else None


def content_of(path):
    """Of a plain file; a pipe would never end. Raises OSError, or ValueError of what is not to be read."""
    with open(os.open(path, os.O_RDONLY | os.O_NONBLOCK), "rb") as file:
        status = os.fstat(file.fileno())
        if not stat.S_ISREG(status.st_mode) or status.st_size > LARGEST:
            raise ValueError
        return file.read()


def package_path(uri):
    """Of a package:// address, or None where the package is not known here. A drawing of a bag from elsewhere is not to name anything outside the package's
    folder, whatever slashes, dots and links lead there."""
    package, _, name = uri[len("package://") :].partition("/")
    if not uri.startswith("package://"):
        return None
    try:
        import rospkg

        root = os.path.realpath(rospkg.RosPack().get_path(package))
        path = os.path.realpath(os.path.join(root, name))
        return path if os.path.commonpath([root, path]) == root else None
    except Exception:  # of rospkg, which may also be missing; of a name that is none
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
            if 0 in numbers:
                raise ValueError
            face = [places[number - 1 if number > 0 else number] for number in numbers]
            for n in range(1, len(face) - 1):
                found += [face[0], face[n], face[n + 1]]
    return corners(found)


def corners(rows):
    if not rows or len(rows) % 3:
        raise ValueError
    return numpy.array(rows, "<f4")
