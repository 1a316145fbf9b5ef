#!/usr/bin/env python3
"""Waves of other kinds than regular ones by a piston, in water 0.4 m deep, against theory:

wave_kinds.py WAVETANK_RUN DIRECTORY [KIND[,SPACING]]...

solitary    by a piston: crest over the height asked for, celerity over √(g(d + H)) with the crest found, along 6 m
started     a solitary wave, H = 0.3 d, that is there at the start: likewise
standing    a standing wave that is there at the start: its period over that of linear theory
focused     a crest of a focused wave: its height, and when and where it is highest; of its components at a gauge 0.5 m before the paddle their sum, which
            linear theory has as the crest, and what of three of them comes to the focus
irregular   a JONSWAP sea of forty peak periods: H_m0 over that asked for, before the middle of the flume
flap        regular waves by a flap hinged at the floor: the height, as in waves.py
absorption  a flume that reflects all, the piston absorbs: what it sends back of what comes, and how far it drifts in its stroke

Prints a line each."""

import math
import os
import subprocess
import sys

import numpy
import yaml

import waves
from wavetank.recording import Recording
from waves import DEPTH, FACE, GRAVITY

SPACING = 0.02  # m, unless told


def flume(end, spacing, duration, gauges, paddle=None, zone=None, face=FACE):
    """A case: gauges by place; `paddle`: its prescribed section; `zone`: where it begins and its strength."""
    case = {
        "title": "waves",
        "dimensions": 2,
        "gravity": [0, -GRAVITY],
        "duration": duration,
        "fluid": {"sound_speed": 20.0, "spacing": spacing, "fill": [{"box": {"min": [face if paddle else 0, 0], "max": [end, DEPTH]}}]},
        "tank": {"box": {"size": [end, 0.8]}},
        "numerics": {"walls": {"slip": "free_slip"}, "artificial_viscosity": 0.005},
        "instruments": {"rate": 100, "wave_gauges": [{"name": "g%d" % k, "position": [float(x)]} for k, x in enumerate(gauges)]},
    }
    if paddle:
        case["bodies"] = [{"name": "paddle", "box": {"min": [face - 0.1, 0], "max": [face, 0.8]}, "motion": "prescribed", "prescribed": paddle}]
    if zone:
        case["fluid"]["damping"] = [{"box": {"min": [zone[0], 0], "max": [end, 0.8]}, "direction": [1, 0], "strength": zone[1]}]
    return case


def run(program, base, case):
    with open(base + ".yaml", "w") as file:
        yaml.safe_dump(case, file)
    with open(base + ".log", "w") as log:
        if subprocess.call([program, base + ".yaml", "--bag", base + ".bag"], stdout=log, stderr=log) != 0:
            sys.exit("wave_kinds.py: the simulation failed; '%s.log' tells why." % base)
    return waves.levels_of(base + ".bag")


def crest(times, levels):
    """Time and height of the greatest level, by a parabola through what is about it."""
    k = int(numpy.argmax(levels))
    about = slice(max(k - 6, 0), k + 7)
    a, b, c = numpy.polyfit(times[about] - times[k], levels[about], 2)
    at = -b / (2 * a)
    return times[k] + at, c + b * at / 2


def along_crests(times, levels, gauges):
    found = numpy.array([crest(times, levels[:, g]) for g in range(len(gauges))])
    heights, celerity = found[:, 1] - DEPTH, numpy.polyfit(found[:, 0], gauges, 1)[0]
    return heights, celerity


def told_solitary(name, height, gauges, times, levels):
    heights, celerity = along_crests(times, levels, gauges)
    print(
        "%s, H = %g m: crest %+.1f %% at x = %g m and %+.1f %% at %g m, celerity %+.1f %%"
        % (
            name,
            height,
            100 * (heights[0] / height - 1),
            gauges[0],
            100 * (heights[-1] / height - 1),
            gauges[-1],
            100 * (celerity / math.sqrt(GRAVITY * (DEPTH + heights.mean())) - 1),
        )
    )


