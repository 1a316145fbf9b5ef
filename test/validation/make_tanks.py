#!/usr/bin/env python3
"""Writes meshes of CAD tanks with few and with many triangles, cases of still water and dam breaks in them, and cases of Archimedes' force:
make_tanks.py DIRECTORY."""
import itertools
import math
import os
import sys
from collections import Counter

import numpy as np
import yaml

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "scripts"))
from make_meshes import box, cylinder_tank, l_tank, prism_walls, quad, write_stl  # noqa: E402

SPACING = 0.02  # m, of the particles; the fine meshes have triangles of about this size
BOX = (0.8, 0.5, 0.5)
CYLINDER_RADIUS, CYLINDER_HEIGHT = 0.3, 0.6
SPHERE_RADIUS = 0.35
ARM, WIDTH, L_HEIGHT, THICKNESS = 0.8, 0.4, 0.5, 0.02
BODY_SIZE = 0.4
BODY_ROTATION = (25, 35, 0)  # degrees, roll, pitch and yaw
MARGIN = 4 * SPACING  # of water around the bodies


def tiles(cells, height, downwards=False):
    """A flat face of squares of one spacing."""
    triangles = []
    for i, j in cells:
        corners = [(SPACING * (i + di), SPACING * (j + dj), height) for di, dj in ((0, 0), (1, 0), (1, 1), (0, 1))]
        triangles += quad(*(corners[::-1] if downwards else corners))
    return triangles


def sides(outline, bottom, top, inwards=False):
    """Upright sides in squares of about one spacing."""
    points = []
    for start, end in zip(outline, outline[1:] + outline[:1]):
        count = math.ceil(math.dist(start, end) / SPACING - 1e-6)
        points += [tuple(np.array(start) + (np.array(end) - start) * k / count) for k in range(count)]
    heights = np.linspace(bottom, top, math.ceil((top - bottom) / SPACING - 1e-6) + 1)
    return [triangle for low, high in zip(heights, heights[1:]) for triangle in prism_walls(points, low, high, inwards)]


def fine_box():
    length, width, height = BOX
    cells = itertools.product(range(round(length / SPACING)), range(round(width / SPACING)))
    return tiles(cells, 0.0, downwards=True) + sides([(0, 0), (length, 0), (length, width), (0, width)], 0.0, height)


def fine_cylinder(rings):
    """Ring k of the floor has 6 k corners."""

    def corner(ring, k):
        angle = 2 * math.pi * (k % (6 * ring)) / (6 * ring) if ring else 0.0
        return (CYLINDER_RADIUS * ring / rings * math.cos(angle), CYLINDER_RADIUS * ring / rings * math.sin(angle), 0.0)

    triangles = []
    for ring, sector in itertools.product(range(1, rings + 1), range(6)):
        for k in range(ring):
            outer, inner = sector * ring + k, sector * (ring - 1) + k
            triangles.append((corner(ring, outer), corner(ring - 1, inner), corner(ring, outer + 1)))
            if k + 1 < ring:
                triangles.append((corner(ring - 1, inner), corner(ring - 1, inner + 1), corner(ring, outer + 1)))
    return triangles + sides([corner(rings, k)[:2] for k in range(6 * rings)], 0.0, CYLINDER_HEIGHT)


def fine_l():
    """The same solid as l_tank."""
    arm, width, thickness = (round(length / SPACING) for length in (ARM, WIDTH, THICKNESS))

    def outline(margin):
        low, long, short = -margin * SPACING, ARM + margin * SPACING, WIDTH + margin * SPACING
        return [(low, low), (long, low), (long, short), (short, short), (short, long), (low, long)]

    def cells(margin):
        reach = range(-margin, arm + margin)
        return [(i, j) for i, j in itertools.product(reach, reach) if min(i, j) < width + margin]

    triangles = sides(outline(thickness), -THICKNESS, L_HEIGHT) + tiles(cells(thickness), -THICKNESS, downwards=True)
    triangles += sides(outline(0), 0.0, L_HEIGHT, inwards=True) + tiles(cells(0), 0.0)
    return triangles + tiles(set(cells(thickness)) - set(cells(0)), L_HEIGHT)


