#!/usr/bin/env python3
"""SPHERIC 2 by every method that changes what its probes read, and a table of it: usage: pressures.py WAVETANK_RUN CASE FIGURES FOLDER [SPACING [ROW]...]

A row is a name of ROWS, or `terms`, `schemes` or `all_rows`. Each run's samples are kept in FOLDER, and a run that is there is not made again; the table
tells by which version each was made."""

import csv
import importlib.machinery
import importlib.util
import os
import re
import resource
import subprocess
import sys

SAMPLED = ("P1", "P2", "P3", "P4", "P5", "P6", "P7", "P8")
BEFORE = {"numerics/acoustic_damping": 0, "fluid/sound_speed": 40}  # as the case was before it had the damper
DISC = 0.02  # m
# what a row sets over the case, by its name; a row ends when its last key figure has been passed
TERMS = {
    "before": BEFORE,
    "damper": {**BEFORE, "numerics/acoustic_damping": 4},
    "sound_speed": {**BEFORE, "fluid/sound_speed": 25},
    "friction": {**BEFORE, "numerics/walls/friction/law": "law_of_the_wall"},
    "turbulence": {**BEFORE, "numerics/turbulence": "smagorinsky"},
    "sensor_discs": {**BEFORE, **{"instruments/pressure_probes/%d/diameter" % n: DISC for n in range(4)}},
    "default": {},
    "all": {
        "numerics/walls/friction/law": "law_of_the_wall",
        "numerics/turbulence": "smagorinsky",
        **{"instruments/pressure_probes/%d/diameter" % n: DISC for n in range(4)},
    },
}
SCHEMES = {
    scheme
    + "_"
    + law: {**BEFORE, "numerics/scheme": scheme, "numerics/shifting": law, **({} if scheme == "delta_sph" else {"numerics/density_diffusion": "none"})}
    for scheme in ("delta_sph", "riemann_parshikov", "riemann_ale")
    for law in ("none", "michel")
}
SCHEMES["default_michel"] = {"numerics/shifting": "michel"}
ROWS = {**TERMS, **SCHEMES}
ENDS = {**{name: 2.5 for name in TERMS}, **{name: 1.0 for name in SCHEMES}}  # s: to the last impulse of all probes, or of those in front


class Wrong(Exception):
    """What cannot be run or read."""


def plot_probes():
    """The program beside, whose figures these are."""
    path = os.path.join(os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__)))), "scripts", "plot_probes")
    loader = importlib.machinery.SourceFileLoader("plot_probes", path)
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader("plot_probes", loader))
    loader.exec_module(module)
    return module


def version_of(case):
    """The commit that the case stands in."""
    described = subprocess.run(
        ["git", "-C", os.path.dirname(case), "describe", "--always", "--dirty", "--exclude=*"], stdout=subprocess.PIPE, universal_newlines=True
    )
    return described.stdout.strip() or "of no repository"


def rows_of(words):
    names = []
    for word in words or ["terms"]:
        if word in ("terms", "schemes", "all_rows"):
            names += list({"terms": TERMS, "schemes": SCHEMES, "all_rows": ROWS}[word])
        elif word in ROWS:
            names.append(word)
        else:
            raise Wrong("no row is named '%s': there are %s, and terms, schemes, all_rows" % (word, ", ".join(ROWS)))
    return list(dict.fromkeys(names))


def run(program, case, folder, name, spacing):
    """The bag of a row, and what was told of its run; made if it is not there."""
    bag = os.path.join(folder, "%s_%g.bag" % (name, spacing))
    facts = bag[:-4] + ".csv"
    if not os.path.exists(facts):
        print("running %s at %g m" % (name, spacing), file=sys.stderr, flush=True)
        command = [program, case, "--bag", bag, "--duration", "%g" % ENDS[name], "--set", "fluid/spacing=%r" % spacing]
        for key, value in ROWS[name].items():
            command += ["--set", "%s=%s" % (key, value)]
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, universal_newlines=True)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        with open(bag[:-4] + ".log", "w", encoding="utf-8") as log:
            log.write(done.stdout)
        if done.returncode:
            told = [line for line in done.stdout.splitlines() if line.startswith("wavetank_run: ") and not line.startswith("wavetank_run: warning: ")]
            raise Wrong("%s at %g m ended with code %d: %s" % (name, spacing, done.returncode, told[-1] if told else "it told nothing"))
        steps = re.search(r"^steps +(\d+)", done.stdout, re.MULTILINE)
        taken = after.ru_utime - before.ru_utime + after.ru_stime - before.ru_stime
        with open(facts, "w", encoding="utf-8") as file:
            csv.writer(file).writerows([("version", version_of(case)), ("steps", steps.group(1) if steps else ""), ("processor_time", "%.1f" % taken)])
    with open(facts, encoding="utf-8") as file:
        return bag, dict(csv.reader(file))


