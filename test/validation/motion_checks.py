#!/usr/bin/env python3
"""Holds free bodies against what must be: Archimedes, linear theory, the conservation of energy, walls that hold.

motion_checks.py floating BAG PICTURE DENSITY SPACING   a box at rest: draught and drift (config/validation/floating_box_2d.yaml)
motion_checks.py heave BAG PICTURE DISPLACEMENT         the same box let go DISPLACEMENT (m) too high: the period of its bobbing
motion_checks.py entry BAG PICTURE PARTICLES            a ball that falls into water (config/water_entry.yaml); PARTICLES: of watch_particles.py
motion_checks.py pile BAG PICTURE                       bodies in the way of a dam break (config/ten_bodies.yaml)
motion_checks.py submerged BAG PICTURE                  a fixed cube under water: Archimedes' force (config/validation/submerged_cube.yaml)
"""

import csv
import math
import os
import sys

import numpy
import yaml

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import compare_motion as compare  # noqa: E402
from linear_heave import LinearHeave  # noqa: E402

GRAVITY = 9.81  # m/s²


def case_of(bag):
    """The case as it was run, every default filled in."""
    from wavetank.recording import Recording

    case = yaml.safe_load(Recording(bag).text("case") or "")
    if not case:
        raise compare.Failure("'%s' does not hold its case" % bag)
    return case


def percent(part):
    return "%+.2f %%" % (100 * part)


def box_of(body):
    return numpy.array([body["box"]["min"], body["box"]["max"]], dtype=float)


def size_in_plane(body):
    low, high = box_of(body)
    return float(high[0] - low[0]), float(high[-1] - low[-1])


def water_area(case):
    """Of a 2-D tank that is filled from end to end with a box of water, less what a box afloat takes, m²."""
    low, high = (numpy.array(case["fluid"]["fill"][0]["box"][key], dtype=float) for key in ("min", "max"))
    (body_low, body_high), level = box_of(case["bodies"][0]), high[-1]
    immersed = min(max(level - body_low[-1], 0.0), body_high[-1] - body_low[-1])
    return float((high[0] - low[0]) * (level - low[-1]) - (body_high[0] - body_low[0]) * immersed)


def draught_of(case, height_of_centre):
    """From the height of the box's centre, by the volume of the water: a level read off the particles would be uncertain by half a spacing itself."""
    breadth, height = size_in_plane(case["bodies"][0])
    length = case["tank"]["box"]["size"][0]
    bottom = height_of_centre - 0.5 * height
    # water = length · level − breadth · (level − bottom)
    level = (water_area(case) - breadth * bottom) / (length - breadth)
    return level - bottom


def floating(bag, picture, table, density, spacing):
    density, spacing = float(density), float(spacing)
    case, motion = case_of(bag), compare.read_motions(bag)["box"]
    breadth, height = size_in_plane(case["bodies"][0])
    expected = density / case["fluid"]["density"] * height
    heights, tilt = compare.Record(motion.times, motion.values("z")), compare.Record(motion.times, motion.values("pitch"))
    draughts = compare.Record(motion.times, [draught_of(case, z) for z in heights.values])
    end = heights.times[-1]
    ours = compare.mean(draughts, 0.5 * end, end)
    error = ours - expected
    name = "density ratio %g: " % (density / case["fluid"]["density"])
    light = expected < 3 * spacing  # so light a box need only stay where it is
    table.add(
        name + "draught", "%.1f mm" % (1e3 * expected), "%.2f mm" % (1e3 * ours), "%+.2f spacings" % (error / spacing), "0.5 spacings",
        None if light else abs(error) <= 0.5 * spacing,
    )  # fmt: skip
    drift = (compare.mean(draughts, 0.75 * end, end) - compare.mean(draughts, 0.25 * end, 0.5 * end)) / expected
    table.add(name + "drift of the mean draught to the last quarter from the second", "0", percent(drift), "", "1 %", None if light else abs(drift) < 0.01)
    late = heights.between(0.25 * end, end).values
    table.add(name + "height, standard deviation", "0", "%.3f mm" % (1e3 * late.std()), "")
    greatest = float(numpy.abs(tilt.values).max())
    table.add(name + "greatest tilt", "0", "%.2f deg" % greatest, "", "5 deg", greatest < 5)
    table.add(
        name + "greatest change of height", "0", "%.2f spacings" % (numpy.ptp(heights.values) / spacing), "", "1 spacing", numpy.ptp(heights.values) < spacing
    )
    x = motion.values("x")
    table.add(name + "drift along the tank", "0", "%.2f mm in %.0f s" % (1e3 * (x[-1] - x[0]), end), "")
    return [
        (name + "draught", "m", [("Archimedes", compare.Record([0, end], [expected] * 2), "k"), ("wavetank", draughts, "C0")], None),
        (name + "tilt", "deg", [("wavetank", tilt, "C0")], None),
    ]


