#!/usr/bin/env python3
"""Runs the free flows of the particle shifting paper (free_flows) and makes their plots and tables: figures 1 to 18.

scheme_figures.py PROGRAM FOLDER taylor_green|shifting_laws|rotating_square [N]... keeps each run's table in FOLDER; what is there already is not run again, and a run that was ended goes on from its last row.
"""
import glob
import math
import os
import subprocess
import sys

import matplotlib
import numpy

matplotlib.use("Agg")
import matplotlib.pyplot as plt

SCHEMES = ["delta_sph", "riemann_parshikov", "riemann_ale"]
PANEL = 180  # points across a picture of particles, of which each is as large as its spacing
LAWS = ["michel", "lind", "sun", "oger", "monaghan"]
COLUMNS = ["t", "energy", "speed", "shift", "mean_shift", "pressure", "error", "volume", "mass", "least", "most", "close", "centre", "worst"]


class Runs:
    def __init__(self, program, folder):
        self.program, self.folder = program, folder
        os.makedirs(folder, exist_ok=True)

    def run(self, flow, fields=None, field_rows=1, **words):
        """The rows of a run, as dictionaries by column. `fields`: a name for the fields of every so many rows."""
        name = "_".join([flow] + ["%s-%s" % item for item in sorted(words.items())])
        path = os.path.join(self.folder, name + ".txt")
        if not os.path.exists(path):
            print("running", name, file=sys.stderr, flush=True)
            command = [self.program, flow] + ["%s=%s" % item for item in words.items()]
            if fields:
                os.makedirs(os.path.join(self.folder, "fields"), exist_ok=True)
                command += ["fields=" + os.path.join(self.folder, "fields", fields), "field_rows=%d" % field_rows]
            kept = path + ".state"
            with open(path + ".part", "w", encoding="utf-8") as out:
                subprocess.run(command + ["keep=" + kept], stdout=out, check=True)
            os.rename(path + ".part", path)
            os.remove(kept)
        with open(path, encoding="utf-8") as file:
            lines = file.read().splitlines()[1:]
        return [dict(zip(COLUMNS, map(float, line.split()))) for line in lines]

    def fields(self, name):
        """The times and tables of a run's fields, in their order."""
        found = []
        for path in glob.glob(os.path.join(self.folder, "fields", name + "_*.csv")):
            time = os.path.basename(path)[len(name) + 1 : -4]
            if time.replace(".", "").isdigit():
                found.append((float(time), path))
        return [(time, numpy.genfromtxt(path, delimiter=",", names=True)) for time, path in sorted(found)]


def mean(rows, column, begin, end):
    """Of a column over the rows in a span of time; a mean since the last row is weighted by its span."""
    chosen = [row for row in rows if begin < row["t"] <= end + 1e-9]
    return sum(row[column] for row in chosen) / len(chosen)


def at(rows, column, time):
    return min(rows, key=lambda row: abs(row["t"] - time))[column]


def orders(values):
    return ["%.2f" % math.log2(a / b) for a, b in zip(values, values[1:])]


def table(head, rows):
    print("| " + " | ".join(head) + " |")
    print("|" + "---|" * len(head))
    for row in rows:
        print("| " + " | ".join(str(cell) for cell in row) + " |")
    print()