def solitary(program, base, spacing):
    height, gauges = 0.1, numpy.arange(2.0, 8.1, 1.0)
    paddle = {"waves": {"kind": "solitary", "depth": DEPTH, "height": height}}
    told_solitary("solitary by a piston", height, gauges, *run(program, base, flume(10.3, spacing, 6.0, gauges, paddle)))


def started(program, base, spacing):
    height, gauges = 0.12, numpy.arange(4.0, 10.1, 1.0)
    case = flume(13.0, spacing, 3.8, gauges)
    case["fluid"]["sound_speed"] = 25.0
    case["fluid"]["initial"] = {"waves": {"kind": "solitary", "depth": DEPTH, "height": height, "crest": 3.0}}
    told_solitary("solitary from the start", height, gauges, *run(program, base, case))


def standing(program, base, spacing):
    length, height = 1.0, 0.02
    case = flume(length, spacing, 8.0, [0.02, length - 0.02])
    case["fluid"]["initial"] = {"waves": {"kind": "linear", "standing": True, "depth": DEPTH, "height": height, "wavelength": 2 * length}}
    times, levels = run(program, base, case)
    swing = levels[:, 0] - levels[:, 1]
    down = [k for k in range(len(swing) - 1) if swing[k] > 0 >= swing[k + 1]]
    crossings = [times[k] - swing[k] * (times[k + 1] - times[k]) / (swing[k + 1] - swing[k]) for k in down]
    omega = math.sqrt(GRAVITY * math.pi / length * math.tanh(math.pi / length * DEPTH))
    periods = len(crossings) - 1
    print(
        "standing from the start, H = %g m: period %+.2f %% over %d periods, the first crest %+.1f %%"
        % (
            height,
            100 * ((crossings[-1] - crossings[0]) / periods * omega / (2 * math.pi) - 1),
            periods,
            100 * (swing[0] / height / math.cos(math.pi * 0.02) - 1),
        )
    )


def amplitudes(times, level, frequencies):
    """Of the components of a record at these frequencies (Hz), times the record's duration: m s."""
    turns = numpy.exp(-2j * math.pi * numpy.outer(frequencies, times))
    return 2 * numpy.abs(turns @ (level - DEPTH)) * (times[1] - times[0])


def focused(program, base, spacing):
    # a crest of 0.1 m would break before the focus: the sum of its components' steepnesses a k is 0.45, Miche's limit 0.142 π tanh kd 0.38
    height, period, distance, when = 0.04, 1.2, 4.0, 12.0
    gauges = numpy.append(FACE + distance + numpy.arange(-0.8, 0.81, 0.1), FACE + 0.5)
    paddle = {"waves": {"kind": "focused", "depth": DEPTH, "height": height, "peak_period": period, "focus": {"distance": distance, "time": when}}}
    times, levels = run(program, base, flume(9.0, spacing, when + 2, gauges, paddle, (6.3, 8.0)))
    along = len(gauges) - 1
    found = numpy.array([crest(times, levels[:, g]) for g in range(along)])
    best = int(numpy.argmax(found[:, 1]))
    at_focus = along // 2
    step = 1 / (times[-1] - times[0])
    made = step * amplitudes(times, levels[:, along], numpy.arange(0.5 / period, 3 / period, step)).sum()
    some = numpy.array([1.0, 1.2, 1.45])
    left = amplitudes(times, levels[:, at_focus], some / period) / amplitudes(times, levels[:, along], some / period)
    print(
        "focused, crest %g m: %+.1f %% at the place asked for, %+.3f s late; %+.1f %% where it is highest, %+.2f m farther on"
        % (
            height,
            100 * ((found[at_focus, 1] - DEPTH) / height - 1),
            found[at_focus, 0] - when,
            100 * ((found[best, 1] - DEPTH) / height - 1),
            gauges[best] - gauges[at_focus],
        )
    )
    print(
        "focused, 0.5 m before the paddle: components sum to %+.1f %% of the crest; at the focus are %s"
        % (100 * (made / height - 1), ", ".join("%.0f %% of that at %g times the peak's frequency" % (100 * part, f) for part, f in zip(left, some)))
    )


