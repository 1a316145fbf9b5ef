#!/usr/bin/env python3
"""The dam break of config/dam_break_mls.yaml by SPH and by both forms of moving least squares, beside the tables of the paper that it is from:
least_squares.py PROGRAM CASE FOLDER [SPACING]... runs PROGRAM (wavetank_run) at each spacing, m, keeps the bags in FOLDER, and prints the tables; what is there already is
not run again.

The front is how far connected water reaches along the floor, to half a spacing beyond its last particle; the heights are those of two gauges, beside the wall
and outside the layer that a wall without slip drags along."""

import os
import subprocess
import sys

# of Bilotta, Russo, Hérault & Del Negro, Tables 1 and 2; the experiments are Martin & Moyce's, T = t n√(g/a) and t √(g/a) with n² = 2 and a = 1 m
FRONTS = [1.11, 1.89, 2.33, 2.78]
HEIGHTS = [0.89, 0.78, 0.72, 0.67, 0.61]
REFERENCES = {
    "experiment": (["0.30–0.48", "1.56–1.67", "1.87–2.02", "2.21–2.38"], ["0.76–0.79", "1.05–1.11", "1.28–1.33", "1.44–1.47", "1.66–1.68"]),
    "paper, SPH": (["0.40", "1.46", "1.90", "2.31"], ["0.75", "1.10", "1.32", "1.48", "1.73"]),
    "paper, both MLS": (["0.40", "1.51", "1.92", "2.31"], ["0.79", "1.07", "1.29", "1.54", "1.82"]),
}
METHODS = {
    "SPH": ["numerics/gradients=sph"],
    "mls_corrected": ["numerics/gradients=mls_corrected"],
    "mls": ["numerics/gradients=mls"],
}
SLIPS = ["no_slip", "free_slip"]
GRAVITY = 9.81  # m/s²


def front_of(points, spacing):
    """How far the water reaches from x = 0 without a gap of four spacings along x."""
    places = sorted(points)
    reach = places[0]
    for place in places:
        if place - reach > 4 * spacing:
            break
        reach = place
    return reach + 0.5 * spacing


def read(bag, spacing):
    """(times, fronts), and by gauge (times, levels)."""
    import rosbag
    from sensor_msgs import point_cloud2

    fronts, gauges = ([], []), {}
    with rosbag.Bag(bag) as messages:
        for topic, message, _ in messages.read_messages():
            if topic.endswith("/free_surface"):
                fronts[0].append(message.header.stamp.to_sec())
                fronts[1].append(front_of([x for x, in point_cloud2.read_points(message, field_names=("x",))], spacing))
            elif topic.endswith("/gauges"):
                for name, level in zip(message.names, message.levels):
                    times, levels = gauges.setdefault(name, ([], []))
                    times.append(message.header.stamp.to_sec())
                    levels.append(level)
    return fronts, gauges


def crossing(times, values, bound):
    """When the values first pass the bound, by straight lines; None if they do not."""
    for k in range(1, len(values)):
        before, after = values[k - 1] - bound, values[k] - bound
        if before == after or before * after > 0:
            continue
        return times[k - 1] + (times[k] - times[k - 1]) * before / (before - after)
    return None


def cell(time, scale):
    return "–" if time is None else "%.2f" % (time * scale)


def run(program, case, folder, name, overrides):
    bag = os.path.join(folder, name + ".bag")
    if not os.path.exists(bag):
        print("running", name, file=sys.stderr, flush=True)
        command = [program, case, "--bag", bag + ".part.bag", "--clouds", "--duration", "0.62"]
        for override in overrides:
            command += ["--set", override]
        with open(os.path.join(folder, name + ".log"), "w", encoding="utf-8") as log:
            if subprocess.run(command, stdout=log, stderr=subprocess.STDOUT, check=False).returncode != 0:
                return None
        os.rename(bag + ".part.bag", bag)
    return bag


def main():
    if len(sys.argv) < 4:
        print(__doc__, file=sys.stderr)
        return 2
    program, case, folder = sys.argv[1:4]
    spacings = sys.argv[4:] or ["0.05", "0.025"]
    os.makedirs(folder, exist_ok=True)
    tables = [[(name, cells[part]) for name, cells in REFERENCES.items()] for part in (0, 1)]
    for slip in SLIPS:
        for spacing in spacings:
            for method, overrides in METHODS.items():
                name = "%s_%s_%s" % (method, slip, spacing)
                more = ["fluid/spacing=" + spacing, "numerics/walls/slip=" + slip, "rates/cloud_bag=200"]
                bag = run(program, case, folder, name, overrides + more)
                label = "%s, %s, %s m" % (method, slip, spacing)
                if bag is None:
                    tables[0].append((label, ["ended early"]))
                    continue
                (times, fronts), gauges = read(bag, float(spacing))
                tables[0].append((label, [cell(crossing(times, fronts, z), (2 * GRAVITY) ** 0.5) for z in FRONTS]))
                columns = [[cell(crossing(*gauges[gauge], 2 * h), GRAVITY**0.5) for h in HEIGHTS] for gauge in ("column", "inner")]
                tables[1].append((label, ["%s, %s" % pair for pair in zip(*columns)]))
    for part, (sign, values) in enumerate((("Z", FRONTS), ("H", HEIGHTS))):
        print("| T of %s = | " % sign + " | ".join("%.2f" % value for value in values) + " |")
        print("|" + "---|" * (len(values) + 1))
        for name, cells in tables[part]:
            print("| %s | " % name + " | ".join(cells) + " |")
        print()
    return 0


if __name__ == "__main__":
    sys.exit(main())
