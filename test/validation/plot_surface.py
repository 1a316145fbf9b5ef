#!/usr/bin/env python3
"""Draws the free surface of a 2-D bag that wavetank_run wrote with --clouds: plot_surface.py BAG PICTURE TIME..., each panel the first cloud from a time (s) on."""

import os
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import compare_motion as compare  # noqa: E402


def surfaces(bag, times):
    """The first cloud from each time on: (time, points x z)."""
    import numpy
    import rosbag
    from sensor_msgs import point_cloud2

    found, wanted = [], sorted(times)
    with rosbag.Bag(bag) as messages:
        for topic, message, _ in messages.read_messages():
            if not topic.endswith("/free_surface") or not wanted or message.header.stamp.to_sec() < wanted[0] - 1e-6:
                continue
            points = numpy.array(list(point_cloud2.read_points(message, field_names=("x", "z"))), dtype=float)
            found.append((message.header.stamp.to_sec(), points.reshape(-1, 2)))
            wanted = wanted[1:]
    if wanted:
        raise compare.Failure("'%s' holds no cloud of the free surface from %g s on; write it with --clouds" % (bag, wanted[0]))
    return found


def main(arguments):
    if len(arguments) < 3:
        print(__doc__, file=sys.stderr)
        return 2
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as pyplot

    found = surfaces(arguments[0], [float(time) for time in arguments[2:]])
    figure, axes = pyplot.subplots(1, len(found), figsize=(4.2 * len(found), 2.4), squeeze=False, sharey=True)
    for axis, (time, points) in zip(axes[0], found):
        axis.plot(points[:, 0], points[:, 1], "C0.", markersize=2.5)
        axis.set_xlim(points[:, 0].min() - 0.005, points[:, 0].min() + 0.2)
        axis.set_aspect("equal")
        axis.set_title("%.3f s" % time, fontsize=9)
        axis.set_xlabel("x (m)")
    axes[0, 0].set_ylabel("z (m)")
    figure.tight_layout()
    figure.savefig(arguments[1], dpi=90)
    return 0


if __name__ == "__main__":
    try:
        sys.exit(main(sys.argv[1:]))
    except compare.Failure as failure:
        print("plot_surface.py: %s" % failure, file=sys.stderr)
        sys.exit(2)
