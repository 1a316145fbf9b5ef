"""Measures by which a simulated record is held against a reference, and what the comparisons of this directory share: reading, tables, pictures."""

import csv
import importlib.machinery
import importlib.util
import math
import os
import sys

import numpy

SCRIPTS = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "scripts")
MESHES = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "meshes")


class Failure(Exception):
    """Something the user can put right; its text is one sentence."""


class Record:
    """One quantity against time, s. Times that are given twice count once, with the mean of their values: digitised curves have them."""

    def __init__(self, times, values):
        times, values = numpy.asarray(times, dtype=float), numpy.asarray(values, dtype=float)
        if len(times) != len(values):
            raise ValueError("%d times for %d values" % (len(times), len(values)))
        known = numpy.isfinite(times) & numpy.isfinite(values)
        self.times, place = numpy.unique(times[known], return_inverse=True)
        self.values = numpy.bincount(place, values[known]) / numpy.bincount(place) if len(place) else numpy.zeros(0)

    def at(self, times):
        """Joined by straight lines; held at the ends."""
        return numpy.interp(times, self.times, self.values)

    def between(self, begin, end):
        inside = (self.times >= begin) & (self.times <= end)
        return Record(self.times[inside], self.values[inside])

    def scaled(self, factor=1.0, offset=0.0):
        return Record(self.times, factor * self.values + offset)


def common_range(ours, reference, begin=-math.inf, end=math.inf):
    """The part of [begin, end] that both records cover; refuses one that holds less than two of the reference's times."""
    begin = max(begin, ours.times[0], reference.times[0])
    end = min(end, ours.times[-1], reference.times[-1])
    if len(reference.between(begin, end).times) < 2:
        raise Failure("the simulated record, %g to %g s, does not reach over the reference's" % (ours.times[0], ours.times[-1]))
    return begin, end


def rms_error(ours, reference, begin=-math.inf, end=math.inf):
    """Root of the mean square of the difference at the reference's times, in the values' unit."""
    part = reference.between(*common_range(ours, reference, begin, end))
    return float(numpy.sqrt(numpy.mean((ours.at(part.times) - part.values) ** 2)))


def relative_error(ours, reference, begin=-math.inf, end=math.inf):
    """rms_error over the reference's range from least to greatest value."""
    begin, end = common_range(ours, reference, begin, end)
    return rms_error(ours, reference, begin, end) / float(numpy.ptp(reference.between(begin, end).values))


def correlation(ours, reference, begin=-math.inf, end=math.inf):
    """Pearson's, at the reference's times."""
    part = reference.between(*common_range(ours, reference, begin, end))
    return float(numpy.corrcoef(ours.at(part.times), part.values)[0, 1])


def peak_to_peak(record, begin=-math.inf, end=math.inf):
    return float(numpy.ptp(record.between(begin, end).values))


def impulse(record, begin, end):
    """Integral over [begin, end], its ends interpolated."""
    inside = record.times[(record.times > begin) & (record.times < end)]
    times = numpy.concatenate([[begin], inside, [end]])
    values = record.at(times)
    return float(numpy.sum(0.5 * (values[1:] + values[:-1]) * numpy.diff(times)))


def running_mean(record, window):
    """Over `window` seconds about each of the record's own times that lie half of it from its ends."""
    sums = numpy.concatenate([[0.0], numpy.cumsum(0.5 * (record.values[1:] + record.values[:-1]) * numpy.diff(record.times))])
    times = record.between(record.times[0] + 0.5 * window, record.times[-1] - 0.5 * window).times
    until = Record(record.times, sums)
    return Record(times, (until.at(times + 0.5 * window) - until.at(times - 0.5 * window)) / window)


def peak(record, about, within):
    """Time and height of the greatest value not farther than `within` from `about`; nan where the record has none there."""
    part = record.between(about - within, about + within)
    if not len(part.times):
        return math.nan, math.nan
    greatest = int(numpy.argmax(part.values))
    return float(part.times[greatest]), float(part.values[greatest])


def crossings(record, level=0.0):
    """Times at which the record goes through a level, interpolated."""
    side = numpy.sign(record.values - level)
    side[side == 0] = 1
    found = numpy.nonzero(side[1:] != side[:-1])[0]
    return [
        float(record.times[i] + (level - record.values[i]) * (record.times[i + 1] - record.times[i]) / (record.values[i + 1] - record.values[i])) for i in found
    ]


def mean(record, begin, end):
    """Over time, not over samples."""
    return impulse(record, begin, end) / (end - begin)