def taylor_green(runs, sides):
    figure, axes = plt.subplots(2, 2, figsize=(11, 8))
    found = {}
    for scheme in SCHEMES:
        for n in sides:
            for name, words in {"inviscid": {}, "viscous": {"reynolds": 100}}.items():
                found[scheme, n, name] = runs.run("taylor_green", scheme=scheme, shifting="michel", n=n, end=0.5, rows=25, **words)
    for scheme, colour in zip(SCHEMES, ["#1f5fbf", "#2a8c3c", "#c1272d"]):
        for n, style in zip(sides, [":", "--", "-"]):
            rows = found[scheme, n, "inviscid"]
            axes[0][0].plot([r["t"] for r in rows], [r["mean_shift"] for r in rows], style, color=colour, label="%s, %d" % (scheme, n))
            axes[0][1].plot([r["t"] for r in rows], [r["energy"] for r in rows], style, color=colour)
            axes[1][0].plot([r["t"] for r in rows], [r["error"] for r in rows], style, color=colour)
            rows = found[scheme, n, "viscous"]
            axes[1][1].plot([r["t"] for r in rows], [r["energy"] for r in rows], style, color=colour)
    times = [0.01 * k for k in range(51)]
    axes[1][1].plot(times, [math.exp(-16 * math.pi**2 * t / 100) for t in times], "k", linewidth=0.8, label="exact")
    for axis, title in zip(
        axes.flat, ["greatest shift/U (fig 1)", "kinetic energy left, inviscid (fig 4)", "pressure error, rms/ρU²", "kinetic energy left, Re = 100 (fig 6)"]
    ):
        axis.set_title(title)
        axis.set_xlabel("tU/L")
    axes[0][0].set_yscale("log")
    axes[0][0].legend(fontsize=7)
    axes[1][1].legend()
    figure.tight_layout()
    figure.savefig(os.path.join(runs.folder, "taylor_green.png"), dpi=110)

    for n in sides:
        found["limiter 2", n] = runs.run("taylor_green", scheme="riemann_ale", shifting="michel", n=n, end=0.5, rows=25, reynolds=100, limiter=2)

    head = (
        ["scheme"] + ["max δu/U, L/Δx = %d" % n for n in sides] + ["order"] + ["E/E₀ at 0.4, %d" % n for n in sides] + ["p error at 0.4, %d" % n for n in sides]
    )
    lines = []
    for scheme in SCHEMES:
        shifts = [mean(found[scheme, n, "inviscid"], "mean_shift", 0.25, 0.5) for n in sides]
        lines.append(
            [scheme]
            + ["%.3f" % s for s in shifts]
            + [", ".join(orders(shifts))]
            + ["%.3f" % at(found[scheme, n, "inviscid"], "energy", 0.4) for n in sides]
            + ["%.3f" % at(found[scheme, n, "inviscid"], "error", 0.4) for n in sides]
        )
    table(head, lines)
    lines = []
    for scheme in SCHEMES:
        lines.append([scheme] + ["%.3f (%.3f)" % (at(found[scheme, n, "viscous"], "energy", 0.4), math.exp(-16 * math.pi**2 * 0.4 / 100)) for n in sides])
    lines.append(["riemann_ale, limiter: 2"] + ["%.3f" % at(found["limiter 2", n], "energy", 0.4) for n in sides])
    table(["Re = 100: E/E₀ at 0.4 (exact)"] + [str(n) for n in sides], lines)

    n = sides[0]
    still = found["riemann_ale", n, "inviscid"]
    carried = runs.run("taylor_green", scheme="riemann_ale", shifting="michel", n=n, end=0.5, rows=25, drift=2)
    table(
        ["riemann_ale, %d" % n, "max δu/U, mean of 0.25–0.5", "E/E₀ at 0.1"],
        [
            ["as it is", "%.4f" % mean(still, "mean_shift", 0.25, 0.5), "%.5f" % at(still, "energy", 0.1)],
            ["carried along by 2 U", "%.4f" % mean(carried, "mean_shift", 0.25, 0.5), "%.5f" % at(carried, "energy", 0.1)],
        ],
    )


def shifting_laws(runs, sides):
    """Figures 10 to 13, by Vila's scheme."""
    figure, axes = plt.subplots(2, 3, figsize=(15, 8))
    lines = []
    for law, axis in zip(LAWS, axes.flat):
        cells = [law]
        for n, style in zip(sides, [":", "-.", "--", "-"]):
            rows = runs.run("taylor_green", fields="vortices_%s_%d" % (law, n), field_rows=12, scheme="riemann_ale", shifting=law, n=n, end=0.3, rows=15)
            cells.append(
                "%.3f, %.3f, %.2f, %d" % (mean(rows, "mean_shift", 0.2, 0.3), at(rows, "error", 0.3), mean(rows, "worst", 0.2, 0.3), at(rows, "close", 0.3))
            )
            axis.plot([r["t"] for r in rows], [r["mean_shift"] for r in rows], style, label="L/Δx = %d" % n)
            if n == sides[-1]:
                axes[1][2].plot([r["t"] for r in rows], [r["worst"] for r in rows], label=law)
        lines.append(cells)
        axis.set_title("%s: greatest shift/U" % law)
        axis.set_ylim(0, None)
        axis.legend(fontsize=7)
    axes[1][2].set_title("greatest error of the pressure/ρU², L/Δx = %d" % sides[-1])
    axes[1][2].set_ylim(0, 2)
    axes[1][2].legend(fontsize=7)
    for axis in axes.flat:
        axis.set_xlabel("tU/L")
    figure.tight_layout()
    figure.savefig(os.path.join(runs.folder, "laws.png"), dpi=100)
    table(
        ["riemann_ale: max δu/U (mean of 0.2–0.3), p error/ρU² at 0.3, its greatest (mean of 0.2–0.3), pairs closer than Δx/2 at 0.3"]
        + ["L/Δx = %d" % n for n in sides],
        lines,
    )

    figure, axes = plt.subplots(1, len(LAWS), figsize=(3.2 * len(LAWS), 3.4), sharey=True)
    for law, axis in zip(LAWS, axes):
        field = runs.fields("vortices_%s_%d" % (law, sides[-1]))
        if not field:
            continue
        time, particles = field[-1]
        x = particles["x"] % 1
        # as the paper's pictures: what was found on the left, what is right on the right
        right = 0.25 * (numpy.cos(4 * math.pi * x) + numpy.cos(4 * math.pi * particles["z"]))
        drawn = axis.scatter(
            x,
            particles["z"] % 1,
            c=numpy.where(x < 0.5, particles["pressure"], right),
            s=(PANEL / sides[-1]) ** 2,
            cmap="jet",
            vmin=-0.5,
            vmax=0.5,
            linewidths=0,
        )
        axis.set_title("%s, tU/L = %.2f" % (law, time))
        axis.set_aspect("equal")
        axis.set_xlim(0, 1)
        axis.set_ylim(0, 1)
    figure.colorbar(drawn, ax=axes, label="p/ρU²", shrink=0.8)
    figure.savefig(os.path.join(runs.folder, "law_fields.png"), dpi=130, bbox_inches="tight")