def heave(bag, picture, table, displacement):
    case, motion = case_of(bag), compare.read_motions(bag)["box"]
    breadth, height = size_in_plane(case["bodies"][0])
    ratio = case["bodies"][0]["density"] / case["fluid"]["density"]
    length = case["tank"]["box"]["size"][0]
    depth = (water_area(case) + breadth * ratio * height) / length  # once the box is at rest
    # Let go so much out of its draught, of which the level's fall takes a part.
    raised = float(displacement) * (1 - breadth / length)
    # The theory's grid: the depth, which the box lifts a little, rounded to it.
    cell = 0.005
    theory = LinearHeave(breadth, ratio * height, length, cell * round(depth / cell), cell, case["fluid"]["density"], GRAVITY)
    expected = compare.Record(*theory.decay(raised, 4.0))
    rest = depth - ratio * height + 0.5 * height
    ours = compare.Record(motion.times, motion.values("z") - rest)
    wanted, found = (compare.crossings(record)[:3] for record in (expected, ours))
    table.add("mass and added mass of the box without waves", "", "%.1f + %.1f kg/m" % (theory.mass, theory.added_mass), "")
    table.add("period by these without waves", "%.3f s" % theory.period_without_waves(), "", "")
    if len(found) < 3:
        table.add("period of linear theory with the tank's waves", "%.3f s" % (wanted[2] - wanted[0]), "it does not swing so often", "", "5 %", False)
    else:
        error = (found[2] - found[0]) / (wanted[2] - wanted[0]) - 1
        table.add(
            "period, first to third passage of rest",
            "%.3f s" % (wanted[2] - wanted[0]),
            "%.3f s" % (found[2] - found[0]),
            percent(error),
            "5 %",
            abs(error) <= 0.05,
        )
        half, our_half = 2 * (wanted[1] - wanted[0]), 2 * (found[1] - found[0])
        table.add("twice the time from the first to the second", "%.3f s" % half, "%.3f s" % our_half, percent(our_half / half - 1))
        for number in range(3):
            table.add("passage %d of rest" % (number + 1), "%.3f s" % wanted[number], "%.3f s" % found[number], "%+.3f s" % (found[number] - wanted[number]))
    first_swing = [record.between(0, wanted[1]).values.min() / raised for record in (expected, ours)]
    table.add("depth of the first swing over the start", "%.3f" % first_swing[0], "%.3f" % first_swing[1], "")
    return [("height over rest", "m", [("linear theory", expected, "k"), ("wavetank", ours, "C0")], (0, min(4.0, ours.times[-1])))]