def icosphere(centre, radius, division):
    """An icosahedron with every edge in so many parts, pushed out to the sphere. Its highest and lowest points are corners if that is even."""
    golden = (1 + math.sqrt(5)) / 2
    corners = [np.roll((0.0, a, b * golden), shift) for shift in range(3) for a in (-1, 1) for b in (-1, 1)]
    triangles = []
    for a, b, c in itertools.combinations(corners, 3):
        if max(np.linalg.norm(b - a), np.linalg.norm(c - b), np.linalg.norm(a - c)) > 2.001:
            continue
        if np.linalg.det([a, b, c]) < 0:
            b, c = c, b
        grid = {(i, j): a + (b - a) * i / division + (c - a) * j / division for i in range(division + 1) for j in range(division + 1 - i)}
        for i, j in grid:
            if i + j < division:
                triangles.append((grid[i, j], grid[i + 1, j], grid[i, j + 1]))
            if i + j < division - 1:
                triangles.append((grid[i + 1, j], grid[i + 1, j + 1], grid[i, j + 1]))
    return [tuple(centre + radius * corner / np.linalg.norm(corner) for corner in triangle) for triangle in triangles]


def check_mesh(name, triangles, rim=None):
    """Every edge has two triangles, which are wound the same way; those at the height of an open rim may have one."""
    edges = Counter()
    for triangle in triangles:
        corners = [tuple(np.round(corner, 7) + 0.0) for corner in triangle]
        edges.update(zip(corners, corners[1:] + corners[:1]))
    for (start, end), count in edges.items():
        on_rim = rim is not None and abs(start[2] - rim) < 1e-6 and abs(end[2] - rim) < 1e-6
        if count != 1 or start == end or not (on_rim or edges[end, start] == 1):
            raise ValueError(f"{name}: the edge from {start} to {end} is not shared by two triangles")


def volume(triangles):
    return float(np.linalg.det(np.array(triangles)).sum() / 6)


def position(point):
    return [round(float(coordinate), 6) for coordinate in point]


def fill_box(low, high):
    return {"box": {"min": position(low), "max": position(high)}}


def columns(top, radius, floor):
    """Boxes side by side in a round tank's half x < 0, up to `top`. floor(r) is the least z at a distance r < radius from the axis."""
    boxes, step, rise = [], 2 * SPACING, 3 * SPACING
    for x in -step * np.arange(math.floor(radius / step), 0, -1):
        lows = {}
        for k in range(round(radius / SPACING)):
            distance = math.hypot(x, (k + 1) * SPACING)
            if distance < radius:
                lows.setdefault(rise * math.ceil(floor(distance) / rise - 1e-6), []).append(k)
        for low, rows in lows.items():
            first, last = SPACING * rows[0], SPACING * (rows[-1] + 1)
            spans = [(-last, last)] if rows[0] == 0 else [(-last, -first), (first, last)]
            boxes += [fill_box((x, start, low), (x + step, end, top)) for start, end in spans]
    return boxes


def write_case(directory, name, title, duration, rate, fill, tank, probes, bodies=None):
    case = {"title": title, "duration": duration, "fluid": {"spacing": SPACING, "fill": fill}, "tank": tank}
    if bodies:
        case["bodies"] = bodies
    case["numerics"] = {"artificial_viscosity": 0.02, "walls": {"elements": "facet"}}
    case["instruments"] = {"pressure_probes": [{"name": key, "position": position(point)} for key, point in probes.items()], "rate": rate}
    with open(os.path.join(directory, name + ".yaml"), "w") as file:
        yaml.safe_dump(case, file, sort_keys=False, default_flow_style=None, width=150)


