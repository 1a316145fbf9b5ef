"""What a case tells about body and tank: sizes by wavetank_run --check, how much of the tank the body takes, and when waves come back from its ends."""

import re
import subprocess

import numpy

from wavetank import Failure
from wavetank.linear_waves import GRAVITY, group_speed
from wavetank.runs import TEXT, find_program


class TankFacts:
    """tank and body: extents x y z (m; y of 2-D is 1); depth: least depth of the water, m; spacing, m; mass: of the body, kg, or None."""

    def __init__(self, case, path):
        self._case = case
        report = checked(path)
        self.tank = self._extents(report, "tank")
        self.body = self._extents(report, "body " + case.name)
        self.depth = number_in(report, r"least depth +([\d.e+-]+) m")
        self.spacing = number_in(report, r"particles .*spacing ([\d.e+-]+) m")
        mass = re.search(r"^body %s .*?, ([\d.e+-]+) kg" % re.escape(case.name), report, re.M)
        self.mass = float(mass.group(1)) if mass else None
        gravity = numpy.linalg.norm([float(value) for value in case.tree.get("gravity", [0, 0, -GRAVITY])])
        self.gravity = float(gravity)

    def _extents(self, report, owner):
        found = re.search(r"^%s +((?:[\d.e+-]+ × )+[\d.e+-]+) m" % re.escape(owner), report, re.M)
        if not found:
            raise Failure("wavetank_run --check does not tell the size of the %s" % owner)
        sizes = [float(size) for size in found.group(1).split(" × ")]
        return numpy.array([sizes[0], 1.0, sizes[1]] if len(sizes) == 2 else sizes)

    def across(self, axis):
        """The body's section across an axis (0, 1, 2) of its box, and the water's, m² (2-D: m)."""
        water = numpy.array([self.tank[0], self.tank[1], self.depth])
        body = numpy.minimum(self.body, [numpy.inf, numpy.inf, self.depth])
        others = [each for each in range(3) if each != axis and not (each == 1 and self._case.dimensions == 2)]
        return float(numpy.prod(body[others])), float(numpy.prod(water[others]))

    def has_waves(self):
        return self.gravity > 0 and not self._case.tree["tank"].get("box", {}).get("closed", False)

    def to_the_ends(self):
        """The least distance of the body's sides from the tank's ends that are not periodic, m, and whether it is known where the body is; infinite without
        such ends."""
        periodic = self._case.tree["tank"].get("periodic") or []
        centre = self._case.centre(needed=False)
        box = self._case.tree["tank"].get("box")
        distances = []
        for axis, name in ((0, "x"), (1, "y")):
            if name in periodic or (axis == 1 and self._case.dimensions == 2):
                continue
            middle = 0.5 * self.tank[axis]
            if box is not None and centre is not None:
                middle = centre[axis] - origin_of(box)[axis]
            distances.append(min(middle, self.tank[axis] - middle) - 0.5 * self.body[axis])
        return min(distances, default=float("inf")), box is not None and centre is not None

    def free_way(self, axis, sign):
        """How far the body can go along an axis before it meets the tank's end, m, or None where that is not known."""
        centre, box = self._case.centre(needed=False), self._case.tree["tank"].get("box")
        if centre is None or box is None:
            return None
        from_low = centre[axis] - origin_of(box)[axis]
        return float((self.tank[axis] - from_low if sign > 0 else from_low) - 0.5 * self.body[axis])

    def waves_return(self, period):
        """s, after which the energy of waves of the period that the body makes is back from the tank's nearest end; infinite without."""
        distance, _ = self.to_the_ends()
        return 2 * distance / group_speed(1.0 / period, self.depth, self.gravity) if self.has_waves() else float("inf")


def origin_of(box):
    origin = [float(value) for value in box.get("origin", [0, 0, 0])]
    return [origin[0], 0.0, origin[1]] if len(origin) == 2 else origin


def checked(path):
    """The report of wavetank_run --check."""
    done = subprocess.run([find_program(), "--check", path], stdout=subprocess.PIPE, stderr=subprocess.PIPE, **TEXT)
    if done.returncode != 0:
        lines = done.stderr.strip().splitlines() or ["it ends with exit code %d" % done.returncode]
        raise Failure("wavetank_run does not take the case: %s" % lines[-1].replace("wavetank_run: ", "", 1))
    return done.stdout


def number_in(report, pattern):
    found = re.search(pattern, report)
    if not found:
        raise Failure("wavetank_run --check does not tell what '%s' looks for" % pattern.split(" ")[0])
    return float(found.group(1))
