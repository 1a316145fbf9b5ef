"""Cases made from a case: with one of its bodies held, moved as told, or let go from another place."""

import copy
import math
import os

import numpy
import yaml

from wavetank import Failure
from wavetank.rotations import angles_of_matrix, matrix_of, turn_about
from wavetank.runs import local_path, named_files, read_case, read_yaml

SHIFTS, TURNS = ("surge", "sway", "heave"), ("roll", "pitch", "yaw")
DIRECTIONS = SHIFTS + TURNS
OF_MOTION = ("velocity", "angular_velocity", "prescribed", "command", "forces", "moorings", "water_film", "wind")  # keys of a body that go with its motion
RATES = ("gauge_rate", "wrench_rate", "energy_rate", "flow_rate", "imu_rate")
LEAST_RATE = 100.0  # Hz, of what is sampled


def set_key(tree, key, value):
    """As --set of wavetank_run: key with slashes, entries of lists by number."""
    *path, last = key.split("/")
    for part in path:
        tree = tree[int(part)] if isinstance(tree, list) else tree.setdefault(part, {})
    if isinstance(tree, list):
        if int(last) == len(tree):
            tree.append(value)
        else:
            tree[int(last)] = value
    else:
        tree[last] = value


def absorbing_gauges(tree):
    """Names of the gauges by which paddles absorb."""
    if isinstance(tree, dict):
        absorption = tree.get("absorption")
        if isinstance(absorption, dict):
            yield absorption.get("gauge")
    for value in tree.values() if isinstance(tree, dict) else tree if isinstance(tree, list) else ():
        yield from absorbing_gauges(value)


