#!/usr/bin/env python3
"""Holds moving tanks, wave makers and floating bodies against the records of experiments: motion_records.py CASE RECORDS BAG PICTURE.

RECORDS is the folder of the records (docs/validation.md says where they come from), BAG what wavetank_run wrote for the case. Prints a table, draws ours
over the reference, and ends with 1 where a bar is missed.
"""

import argparse
import os
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import compare_motion as compare  # noqa: E402

IMPACTS = (2.375, 4.067, 5.671, 7.303)  # s, SPHERIC 10's pressure peaks; the first three are the test, for the fourth depends on what they left
SEARCH = 0.3  # s on either side of a recorded peak, less than half of the roll's period
BLOW = 0.01  # s: the greatest mean over so long tells an impact's time without the drops that fly ahead of it
DRY = (0.6, 0.7)  # s after an impact, when the sensor is in the air again and shows by how much its zero has drifted
IMPACT = (0.05, 0.2)  # s before and after its peak over which an impact's impulse is taken: the peak and most of the push that follows
WAVES_AT_BOX = (6.3, 8.1)  # s, when Hadzic's box is moved by the waves and was filmed


def percent(part):
    return "%+.1f %%" % (100 * part)


def spheric10(records, bag, table):
    reference = compare.read_record(os.path.join(records, "spheric10_pressure.csv"))
    ours = compare.read_series(bag, "pressures")["S1"]
    for number, about in enumerate(IMPACTS, start=1):
        tested = number <= 3
        expected, height = compare.peak(reference, about, 0.05)
        found, our_height = compare.peak(ours, about, SEARCH)
        if not ours.times[-1] >= expected + IMPACT[1]:
            table.add("impact %d" % number, "%.3f s" % expected, "not reached", "", "", False if tested else None)
            continue
        late = found - expected
        table.add("impact %d, time of peak" % number, "%.3f s" % expected, "%.3f s" % found, "%+.3f s" % late, "0.03 s", abs(late) <= 0.03 if tested else None)
        blow, our_blow = (compare.peak(compare.running_mean(record, BLOW), about, SEARCH)[0] for record in (reference, ours))
        table.add("impact %d, time of the greatest mean over 10 ms" % number, "%.3f s" % blow, "%.3f s" % our_blow, "%+.3f s" % (our_blow - blow))
        whole = compare.impulse(reference, expected - IMPACT[0], expected + IMPACT[1])
        our_whole = compare.impulse(ours, found - IMPACT[0], found + IMPACT[1])
        error = our_whole / whole - 1
        table.add("impact %d, impulse" % number, "%.0f Pa s" % whole, "%.0f Pa s" % our_whole, percent(error), "30 %", abs(error) <= 0.3 if tested else None)
        if reference.times[-1] >= expected + DRY[1]:
            level = whole - IMPACT[1] * compare.mean(reference, expected + DRY[0], expected + DRY[1])
            table.add(
                "impact %d, impulse over the sensor's zero afterwards" % number, "%.0f Pa s" % level, "%.0f Pa s" % our_whole, percent(our_whole / level - 1)
            )  # fmt: skip
        table.add("impact %d, peak" % number, "%.0f Pa" % height, "%.0f Pa" % our_height, percent(our_height / height - 1))
    curves = [("measured", reference, "k"), ("wavetank", ours, "C0")]
    end = min(ours.times[-1], reference.times[-1])
    panels = [("pressure at S1", "Pa", curves, (0, end))]
    return panels + [("impact %d" % n, "Pa", curves, (t - 0.1, t + 0.4)) for n, t in enumerate(IMPACTS, start=1) if t < end]


