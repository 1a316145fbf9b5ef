#!/usr/bin/env python3
"""Writes the meshes of the demo cases and tests, as binary STL in metres with z up: make_meshes.py [DIRECTORY], by default meshes/ of this package."""
import os
import sys

import numpy as np


def quad(a, b, c, d):
    """Two triangles of a flat quadrilateral, wound as its corners are given."""
    return [(a, b, c), (a, c, d)]


def box(low, high, open_top=False):
    """A box, wound outwards."""
    (x0, y0, z0), (x1, y1, z1) = low, high
    triangles = quad((x0, y0, z0), (x0, y1, z0), (x1, y1, z0), (x1, y0, z0))
    for (ax, ay), (bx, by) in (((x0, y0), (x1, y0)), ((x1, y0), (x1, y1)), ((x1, y1), (x0, y1)), ((x0, y1), (x0, y0))):
        triangles += quad((ax, ay, z0), (bx, by, z0), (bx, by, z1), (ax, ay, z1))
    if not open_top:
        triangles += quad((x0, y0, z1), (x1, y0, z1), (x1, y1, z1), (x0, y1, z1))
    return triangles


def prism_walls(outline, bottom, top, inwards=False):
    """The upright sides over a counter-clockwise outline."""
    triangles = []
    for k, (x, y) in enumerate(outline):
        nx, ny = outline[(k + 1) % len(outline)]
        corners = [(x, y, bottom), (nx, ny, bottom), (nx, ny, top), (x, y, top)]
        triangles += quad(*(corners[::-1] if inwards else corners))
    return triangles


def fan(outline, height, downwards):
    """A flat face over an outline that its first point sees wholly."""
    points = [(x, y, height) for x, y in outline]
    triangles = [(points[0], points[k], points[k + 1]) for k in range(1, len(points) - 1)]
    return [(a, c, b) for a, b, c in triangles] if downwards else triangles


def cylinder_tank(radius, height, segments):
    """An upright cylinder without its top."""
    angles = 2 * np.pi * np.arange(segments) / segments
    outline = [(radius * np.cos(a), radius * np.sin(a)) for a in angles]
    return prism_walls(outline, 0.0, height) + fan(outline, 0.0, downwards=True)


def sphere(centre, radius, subdivisions):
    """An octahedron whose faces are halved again and again, pushed out to the sphere."""
    x, y, z = np.eye(3)
    triangles = []
    for a, b, c in ((x, y, z), (y, -x, z), (-x, -y, z), (-y, x, z)):
        triangles += [(a, b, c), (b, a, -c)]
    for _ in range(subdivisions):
        finer = []
        for a, b, c in triangles:
            ab, bc, ca = ((p + q) / np.linalg.norm(p + q) for p, q in ((a, b), (b, c), (c, a)))
            finer += [(a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca)]
        triangles = finer
    return [tuple(np.asarray(centre) + radius * corner for corner in triangle) for triangle in triangles]


def l_tank(arm, width, height, thickness):
    """An L-shaped tank as CAD draws it: a solid with an outer and an inner skin. The inside has its corner at the origin."""
    inner = [(0.0, 0.0), (arm, 0.0), (arm, width), (width, width), (width, arm), (0.0, arm)]
    t = thickness
    outer = [(-t, -t), (arm + t, -t), (arm + t, width + t), (width + t, width + t), (width + t, arm + t), (-t, arm + t)]
    triangles = prism_walls(outer, -t, height) + fan(outer, -t, downwards=True)
    triangles += prism_walls(inner, 0.0, height, inwards=True) + fan(inner, 0.0, downwards=False)
    for k in range(len(inner)):  # the rim
        n = (k + 1) % len(inner)
        triangles += quad((*outer[k], height), (*outer[n], height), (*inner[n], height), (*inner[k], height))
    return triangles


def flume(profile, rim, width):
    """A flume without its top: a floor that follows (x, z) points from one end to the other, level in y, with upright ends and sides to the rim."""
    half = 0.5 * width
    triangles = []
    for (x0, z0), (x1, z1) in zip(profile, profile[1:]):
        triangles += quad((x0, -half, z0), (x0, half, z0), (x1, half, z1), (x1, -half, z1))
        triangles += quad((x0, -half, z0), (x1, -half, z1), (x1, -half, rim), (x0, -half, rim))
        triangles += quad((x1, half, z1), (x0, half, z0), (x0, half, rim), (x1, half, rim))
    (first, low), (last, high) = profile[0], profile[-1]
    triangles += quad((first, half, low), (first, -half, low), (first, -half, rim), (first, half, rim))
    triangles += quad((last, -half, high), (last, half, high), (last, half, rim), (last, -half, rim))
    return triangles