class Table:
    """Figures beside their references. A figure with a bar is met or not; `failed` tells whether one was not."""

    def __init__(self):
        self.rows = []
        self.failed = False

    def add(self, figure, reference, ours, error, bar=None, met=None):
        """Reference, ours, error and bar as text."""
        verdict = "" if met is None else "yes" if met else "NO"
        self.failed = self.failed or (met is not None and not met)
        self.rows.append([figure, reference, ours, error, bar or "", verdict])

    def print(self):
        heads = ["figure", "reference", "ours", "error", "bar", "met"]
        widths = [max(len(row[k]) for row in [heads] + self.rows) for k in range(len(heads))]
        for row in [heads, ["-" * width for width in widths]] + self.rows:
            print("| " + " | ".join(cell.ljust(width) for cell, width in zip(row, widths)) + " |")
        sys.stdout.flush()


def read_record(path, column=None, time_column="time_s"):
    """A column of a file of comma-separated values with one line of names; the second one unless it is named."""
    try:
        with open(path, newline="") as file:
            rows = [row for row in csv.reader(file) if row and not row[0].startswith("#")]
    except OSError as error:
        raise Failure("the record '%s' cannot be read: %s" % (path, error.strerror))
    names = [name.strip() for name in rows[0]] if rows else []
    column = column or (names[1] if len(names) > 1 else "")
    for name in (time_column, column):
        if name not in names:
            raise Failure("the record '%s' has no column '%s', only %s" % (path, name, ", ".join(names)))
    try:
        return Record(*([float(row[names.index(name)]) for row in rows[1:]] for name in (time_column, column)))
    except (ValueError, IndexError):
        raise Failure("the record '%s' holds a line without numbers for %s and %s" % (path, time_column, column))


def load_script(name):
    """A script of scripts/, which has no suffix, as a module."""
    sys.dont_write_bytecode = True
    loader = importlib.machinery.SourceFileLoader(name, os.path.join(SCRIPTS, name))
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader(name, loader))
    loader.exec_module(module)
    return module


def read_series(bag, kind):
    """Pressures or levels of a bag as records by name."""
    found = load_script("plot_probes").read_bag(bag, None)
    return {series.name: Record(series.times, series.values) for series in getattr(found, kind)}


def read_mesh(body):
    """The triangles of a body that is a binary STL of this package, scaled, about the mesh's origin: an array of triangles, corners, coordinates (m)."""
    with open(os.path.join(MESHES, os.path.basename(body["mesh"])), "rb") as file:
        content = file.read()
    triangle = numpy.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
    count = int(numpy.frombuffer(content, "<u4", 1, 80)[0])
    return body.get("scale", 1.0) * numpy.frombuffer(content, triangle, count, 84)["corners"].astype(float)


def volume_of(triangles):
    return float(numpy.linalg.det(triangles).sum() / 6.0)


def depth_inside(triangles, points):
    """How deep points are inside a convex mesh, m: the least distance to its planes from within; negative outside."""
    normals = numpy.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
    normals /= numpy.linalg.norm(normals, axis=1, keepdims=True)
    heights = numpy.sum(normals * triangles[:, 0], axis=1)
    return (heights - points.dot(normals.T)).min(axis=1)


def rotated(quaternions, vectors):
    """Vectors turned by quaternions, rows x y z w; either may be a single row."""
    axis, real = quaternions[..., :3], quaternions[..., 3:]
    first = 2.0 * numpy.cross(axis, vectors)
    return vectors + real * first + numpy.cross(axis, first)


def read_motions(bag):
    return load_script("plot_motion").read_motions(bag)


def read_status(bag):
    """Records of the fluid's energies (J), mass (kg) and greatest speed (m/s) by the message's names, from the bag's status messages."""
    from wavetank import read_tables

    status = read_tables(bag, wanted=lambda name: name == "status")["status"].columns
    return {name: Record(status["simulated_time"], column) for name, column in status.items()}


def draw(path, panels):
    """panels: (title, unit, [(label, record, style)], (begin, end) or None), one above the other. A style is a colour, or one with a marker as 'ko'."""
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as pyplot

    figure, axes = pyplot.subplots(len(panels), 1, figsize=(10, 2.6 * len(panels) + 0.4), squeeze=False)
    for axis, (title, unit, curves, limits) in zip(axes[:, 0], panels):
        for label, record, style in curves:
            axis.plot(record.times, record.values, style, linewidth=1.1, markersize=4, label=label)
        axis.set_title(title, fontsize=9)
        axis.set_ylabel(unit)
        axis.grid(alpha=0.25, linewidth=0.6)
        axis.legend(fontsize=7)
        if limits:
            axis.set_xlim(*limits)
    axes[-1, 0].set_xlabel("simulated time (s)")
    figure.tight_layout()
    try:
        figure.savefig(path, dpi=110)
    except (OSError, ValueError) as error:
        raise Failure("the picture '%s' cannot be written: %s" % (path, error))
    pyplot.close(figure)
    print("wrote '%s'" % path)