def hadzic(records, bag, table):
    levels, box = compare.read_series(bag, "levels"), compare.read_motions(bag)["box"]
    panels = []
    for gauge, name, bar in (("x1160mm", "1.16", 0.15), ("x2660mm", "2.66", None)):
        reference = compare.read_record(os.path.join(records, "hadzic2005_gauge_x%s.csv" % name))
        # Our elevation is about the level before the waves, as a gauge is zeroed.
        ours = levels[gauge].scaled(offset=-compare.mean(levels[gauge], 0.5, 2.0))
        error = compare.relative_error(ours, reference)
        table.add(
            "elevation at x = %s m, RMS error" % name, "range %.1f mm" % (1e3 * compare.peak_to_peak(reference)),
            "%.1f mm" % (1e3 * compare.rms_error(ours, reference)), "%.1f %%" % (100 * error), bar and "15 %", bar and error < bar,
        )  # fmt: skip
        panels.append(("elevation at x = %s m" % name, "m", [("measured", reference, "k"), ("wavetank", ours, "C0")], (2, 10)))
    # Positive roll in the record raises the side away from the flap, which our pitch lowers.
    for what, component, sign, unit in (("heave", "z", 1, "m"), ("roll", "pitch", -1, "deg"), ("surge", "x", 1, "m")):
        reference = compare.read_record(os.path.join(records, "hadzic2005_%s.csv" % what))
        ours = compare.Record(box.times, sign * box.values(component))
        ours = ours.scaled(offset=-compare.mean(ours, 3.0, 5.0))  # afloat, and the waves not there yet
        panels.append((what + " of the box", unit, [("measured", reference, "k"), ("wavetank", ours, "C0")], (5, 9)))
        begin, end = WAVES_AT_BOX
        tested = what != "surge"
        related = compare.correlation(ours, reference, begin, end)
        table.add(what + ", correlation", "1", "%.3f" % related, "", "0.9" if tested else "", related > 0.9 if tested else None)
        wanted, found = compare.peak_to_peak(reference, begin, end), compare.peak_to_peak(ours, begin, end)
        error = found / wanted - 1
        table.add(
            what + ", peak to peak", "%.3g %s" % (wanted, unit), "%.3g %s" % (found, unit), percent(error), "20 %" if tested else "",
            abs(error) <= 0.2 if tested else None,
        )  # fmt: skip
    return panels


def piston(records, bag, table):
    levels = compare.read_series(bag, "levels")
    panels = []
    for gauge, name, tested in (("x1380mm", "1.38", True), ("x2830mm", "2.83", True), ("x4120mm", "4.12", False)):
        reference = compare.read_record(os.path.join(records, "wavemaker_flume.csv"), "gauge_x%s_m" % name)
        ours = levels[gauge].scaled(offset=-compare.mean(levels[gauge], 0.3, 0.9))
        error = compare.relative_error(ours, reference, 0, 10)
        table.add(
            "elevation at x = %s m, RMS error" % name, "range %.1f mm" % (1e3 * compare.peak_to_peak(reference)),
            "%.1f mm" % (1e3 * compare.rms_error(ours, reference, 0, 10)), "%.1f %%" % (100 * error), "15 %" if tested else "",
            error < 0.15 if tested else None,
        )  # fmt: skip
        panels.append(("elevation at x = %s m" % name, "m", [("measured", reference, "k"), ("wavetank", ours, "C0")], (0, 10)))
    return panels


def cube(records, bag, table):
    reference = compare.read_record(os.path.join(records, "canelas_one_cube_x.csv"), "x_centre_m")
    motion = compare.read_motions(bag)["cube"]
    ours = compare.Record(motion.times, motion.values("x"))
    for time, place in zip(reference.times, reference.values):
        if time > ours.times[-1]:
            table.add("x of the centre at %.3f s" % time, "%.3f m" % place, "not reached", "", "0.1 m", False)
            continue
        found = float(ours.at(time))  # before the start: where it stood
        error = found - place
        table.add("x of the centre at %.3f s" % time, "%.3f m" % place, "%.3f m" % found, "%+.3f m" % error, "0.1 m", abs(error) <= 0.1)
    return [("x of the cube's centre", "m", [("measured", reference, "ko"), ("wavetank", ours, "C0")], None)]


CASES = {"spheric10": spheric10, "hadzic": hadzic, "piston": piston, "cube": cube}


def main():
    parser = argparse.ArgumentParser(prog="motion_records.py", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("case", choices=sorted(CASES))
    parser.add_argument("records", help="folder of the records")
    parser.add_argument("bag")
    parser.add_argument("picture")
    options = parser.parse_args()
    table = compare.Table()
    panels = CASES[options.case](options.records, options.bag, table)
    table.print()
    compare.draw(options.picture, panels)
    return 1 if table.failed else 0


if __name__ == "__main__":
    try:
        sys.exit(main())
    except Exception as failure:
        if type(failure).__name__ != "Failure":  # of this module, plot_probes or plot_motion
            raise
        print("motion_records.py: %s" % failure, file=sys.stderr)
        sys.exit(2)