def entry(bag, picture, table, particles):
    case, motion, status = case_of(bag), compare.read_motions(bag)["ball"], compare.read_status(bag)
    body = case["bodies"][0]
    radius, mass = 0.5 * body["scale"], body["density"] * compare.volume_of(compare.read_mesh(body))
    # Its moment of inertia to that of a sphere: it hardly turns.
    speeds = numpy.sum(motion.velocities**2, axis=1) + 0.4 * radius**2 * numpy.sum(motion.angular_velocities**2, axis=1)
    ball = compare.Record(motion.times, 0.5 * mass * speeds + mass * GRAVITY * motion.values("z"))
    times = status["kinetic_energy"].times
    # Without that of compression, which counts particles of a thin film too: they are stretched, but bear no tension and so store nothing.
    fluid = status["kinetic_energy"].values + status["potential_energy"].values
    whole = compare.Record(times, fluid + ball.at(times))
    start, brought = whole.values[0], mass * GRAVITY * (motion.values("z")[0] - motion.values("z").min())
    gained = float(whole.values.max() - start) / brought
    table.add("kinetic and potential energy gained, of the ball's fall of %.1f J" % brought, "0", percent(gained), "", "1 %", gained < 0.01)
    rises = whole.values - numpy.minimum.accumulate(whole.values)
    # Compression, which is left out, takes some per cent at the impact and gives them back.
    rise = float(rises.max()) / brought
    table.add("greatest rise of the energy from a value before", "0", percent(rise), "", "5 %", rise < 0.05)
    stretched = float(numpy.ptp(status["compression_energy"].values))
    table.add("range of the compression energy", "", "%.2f J" % stretched, "")
    with open(particles, newline="") as file:
        rows = [[float(cell) for cell in row] for row in list(csv.reader(file))[1:]]
    deepest = max((row[2] for row in rows), default=math.nan)
    spacing = case["fluid"]["spacing"]
    densities = [row[3] for row in rows] or [math.nan]
    table.add("least and greatest density of a particle", "1000", "%.0f to %.0f kg/m3" % (min(densities), max(densities)), "")
    # Between its poses, 10 ms apart, the ball is known to 0.3 mm when the water meets it with 100 m/s².
    table.add(
        "deepest particle inside the ball, %d looks" % len(rows), "none", "%.3f spacings" % (deepest / spacing), "", "0.02 spacings",
        len(rows) > 10 and deepest <= 0.02 * spacing,
    )  # fmt: skip
    heights = motion.values("z")
    lowest = [i for i in range(1, len(heights) - 1) if heights[i] < heights[i - 1] and heights[i] <= heights[i + 1]]
    if len(lowest) > 1:
        last = slice(lowest[-2], lowest[-1])
        level = afloat_level(case, body["density"] * compare.volume_of(compare.read_mesh(body)) / case["fluid"]["density"])
        found = float(heights[last].mean())
        table.add("mean height of its centre over the last swing", "%.3f m" % level, "%.3f m" % found, "%+.2f spacings" % ((found - level) / spacing))
    table.add("guard hits", "", "%d" % status["guard_hits"].values[-1], "")
    table.add("values that are no number", "0", "%d" % count_lost(motion), "", "0", count_lost(motion) == 0)
    energies = [("water and ball", whole.scaled(offset=-start), "k"), ("ball", ball.scaled(offset=-ball.values[0]), "C1")]
    energies.append(("water", compare.Record(times, fluid - fluid[0]), "C0"))
    height = compare.Record(motion.times, heights)
    return [("height of the ball's centre", "m", [("wavetank", height, "C0")], None), ("energy gained", "J", energies, None)]


def afloat_level(case, displaced):
    """Of the water in a box tank once a body takes so much of it (m³); a body half as heavy as water floats with its middle there."""
    fill = case["fluid"]["fill"][0]["box"]
    return fill["max"][2] + displaced / ((fill["max"][0] - fill["min"][0]) * (fill["max"][1] - fill["min"][1]))


def count_lost(motion):
    return int(numpy.sum(~numpy.isfinite(numpy.hstack([motion.positions, motion.quaternions, motion.velocities, motion.angular_velocities]))))


def corners_of(body):
    """Of a box, or of a mesh that is only scaled and shifted, about its centre of volume (m)."""
    if "box" in body:
        half = 0.5 * (box_of(body)[1] - box_of(body)[0])
        return numpy.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], dtype=float) * half
    triangles = compare.read_mesh(body)
    parts = numpy.linalg.det(triangles)[:, None]  # of the volume, each a tetrahedron with the origin
    centre = numpy.sum(parts * triangles.sum(axis=1), axis=0) / (4.0 * parts.sum())
    return numpy.unique(triangles.reshape(-1, 3), axis=0) - centre


def places_of(body, motion):
    """Of its corners at each pose, m."""
    return numpy.stack([motion.positions + compare.rotated(motion.quaternions, corner) for corner in corners_of(body)], axis=1)


