"""Where a picture is taken from."""

import glob
import os
import re

import numpy
import yaml

from wavetank import Failure
from wavetank.meshes import package_path

ANGLE = 45.0  # degrees, from the lower to the upper edge, as rviz has it
FIXED = "<Fixed Frame>"  # of rviz, as the frame that a view follows: the one that it is drawn in


class Camera:
    """eye, target: m, in the tank's frame, or the world's if in_world. up: a direction. is_flat: without perspective, as drawings of a section are."""

    def __init__(self, eye, target, in_world=False, up=(0.0, 0.0, 1.0)):
        self.eye, self.target, self.in_world, self.up, self.is_flat = numpy.array(eye, float), numpy.array(target, float), in_world, up, False


def from_rviz(path):
    """Of a view of rviz that orbits."""
    try:
        with open(path, encoding="utf-8") as file:
            manager = yaml.safe_load(file)["Visualization Manager"]
        view = manager["Views"]["Current"]
        focus = numpy.array([float(view["Focal Point"][axis]) for axis in "XYZ"])
        options = manager.get("Global Options") or {}
        fixed, follows = options.get("Fixed Frame", "tank"), view.get("Target Frame", FIXED)
        yaw, pitch, distance = float(view["Yaw"]), float(view["Pitch"]), float(view["Distance"])
    except OSError as error:
        raise Failure("the view '%s' cannot be read: %s" % (path, error.strerror or error))
    except (yaml.YAMLError, KeyError, TypeError, ValueError, AttributeError):
        raise Failure("'%s' holds no view of rviz that orbits about a point (Class: rviz/Orbit)" % path)
    direction = numpy.array([numpy.cos(yaw) * numpy.cos(pitch), numpy.sin(yaw) * numpy.cos(pitch), numpy.sin(pitch)])
    if follows not in (FIXED, fixed, "", None):
        raise Failure("the view '%s' follows the frame '%s', which cannot be drawn: let its Target Frame be %s" % (path, follows, FIXED))
    return Camera(focus + distance * direction, focus, in_world=fixed == "world")


def views():
    """The package's views by name."""
    folder = package_path("package://wavetank/config/rviz")
    return {os.path.splitext(os.path.basename(path))[0]: path for path in sorted(glob.glob(os.path.join(folder, "*.rviz")))} if folder else {}


def find_view(name):
    """A file, or one of the package's views by its name."""
    if os.path.exists(name) or name.endswith(".rviz"):
        return name
    known = views()
    if name not in known:
        raise Failure("there is no view '%s': give a file of rviz, or one of %s" % (name, ", ".join(known) or "those of the package wavetank"))
    return known[name]


def view_of(title):
    """The view of the package's case that has this title, or None."""
    for name, path in views().items():
        case = os.path.join(os.path.dirname(os.path.dirname(path)), name + ".yaml")
        if os.path.isfile(case):
            with open(case, encoding="utf-8") as file:
                found = re.search(r"^title:\s*(.*?)\s*(#.*)?$", file.read(), re.MULTILINE)
            if found and title and found.group(1).strip("'\"") == title:
                return path
    return None


def fitting(low, high, dimensions, aspect):
    """That sees all of a box; from a side in 2-D, from above and a side in 3-D."""
    low, high = numpy.array(low, float), numpy.array(high, float)
    middle, half = (low + high) / 2, numpy.maximum((high - low) / 2, 1e-6)
    tangent = numpy.tan(numpy.radians(ANGLE / 2))
    if dimensions == 2:
        distance = max(1.25 * half[2] / tangent, 1.12 * half[0] / tangent / aspect)
        middle[2] -= 0.1 * distance * tangent  # clock and scale have their place below
        return Camera(middle - [0, distance, 0], middle)
    yaw, pitch = 4.35, 0.42  # as the views of the demos have them
    direction = numpy.array([numpy.cos(yaw) * numpy.cos(pitch), numpy.sin(yaw) * numpy.cos(pitch), numpy.sin(pitch)])
    right = numpy.cross([0, 0, 1], direction)
    right /= numpy.linalg.norm(right)
    up = numpy.cross(direction, right)
    corners = numpy.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]) * half
    depth, wide, high_up = corners @ direction, numpy.abs(corners @ right), numpy.abs(corners @ up)
    distance = 1.06 * numpy.max(depth + numpy.maximum(wide / tangent / aspect, high_up / tangent))
    return Camera(middle + distance * direction, middle)
