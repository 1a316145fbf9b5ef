#!/usr/bin/python3
"""Draws packed particles as packed_particles wrote them, a column for each: a slice across and a slice along the floor, one spacing thick, with the outline of
the particles' own tank meshes: plot_packing.py SPACING OUT.png CSV STL [CSV STL]..."""
import sys

import matplotlib
import numpy as np

matplotlib.use("Agg")
import matplotlib.pyplot as pyplot  # noqa: E402


def read_stl(path):
    with open(path, "rb") as stl:
        stl.seek(80)
        count = np.frombuffer(stl.read(4), "<u4")[0]
        record = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
        return np.frombuffer(stl.read(count * record.itemsize), record)["corners"].astype(float)


def cut(triangles, axis, place):
    """Segments in which the plane of this axis cuts the mesh, in the other two coordinates."""
    others = [k for k in range(3) if k != axis]
    segments = []
    for corners in triangles:
        height = corners[:, axis] - place
        points = []
        for a in range(3):
            b = (a + 1) % 3
            if (height[a] > 0) != (height[b] > 0):
                points.append((corners[a] + (corners[b] - corners[a]) * height[a] / (height[a] - height[b]))[others])
        if len(points) == 2:
            segments.append(points)
    return segments


def row_near(particles, axis, place):
    """Where particles away from walls lie, nearest to the place: a slice between two rows would show neither."""
    inside = particles[particles[:, 3] > 0.99, axis]
    return inside[np.argmin(np.abs(inside - place))]


def draw(axes, particles, triangles, axis, place, spacing):
    others = [k for k in range(3) if k != axis]
    near = particles[np.abs(particles[:, axis] - place) < 0.5 * spacing]
    for start, end in cut(triangles, axis, place):
        axes.plot([start[0], end[0]], [start[1], end[1]], color="black", linewidth=1.0)
    points = axes.scatter(near[:, others[0]], near[:, others[1]], c=near[:, 3], s=9, cmap="viridis", vmin=0.5, vmax=1.0)
    axes.set_aspect("equal")
    axes.set_xlabel("xyz"[others[0]] + ", m")
    axes.set_ylabel("xyz"[others[1]] + ", m")
    axes.set_title("%s = %.2f m" % ("xyz"[axis], place), fontsize=10, loc="left")
    return points


def main(arguments):
    spacing, out, files = float(arguments[0]), arguments[1], arguments[2:]
    columns = len(files) // 2
    picture, axes = pyplot.subplots(2, columns, figsize=(4.3 * columns, 8.0), squeeze=False)
    for column in range(columns):
        particles = np.loadtxt(files[2 * column], delimiter=",", skiprows=1)
        triangles = read_stl(files[2 * column + 1])
        draw(axes[0][column], particles, triangles, 1, row_near(particles, 1, particles[:, 1].min() + 0.3), spacing)
        points = draw(axes[1][column], particles, triangles, 2, row_near(particles, 2, 0.5 * (particles[:, 2].min() + particles[:, 2].max())), spacing)
    picture.tight_layout(rect=(0.0, 0.0, 0.92, 1.0))
    picture.colorbar(points, cax=picture.add_axes([0.94, 0.2, 0.012, 0.6]), label=r"$\gamma$")
    picture.savefig(out, dpi=80)


if __name__ == "__main__":
    if len(sys.argv) < 5 or len(sys.argv) % 2 == 0:
        sys.exit("usage: plot_packing.py SPACING OUT.png CSV STL [CSV STL]...")
    main(sys.argv[1:])
