"""The tank, bodies and instruments as the markers topic draws them."""

import numpy

from wavetank.meshes import triangles_of
from wavetank.web.packets import colour_of, finite, pack, rows_of

ADD, DELETE, DELETE_ALL = 0, 2, 3  # of visualization_msgs/Marker
MESH = 10


class Drawing:
    """What the messages that came have drawn, by group and number: the whole, which a message that erases first draws and which is heavy, and lines that later
    messages draw again and again, such as those of moorings."""

    def __init__(self):
        self._markers, self._lines, self._meshes = {}, {}, {}

    def follow(self, message):
        """A visualization_msgs/MarkerArray (read_tree). The kind of packet that has changed: "drawing" or "lines"."""
        whole = not self._markers
        for marker in message["markers"]:
            if marker["action"] == DELETE_ALL:
                whole = True
                self._markers.clear()
                self._lines.clear()
        for marker in message["markers"]:
            into, name = self._markers if whole else self._lines, (marker["ns"], marker["id"])
            if marker["action"] == ADD:
                into[name] = marker
            elif marker["action"] == DELETE:
                into.pop(name, None)
        return "drawing" if whole else "lines"

    def forget_lines(self):
        self._lines.clear()

    def packet(self, kind="drawing"):
        parts, arrays = [], {}
        for (group, number), marker in (self._markers if kind == "drawing" else self._lines).items():
            part = self._part(group, number, marker)
            points = rows_of(marker["points"]) if len(marker["points"]) else None
            if marker["type"] == MESH:
                points = self._mesh(marker["mesh_resource"])
            if points is not None:
                part["points"] = "points%d" % len(arrays)
                arrays[part["points"]] = points
            parts.append(part)
        return pack({"kind": kind, "parts": parts}, **arrays)

    def _part(self, group, number, marker):
        pose = marker["pose"]
        return {
            "group": group,
            "number": int(number),
            "type": int(marker["type"]),
            "body": body_of(marker["header"]["frame_id"]),
            "position": [finite(pose["position"][axis]) for axis in "xyz"],
            "turn": [finite(pose["orientation"][axis]) for axis in "xyzw"],
            "scale": [finite(marker["scale"][axis]) for axis in "xyz"],
            "colour": colour_of(marker),
            "text": marker["text"],
        }

    def _mesh(self, uri):
        """Read once."""
        if uri not in self._meshes:
            self._meshes[uri] = triangles_of(uri)
        return self._meshes[uri]


def body_of(frame):
    """The body that a marker moves with, "" of what stays in the tank's frame."""
    return frame.rpartition("/bodies/")[2] if "/bodies/" in frame else ""


def pose_numbers(position, turn):
    """None of what is no number: JavaScript reads no such JSON."""
    numbers = [float(value) for value in [*position, *turn]]
    return numbers if numpy.isfinite(numbers).all() else None