def write_tanks(directory):
    length, width, height = BOX
    inside_cylinder, inside_sphere = 0.99 * CYLINDER_RADIUS, 0.98 * SPHERE_RADIUS  # the coarse meshes lie outside of these
    meshes = {
        "box": (box((0, 0, 0), BOX, open_top=True), fine_box(), height),
        "cylinder": (cylinder_tank(CYLINDER_RADIUS, CYLINDER_HEIGHT, 24), fine_cylinder(rings=16), CYLINDER_HEIGHT),
        "sphere": (icosphere((0, 0, SPHERE_RADIUS), SPHERE_RADIUS, 4), icosphere((0, 0, SPHERE_RADIUS), SPHERE_RADIUS, 12), None),
        "l": (l_tank(ARM, WIDTH, L_HEIGHT, THICKNESS), fine_l(), None),
    }
    still = {"box": ((0.4, 0.25, 0.1), 0.34), "cylinder": ((0, 0, 0.1), 0.4), "sphere": ((0, 0, 0.3), 0.46), "l": ((0.2, 0.2, 0.1), 0.34)}
    dams = {
        "box": [fill_box((0, 0, 0), (0.4 * length, width, 0.3))],
        "cylinder": columns(0.36, inside_cylinder, lambda r: 0.0),
        "sphere": columns(0.42, math.sqrt(inside_sphere**2 - 0.07**2), lambda r: SPHERE_RADIUS - math.sqrt(inside_sphere**2 - r**2)),
        "l": [fill_box((0.32, 0, 0), (ARM, WIDTH, 0.3))],
    }
    probes = {
        "box": {"floor": (0.4, 0.24, 0), "wall": (length, 0.24, 0.1), "middle": (0.4, 0.24, 0.1)},
        "cylinder": {"floor": (0, 0, 0), "wall": (CYLINDER_RADIUS, 0, 0.1), "middle": (0, 0, 0.1)},
        "sphere": {"floor": (0, 0, 0), "wall": (SPHERE_RADIUS, 0, SPHERE_RADIUS), "middle": (0, 0, 0.2)},
        "l": {"floor": (0.2, 0.2, 0), "wall": (0, 0.2, 0.1), "corner": (WIDTH, WIDTH, 0.1), "middle": (0.2, 0.2, 0.1)},
    }
    for shape, (coarse, fine, rim) in meshes.items():
        for fineness, triangles in (("coarse", coarse), ("fine", fine)):
            name = f"{shape}_{fineness}"
            check_mesh(name, triangles, rim)
            write_stl(os.path.join(directory, name + ".stl"), triangles)
            tank, what = {"mesh": name + ".stl"}, f"tank {name} of {len(triangles)} triangles"
            seed, level = still[shape]
            fill = [{"seed": position(seed), "level": level}]
            write_case(directory, "still_" + name, f"Still water in {what}", 10, 100, fill, tank, probes[shape])
            write_case(directory, "dam_" + name, f"Dam break in {what}", 3, 100, dams[shape], tank, probes[shape])
            print(f"{name}: {len(triangles)} triangles")


def write_archimedes(directory):
    half = BODY_SIZE / 2
    roll, pitch = np.radians(BODY_ROTATION[:2])
    about_x = np.array([[1, 0, 0], [0, math.cos(roll), -math.sin(roll)], [0, math.sin(roll), math.cos(roll)]])
    about_y = np.array([[math.cos(pitch), 0, math.sin(pitch)], [0, 1, 0], [-math.sin(pitch), 0, math.cos(pitch)]])
    tilted_extent = np.abs(about_y @ about_x).sum(axis=1) * BODY_SIZE
    bodies = {
        "sphere": (icosphere((0, 0, 0), half, 4), np.full(3, BODY_SIZE), (0, 0, 0)),
        "tilted_box": (box((-half,) * 3, (half,) * 3), tilted_extent, BODY_ROTATION),
    }
    for shape, (triangles, extent, rotation) in bodies.items():
        name = "archimedes_" + shape
        check_mesh(name, triangles)
        write_stl(os.path.join(directory, name + ".stl"), triangles)
        size = SPACING * np.ceil((extent + 2 * MARGIN) / SPACING - 1e-6)
        body = {"name": "body", "mesh": name + ".stl", "rotation": list(rotation), "translation": position(size / 2), "motion": "fixed"}
        tank = {"box": {"size": position(size + (0, 0, MARGIN))}}
        probes = {"floor": (size[0] / 2, size[1] / 2, 0)}
        write_case(directory, name, f"Submerged {shape.replace('_', ' ')}", 2, 200, [fill_box((0, 0, 0), size)], tank, probes, [body])
        print(f"{name}: {len(triangles)} triangles, {volume(triangles):.9g} m³")


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit("usage: make_tanks.py DIRECTORY")
    os.makedirs(sys.argv[1], exist_ok=True)
    write_tanks(sys.argv[1])
    write_archimedes(sys.argv[1])