class BodyCase:
    """A case and one of its bodies. Raises Failure for what cannot be moved."""

    def __init__(self, path, name, settings=()):
        self.path, self.name = path, name
        self.tree = read_case(path)
        for key, text in settings:
            self._set(key, text)
        for section, key in named_files(self.tree):
            local = local_path(section[key], path)
            if local:
                section[key] = os.path.abspath(local)
        bodies = self.tree.get("bodies") or []
        names = [body.get("name") for body in bodies]
        if name not in names:
            raise Failure(
                "the case '%s' has no body '%s'%s%s"
                % (path, name, ", only " + ", ".join(map(str, names)) if names else "", "; links of robots cannot be chosen" if self.tree.get("robots") else "")
            )
        self.index = names.index(name)
        for joint in self.tree.get("joints") or []:
            if name in (joint.get("parent"), joint.get("child")):
                raise Failure("the body '%s' hangs on the joint '%s', which would hold it: leave the joint out of the case" % (name, joint.get("name")))
        self.dimensions = self.tree.get("dimensions", 3)

    def _set(self, key, text):
        try:
            if key in ("fluid/spacing", "fluid/particles"):
                for other in ("spacing", "particles"):
                    self.tree.setdefault("fluid", {}).pop(other, None)
            set_key(self.tree, key, read_yaml(text))
        except (AttributeError, IndexError, KeyError, TypeError, ValueError, yaml.YAMLError):
            raise Failure("--set %s=%s does not fit the case '%s'" % (key, text, self.path))

    def density(self):
        """Of the water at rest, kg/m³."""
        return float((self.tree.get("fluid") or {}).get("density", 1000.0))

    @property
    def body(self):
        return self.tree["bodies"][self.index]

    def check_direction(self, direction):
        if self.dimensions == 2 and direction in ("sway", "roll", "yaw"):
            raise Failure("in two dimensions there are surge, heave and pitch, but no %s" % direction)

    def changed(self, motion, duration, spacing=None):
        """A copy of the tree whose body has this motion and no keys of another, ready to be added to."""
        tree = copy.deepcopy(self.tree)
        body = tree["bodies"][self.index]
        for key in OF_MOTION:
            body.pop(key, None)
        body["motion"] = motion
        tree["duration"] = duration
        if spacing is not None:
            fluid = tree.setdefault("fluid", {})
            fluid.pop("particles", None)
            fluid["spacing"] = spacing
        return tree

    def body_in(self, tree):
        return tree["bodies"][self.index]

    def centre(self, needed=True):
        """Of the body, m, x y z: its centre of mass as given, its box's middle, or its shape's origin; of a mesh file it is not known."""
        body = self.body
        if "centre_of_mass" in body:
            return self._point(body["centre_of_mass"])
        if "box" in body:
            return 0.5 * (self._point(body["box"]["min"]) + self._point(body["box"]["max"]))
        if str(body.get("mesh", "")).startswith("shape://"):
            return self._point(body.get("translation", [0, 0, 0]))
        if needed:
            raise Failure("where the middle of the body '%s' is, its mesh does not tell: give bodies/%d/centre_of_mass" % (self.name, self.index))
        return None

    def _point(self, values):
        values = [float(value) for value in values]
        return numpy.array([values[0], 0.0, values[1]] if len(values) == 2 else values)

    def _listed(self, point):
        return [float(point[0]), float(point[2])] if self.dimensions == 2 else [float(value) for value in point]

    def displace(self, tree, direction, amount):
        """Moves the body of a tree along or, by rad, about an axis through its middle."""
        body = self.body_in(tree)
        if direction in SHIFTS:
            shift = numpy.zeros(3)
            shift[SHIFTS.index(direction)] = amount
            self._shift(body, shift)
        else:
            self._turn(body, turn_about(TURNS.index(direction), amount))

    def _shift(self, body, shift):
        if "box" in body:
            body["box"] = {corner: self._listed(self._point(body["box"][corner]) + shift) for corner in ("min", "max")}
        else:
            body["translation"] = [float(value) for value in self._point(body.get("translation", [0, 0, 0])) + shift]
        if "centre_of_mass" in body:
            body["centre_of_mass"] = self._listed(self._point(body["centre_of_mass"]) + shift)
        for part in body.get("collision_parts", []):
            part["translation"] = [float(value) for value in self._point(part.get("translation", [0, 0, 0])) + shift]

    def _turn(self, body, turn):
        centre = self.centre()
        if "box" in body:
            low, high = (self._point(body["box"][corner]) for corner in ("min", "max"))
            size = high - low
            if self.dimensions == 2:
                size[1] = max(size)
            del body["box"]
            body["mesh"] = "shape://box?size=%.12g,%.12g,%.12g" % tuple(size)
            body["translation"] = [float(value) for value in 0.5 * (low + high)]
        for placed in [body] + body.get("collision_parts", []):
            at = self._point(placed.get("translation", [0, 0, 0]))
            before = matrix_of(numpy.radians([float(angle) for angle in placed.get("rotation", [0, 0, 0])]))
            placed["rotation"] = [float(angle) for angle in numpy.degrees(angles_of_matrix(turn @ before))]
            placed["translation"] = [float(value) for value in centre + turn @ (at - centre)]
        if "inertia" in body and isinstance(body["inertia"], list) and len(body["inertia"]) == 6:
            xx, yy, zz, xy, xz, yz = body["inertia"]
            turned = turn @ numpy.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]) @ turn.T
            body["inertia"] = [float(turned[at]) for at in ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2))]

    def sample(self, tree, rate):
        """Sees to it that forces and poses are sampled so often, Hz, and that nothing else is, but for gauges by which other bodies' paddles absorb."""
        instruments = tree.setdefault("instruments", {})
        rate = math.ceil(max(rate, LEAST_RATE))
        instruments["rate"] = rate
        instruments["pose_rate"] = rate
        gauges, needed = instruments.get("wave_gauges") or [], set(absorbing_gauges(tree))
        for key in RATES + ("pressure_probes", "velocity_probes", "sections", "wave_gauges"):  # a probe on the body would not move with its start
            instruments.pop(key, None)
        if needed:
            instruments["wave_gauges"] = [gauge for gauge in gauges if gauge.get("name") in needed]
        for body in tree["bodies"]:
            body.pop("imu", None)

    def held(self, direction, amount, duration, spacing):
        tree = self.changed("fixed", duration, spacing)
        self.displace(tree, direction, amount)
        self.sample(tree, LEAST_RATE)
        return tree

    def oscillating(self, direction, amplitude, period, rise, duration, spacing):
        """amplitude in m or rad."""
        tree = self.changed("prescribed", duration, spacing)
        harmonic = {"direction": direction, "amplitude": amplitude if direction in SHIFTS else math.degrees(amplitude), "frequency": 1.0 / period, "rise": rise}
        self.body_in(tree)["prescribed"] = {"harmonics": [harmonic]}
        self.sample(tree, 100.0 / period)
        return tree

    def check_released(self):
        if not {"mass", "density"} & set(self.body):
            raise Failure("to be let go, the body '%s' needs a mass or a density: bodies/%d/mass" % (self.name, self.index))

    def released(self, direction, displacement, duration, spacing):
        tree = self.changed("free", duration, spacing)
        self.displace(tree, direction, displacement)
        self.sample(tree, LEAST_RATE)
        return tree

    def towed(self, direction, record, duration, spacing):
        """record: a file of times and of the way along the direction, m."""
        tree = self.changed("prescribed", duration, spacing)
        self.body_in(tree)["prescribed"] = {"records": [{"file": record, "time_column": "time", "column": direction, "direction": direction}]}
        self.sample(tree, LEAST_RATE)
        return tree