def rotating_square(runs, sides):
    figure, axes = plt.subplots(1, 3, figsize=(14, 4.5))
    lines = []
    for scheme, colour in zip(SCHEMES, ["#1f5fbf", "#2a8c3c", "#c1272d"]):
        shifts, energies, starts = [], [], []
        for n, style in zip(sides, [":", "--", "-"]):
            end = 6 if n <= 200 else 2.5  # as far as the paper's figures of that spacing go
            name = "square_%s_%d" % (scheme, n)
            rows = runs.run("square", fields=name, field_rows=24, scheme=scheme, shifting="michel", n=n, end=end, rows=round(20 * end), sound=40)
            axes[0].plot([r["t"] for r in rows], [r["mean_shift"] for r in rows], style, color=colour, label="%s, %d" % (scheme, n))
            axes[1].plot([r["t"] for r in rows], [r["energy"] for r in rows], style, color=colour)
            axes[2].plot([r["t"] for r in rows], [r["centre"] for r in rows], style, color=colour)
            shifts.append(mean(rows, "mean_shift", 1.5, 2.5))
            energies.append(at(rows, "energy", 2.0))
            starts.append(mean(rows, "centre", 0.0, 0.2))
        lines.append([scheme] + ["%.4f" % s for s in shifts] + [", ".join(orders(shifts))] + ["%.4f" % e for e in energies] + ["%.4f" % s for s in starts])
    for axis, title in zip(axes, ["greatest shift/ωL (fig 15)", "kinetic energy left (fig 17)", "pressure at the centre/ρω²L² (fig 17)"]):
        axis.set_title(title)
        axis.set_xlabel("tω")
    axes[0].set_yscale("log")
    axes[0].legend(fontsize=7)
    figure.tight_layout()
    figure.savefig(os.path.join(runs.folder, "rotating_square.png"), dpi=110)
    table(
        ["scheme"]
        + ["max δu/ωL, mean of 1.5–2.5, L/Δx = %d" % n for n in sides]
        + ["order"]
        + ["E/E₀ at 2, %d" % n for n in sides]
        + ["p(centre), mean to 0.2, %d" % n for n in sides],
        lines,
    )
    square_fields(runs, sides)


def square_fields(runs, sides):
    """Figure 16, of the finest that went to its end."""
    n = max([n for n in sides if n <= 200] or sides)
    fields = [runs.fields("square_%s_%d" % (scheme, n)) for scheme in SCHEMES]
    count = max(len(field) for field in fields)
    if count == 0:
        return
    figure, axes = plt.subplots(len(SCHEMES), count, figsize=(3 * count, 3.2 * len(SCHEMES)), squeeze=False)
    for scheme, field, row in zip(SCHEMES, fields, axes):
        for axis in row:
            axis.axis("off")
        for (time, particles), axis in zip(field, row):
            reach = 0.75 * math.hypot(1, time)
            size = (PANEL / (2 * reach * n)) ** 2
            drawn = axis.scatter(particles["x"], particles["z"], c=particles["pressure"], s=size, cmap="jet", vmin=-0.15, vmax=0, linewidths=0)
            axis.set_title("%s, tω = %.1f" % (scheme, time), fontsize=9)
            axis.set_aspect("equal")
            axis.set_xlim(-reach, reach)
            axis.set_ylim(-reach, reach)
    figure.colorbar(drawn, ax=axes, label="p/ρω²L²", shrink=0.5)
    figure.savefig(os.path.join(runs.folder, "square_fields.png"), dpi=110, bbox_inches="tight")


def main():
    flows = {"taylor_green": taylor_green, "shifting_laws": shifting_laws, "rotating_square": rotating_square}
    if len(sys.argv) < 4 or sys.argv[3] not in flows:
        print(__doc__, file=sys.stderr)
        return 2
    runs = Runs(sys.argv[1], sys.argv[2])
    sides = [int(n) for n in sys.argv[4:]] or [50, 100]
    flows[sys.argv[3]](runs, sides)
    return 0


if __name__ == "__main__":
    sys.exit(main())