def pile(bag, picture, table):
    case, motions, status = case_of(bag), compare.read_motions(bag), compare.read_status(bag)
    spacing = case["fluid"]["spacing"]
    low = numpy.array(case["tank"]["box"].get("origin", [0, 0, 0]), dtype=float)
    high = low + numpy.array(case["tank"]["box"]["size"], dtype=float)
    ends = [motion.times[-1] for motion in motions.values()]
    table.add("time simulated", "%g s" % case["duration"], "%.2f s" % min(ends), "", "all", min(ends) > case["duration"] - 0.05)
    lost = sum(count_lost(motion) for motion in motions.values())
    table.add("values that are no number", "0", "%d" % lost, "", "0", lost == 0)
    farthest, which = -math.inf, ""
    fastest = 0.0
    for body in case["bodies"]:
        motion = motions[body["name"]]
        points = places_of(body, motion)
        # Through the floor or a side; over the rim a body may go.
        outside = max(float((low - points).max()), float((points - high)[:, :, :2].max()))
        if outside > farthest:
            farthest, which = outside, body["name"]
        fastest = max(fastest, float(numpy.linalg.norm(motion.velocities, axis=1).max()))
    table.add("deepest corner in a wall (%s)" % which, "0", "%.2f spacings" % (farthest / spacing), "", "0.5 spacings", farthest < 0.5 * spacing)
    table.add("fastest body", "", "%.2f m/s" % fastest, "", "5 m/s", fastest < 5.0)
    late = max(float(numpy.linalg.norm(motion.velocities[motion.times > motion.times[-1] - 1.0], axis=1).max()) for motion in motions.values())
    table.add("fastest body in the last second", "", "%.2f m/s" % late, "")
    table.add("guard hits", "", "%d" % status["guard_hits"].values[-1], "")
    curves = [(name, compare.Record(motion.times, motion.values("x")), "C%d" % k) for k, (name, motion) in enumerate(motions.items())]
    heights = [(name, compare.Record(motion.times, motion.values("z")), "C%d" % k) for k, (name, motion) in enumerate(motions.items())]
    return [("x of the bodies", "m", curves, None), ("z of the bodies", "m", heights, None)]


def submerged(bag, picture, table):
    from wavetank.recording import Recording

    case = case_of(bag)
    side = numpy.diff(box_of(case["bodies"][0]), axis=0)[0]
    expected = case["fluid"]["density"] * GRAVITY * float(side.prod())
    wrench = Recording(bag).table("bodies/cube/wrench")
    force = compare.Record(wrench.times, wrench.columns["force_z"])
    settled = force.between(0.2 * force.times[-1], force.times[-1]).values
    name = "%.0f particles across: " % (side[0] / case["fluid"]["spacing"])
    error, deviation = settled.mean() / expected - 1, settled.std() / expected
    table.add(name + "vertical force, mean", "%.3f N" % expected, "%.3f N" % settled.mean(), percent(error), "2 %", abs(error) < 0.02)
    table.add(name + "its standard deviation", "0", percent(deviation), "", "5 %", deviation < 0.05)
    curves = [("Archimedes", compare.Record([0, force.times[-1]], [expected] * 2), "k"), ("wavetank", force, "C0")]
    return [(name + "vertical force", "N", curves, None)]


CASES = {"submerged": (submerged, 0), "floating": (floating, 2), "heave": (heave, 1), "entry": (entry, 1), "pile": (pile, 0)}


def main(arguments):
    if len(arguments) < 3 or arguments[0] not in CASES or len(arguments) != 3 + CASES[arguments[0]][1]:
        print(__doc__, file=sys.stderr)
        return 2
    check = CASES[arguments[0]][0]
    table = compare.Table()
    panels = check(arguments[1], arguments[2], table, *arguments[3:])
    table.print()
    compare.draw(arguments[2], panels)
    return 1 if table.failed else 0


if __name__ == "__main__":
    try:
        sys.exit(main(sys.argv[1:]))
    except Exception as failure:
        if type(failure).__name__ != "Failure":  # of this module, plot_probes or plot_motion
            raise
        print("motion_checks.py: %s" % failure, file=sys.stderr)
        sys.exit(2)