def wedge(outline, width):
    """A closed prism across the x-z plane: its outline as (x, z) turns left as seen from y = -infinity."""
    near, far = ([(x, y, z) for x, z in outline] for y in (-0.5 * width, 0.5 * width))
    triangles = []
    for k in range(len(outline)):
        after = (k + 1) % len(outline)
        triangles += quad(near[k], far[k], far[after], near[after])
    for k in range(1, len(outline) - 1):
        triangles += [(near[0], near[k], near[k + 1]), (far[0], far[k + 1], far[k])]
    return triangles


def hull(length, beam, depth, stations):
    """A small boat's hull, closed by a flat deck: V-shaped sections under a chine, a transom at x = 0, a bow that comes to a point at deck height.

    x forwards, y to port, z up from the keel. Forward of half its length the chine runs in and up, and the keel rises to the stem.
    """
    chine = 0.65 * depth

    def section(x):
        """Half the beam at the deck and at the chine, and the heights of chine and keel."""
        forward = max(0.0, 2 * x / length - 1)  # 0 from the transom to the middle, 1 at the stem
        deck = 0.5 * beam * np.sqrt(1 - forward**2)
        return deck, 0.85 * deck, chine + (depth - chine) * forward**3, depth * forward**4

    def ring(x):
        """From the keel to port, over the deck, down on starboard."""
        deck, side, chine_height, keel = section(x)
        return [(x, 0.0, keel), (x, side, chine_height), (x, deck, depth), (x, -deck, depth), (x, -side, chine_height)]

    # Denser towards the stem, where the waterlines turn in.
    places = [0.0] + [length * (0.5 + 0.5 * np.sin(0.5 * np.pi * k / stations)) for k in range(stations)]
    rings = [ring(x) for x in places]
    stem = (length, 0.0, depth)
    triangles = []
    for aft, fore in zip(rings, rings[1:]):
        for k in range(5):
            n = (k + 1) % 5
            triangles += quad(aft[k], aft[n], fore[n], fore[k])
    for k in range(5):
        triangles.append((rings[-1][k], rings[-1][(k + 1) % 5], stem))
        if 0 < k < 4:
            triangles.append((rings[0][0], rings[0][k + 1], rings[0][k]))
    return triangles


def write_stl(path, triangles):
    corners = np.array(triangles, dtype=np.float64)
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    record = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
    records = np.zeros(len(corners), dtype=record)
    records["normal"] = normals + 0.0  # no negative zeros
    records["corners"] = corners + 0.0
    with open(path, "wb") as stl:
        stl.write(b"wavetank, metres, z up".ljust(80, b" "))
        stl.write(np.uint32(len(records)).astype("<u4").tobytes())
        stl.write(records.tobytes())


def main():
    default = os.path.join(os.path.dirname(os.path.dirname(os.path.abspath(__file__))), "meshes")
    directory = sys.argv[1] if len(sys.argv) > 1 else default
    os.makedirs(directory, exist_ok=True)
    meshes = {
        "spheric2_tank.stl": box((0, 0, 0), (3.22, 1, 1), open_top=True),
        "spheric2_box.stl": box((0.6635, 0.5 - 0.2015, 0), (0.8245, 0.5 + 0.2015, 0.161)),
        "cylinder_tank.stl": cylinder_tank(radius=0.5, height=1.0, segments=96),
        "sphere.stl": sphere(centre=(0, 0, 0), radius=0.5, subdivisions=4),
        "l_tank.stl": l_tank(arm=1.2, width=0.5, height=0.6, thickness=0.02),
        # Hadzic et al. 2005: flat to x = 4 m, then a beach of 1 : 10; 0.6 m behind the flap, whose hinge is at x = 0.
        "wave_flume.stl": flume(profile=[(-0.6, 0), (4, 0), (10, 0.6)], rim=0.9, width=0.4),
        # A piston flume with its face at x = 1 m and a beach of 1 : 6 from x = 4 m on.
        "piston_flume.stl": flume(profile=[(0.6, 0), (4, 0), (7.3, 0.55)], rim=0.6, width=0.4),
        # A weir with a sharp crest 0.2 m high, whose back falls off at 63°.
        "weir.stl": wedge(outline=[(2.0, 0.0), (2.1, 0.0), (2.0, 0.2)], width=0.4),
        "ball.stl": sphere(centre=(0, 0, 0), radius=0.5, subdivisions=2),  # few triangles: a body afloat costs time by its triangles
        "boat.stl": hull(length=0.7, beam=0.26, depth=0.14, stations=12),
    }
    for name, triangles in meshes.items():
        write_stl(os.path.join(directory, name), triangles)


if __name__ == "__main__":
    main()