def by_kind(figures, series, kind):
    """A key figure of an instrument: measured, simulated; None where it has none."""
    for figure in figures.get(series.name, []):
        if figure.kind == kind:
            return figure.measured(), figure.simulated(series)
    return None


def levels(figures, recorded, end):
    """Of each gauge with levels on record the names, times and differences from them in %, up to `end`."""
    found = []
    for series in recorded:
        known = [figure for figure in figures.get(series.name, []) if figure.kind == "level" and figure.time <= end]
        if known:
            found.append((series.name, [figure.time for figure in known], differences([(f.measured(), f.simulated(series)) for f in known])))
    return found


def table(head, rows):
    print("| " + " | ".join(head) + " |")
    print("|" + "---|" * len(head))
    for row in rows:
        print("| " + " | ".join(row) + " |")
    print(flush=True)


def differences(pairs):
    return ", ".join("%+.0f" % (100 * (simulated / measured - 1)) for measured, simulated in pairs)


def main():
    if len(sys.argv) < 5:
        print(__doc__, file=sys.stderr)
        return 2
    program, case, figures_path, folder = sys.argv[1:5]
    spacing = float(sys.argv[5]) if len(sys.argv) > 5 else 0.0275
    names = rows_of(sys.argv[6:])
    os.makedirs(folder, exist_ok=True)
    tool = plot_probes()
    figures = tool.read_figures(figures_path)
    rows, on_top, failed, gauges = [], [], [], {}
    for name in names:
        try:
            bag, facts = run(program, case, folder, name, spacing)
        except Wrong as wrong:
            print("pressures: %s" % wrong, file=sys.stderr, flush=True)
            failed.append([name, str(wrong)])
            continue
        record = tool.read_bag(bag, None)
        probes = {series.name: series for series in record.pressures}
        heights = levels(figures, record.levels, ENDS[name])
        gauges.update((gauge, times) for gauge, times, _ in heights if len(times) > len(gauges.get(gauge, [])))
        found = {kind: [by_kind(figures, probes[probe], kind) for probe in SAMPLED[:4]] for kind in ("peak", "noise", "impulse", "arrival")}
        mean = sum(tool.impulse(probes[probe], 0.6, 1.0) for probe in SAMPLED[:4]) / 1.6
        rows.append(
            [
                "`%s`" % name,
                ", ".join("%.1f" % (simulated / 1000) for _, simulated in found["peak"]),
                ", ".join("%.0f" % simulated for _, simulated in found["noise"]),
                differences(found["impulse"]),
                "%.0f" % mean,
                "%+.0f" % (1000 * (found["arrival"][0][1] - found["arrival"][0][0])),
                "; ".join(difference for _, _, difference in heights),
                "%s, %.2f" % (facts["steps"], float(facts["processor_time"]) / max(int(facts["steps"] or 0), 1)),
                facts["version"],
            ]
        )
        if ENDS[name] >= 2.5:
            on_top.append("`%s` %s" % (name, differences([by_kind(figures, probes[probe], "impulse") for probe in SAMPLED[4:]])))
    print("SPHERIC 2 at Δx = %g m\n" % spacing)
    table(
        [
            "row",
            "peaks of P1 to P4, kPa",
            "noise, Pa",
            "impulses to 1.0 s, %",
            "mean of P1 to P4 over 0.6–1.0 s, Pa",
            "P1 above 500 Pa later by, ms",
            "levels, %",
            "steps, s of processor time each",
            "version",
        ],
        rows,
    )
    if gauges:
        print("Levels: %s s.\n" % "; ".join("%s at %s" % (gauge, ", ".join("%g" % time for time in times)) for gauge, times in gauges.items()))
    if on_top:
        print("Impulses of P5 to P8 over 1.0–2.5 s, %%: %s.\n" % "; ".join(on_top))
    for name, sentence in failed:
        print("`%s` did not end well: %s\n" % (name, sentence))
    return 1 if failed else 0


if __name__ == "__main__":
    try:
        sys.exit(main())
    except Wrong as wrong:
        sys.exit("pressures: %s" % wrong)