def irregular(program, base, spacing):
    height, period = 0.08, 1.2
    gauges = [FACE + 1.0, FACE + 2.0, FACE + 3.0]
    paddle = {"waves": {"kind": "irregular", "depth": DEPTH, "significant_height": height, "peak_period": period}}
    times, levels = run(program, base, flume(6.6, spacing, 46 * period, gauges, paddle, (3.9, 8.0)))
    wanted = times > 6 * period
    found = 4 * levels[wanted].std(axis=0)
    print(
        "irregular, H_s = %g m: H_m0 %s over 40 peak periods"
        % (height, ", ".join("%+.1f %% at %g m" % (100 * (h / height - 1), x - FACE) for h, x in zip(found, gauges)))
    )


def flap(program, base, spacing):
    height, period = 0.06, 1.2
    length = 2 * math.pi / waves.wave_number(2 * math.pi / period)
    gauges = numpy.array([FACE + length * (0.75 + k / 8) for k in range(9)])
    paddle = {"point": [FACE, 0], "waves": {"kind": "regular", "direction": "pitch", "hinge": 0, "depth": DEPTH, "height": height, "period": period}}
    times, levels = run(program, base, flume(FACE + 3.5 * length, spacing, 14 * period, gauges, paddle, (FACE + 2.25 * length, 10 / period)))
    found = waves.measured(times, levels, gauges, period)
    print(
        "flap, H = %g m: height %+.1f %% at the paddle, %+.1f %% a wavelength on"
        % (height, 100 * (found["height at the paddle"] / height - 1), 100 * (found["height"] / height - 1))
    )


def poses_of(bag):
    table = Recording(bag).table("bodies/paddle/odom")
    return table.times, table.columns["position_x"]


def absorption(program, base, spacing):
    height, period, face, end = 0.04, 1.2, 0.5, 6.3
    omega = 2 * math.pi / period
    k = waves.wave_number(omega)
    gauges = numpy.concatenate([[face + 0.2], face + 0.8 + 2 * math.pi / k / 8 * numpy.arange(9)])
    paddle = {"waves": {"kind": "regular", "depth": DEPTH, "height": height, "period": period, "order": 2, "absorption": {"gauge": "g0"}}}
    times, levels = run(program, base, flume(end, spacing, 51 * period, gauges, paddle, face=face))

    def sent_and_come(begin, end):
        wanted = (times > begin) & (times <= end)
        first, _ = waves.harmonics(times[wanted], levels[wanted][:, 1:], period)
        x = gauges[1:] - face
        return numpy.linalg.lstsq(numpy.array([numpy.exp(1j * k * x), numpy.exp(-1j * k * x)]).T, first, rcond=None)[0]

    # before what comes back from the far wall has been to the paddle and back, and at the end
    before, after = sent_and_come(5 * period, 7 * period)[0], sent_and_come(45 * period, 51 * period)
    moments, places = poses_of(base + ".bag")
    last = moments > 46 * period
    stroke = numpy.ptp(places[moments < 8 * period])
    print(
        "absorption, H = %g m: %.1f %% of what comes back is sent again, waves %+.1f %% after 50 periods, drift %.1f %% of the stroke"
        % (height, 100 * abs(after[0] - before) / abs(after[1]), 100 * (abs(after[0] / before) - 1), 100 * abs(places[last].mean() - places[0]) / stroke)
    )


KINDS = {f.__name__: f for f in (solitary, started, standing, focused, irregular, flap, absorption)}


def main(program, directory, wanted):
    os.makedirs(directory, exist_ok=True)
    for text in wanted:
        kind, _, spacing = text.partition(",")
        if kind not in KINDS:
            sys.exit("wave_kinds.py: '%s' is no kind; it must be one of %s." % (kind, ", ".join(KINDS)))
        KINDS[kind](program, os.path.join(directory, text.replace(",", "_")), float(spacing or SPACING))
        sys.stdout.flush()
    return 0


if __name__ == "__main__":
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    sys.exit(main(sys.argv[1], sys.argv[2], sys.argv[3:] or list(KINDS)))
