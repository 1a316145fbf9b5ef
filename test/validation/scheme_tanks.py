#!/usr/bin/env python3
"""Tanks by every scheme and shifting law of the particle shifting paper, and tables of them: usage: scheme_tanks.py PROGRAMS ROOT FOLDER at_rest|dam_break

at_rest: config/hydrostatic_2d.yaml to t √(g/H) = 20. dam_break: config/dam_break_3d.yaml to 3 s at 0.04 m. Each run's log is kept in FOLDER, and a run
that is there is not made again; tables tell by which version each was made."""

import os
import re
import subprocess
import sys

SCHEMES = ("delta_sph", "riemann_parshikov", "riemann_ale")
LAWS = ("none", "michel", "sun", "oger", "lind", "monaghan")
# of the dam break: as it was before it had the damper
BREAK = ["fluid/spacing=0.04", "fluid/sound_speed=40", "numerics/acoustic_damping=0"]
# Riemann problems bring what dissipation there is
RIEMANN = ["numerics/density_diffusion=none"]


def version(root):
    described = subprocess.run(["git", "-C", root, "describe", "--always", "--dirty", "--exclude=*"], stdout=subprocess.PIPE, universal_newlines=True)
    return described.stdout.strip() or "of no repository"


def log_of(command, path, root):
    """What a run printed, its exit code and the version that made it as the last lines."""
    if not os.path.exists(path):
        print("running", os.path.basename(path)[:-4], file=sys.stderr, flush=True)
        done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, universal_newlines=True)
        with open(path + ".part", "w", encoding="utf-8") as log:
            log.write("%s\nended with code %d\nmade by %s\n" % (done.stdout, done.returncode, version(root)))
        os.rename(path + ".part", path)
    with open(path, encoding="utf-8") as log:
        return log.read()


def found(pattern, log, otherwise="–"):
    """The last match's group."""
    matches = re.findall(pattern, log)
    return matches[-1] if matches else otherwise


def table(head, rows):
    print("| " + " | ".join(head) + " |")
    print("|" + "---|" * len(head))
    for row in rows:
        print("| " + " | ".join(row) + " |", flush=True)
    print()


def overrides(scheme, law):
    return ["numerics/scheme=" + scheme, "numerics/shifting=" + law] + ([] if scheme == "delta_sph" else RIEMANN)


def at_rest(programs, root, folder):
    rows = []
    for scheme in SCHEMES:
        for law in LAWS:
            path = os.path.join(folder, "at_rest_%s_%s.log" % (scheme, law))
            command = [os.path.join(programs, "tank_at_rest"), os.path.join(root, "config/hydrostatic_2d.yaml"), path[:-4] + ".csv", "20"]
            log = log_of(command + overrides(scheme, law), path, root)
            rows.append(
                [
                    "`%s`, %s" % (scheme, law),
                    found(r"([\d.]+) in the mean of the second half\n", log),
                    found(r"([\d.]+) at the most, [\d.]+ in the mean", log),
                    found(r"potential energy: (\S+) at the most", log),
                    found(r"changed by (\S+) %", log),
                    found(r"guard hits: (\d+)", log),
                    found(r"made by (\S+)", log),
                ]
            )
    table(
        [
            "",
            "L2 error, mean of the second half, ρgH",
            "greatest",
            "kinetic over potential energy, greatest",
            "potential energy changed, %",
            "guard hits",
            "version",
        ],
        rows,
    )


def dam_break(programs, root, folder):
    rows = []
    for scheme in SCHEMES:
        for law in LAWS:
            path = os.path.join(folder, "dam_break_%s_%s.log" % (scheme, law))
            command = [os.path.join(programs, "wavetank_run"), os.path.join(root, "config/dam_break_3d.yaml"), "--duration", "3"]
            for override in BREAK + overrides(scheme, law):
                command += ["--set", override]
            log = log_of(command, path, root)
            ended = found(r"ended with code (\d+)", log)
            stopped = found(r"wavetank_run: (particles in violation: .*), at t = ", log, "")
            rows.append(
                [
                    "`%s`, %s" % (scheme, law),
                    "to the end" if ended == "0" else "stopped at %s s: %s" % (found(r"at t = ([\d.]+) s, step", log), stopped),
                    found(r"\nsteps +(\d+)", log),
                    found(r"guard hits +(\d+)", log),
                    found(r"fastest particle moves at ([\d.]+) m/s", log, "never"),
                    found(r"made by (\S+)", log),
                ]
            )
    table(["", "ran", "steps", "guard hits", "speed of a particle when one is first above 6 m/s", "version"], rows)


def main():
    if len(sys.argv) != 5 or sys.argv[4] not in ("at_rest", "dam_break"):
        print(__doc__, file=sys.stderr)
        return 2
    programs, root, folder = [os.path.abspath(word) for word in sys.argv[1:4]]
    os.makedirs(folder, exist_ok=True)
    os.chdir(folder)  # where a run that is stopped leaves its snapshot
    {"at_rest": at_rest, "dam_break": dam_break}[sys.argv[4]](programs, root, folder)
    return 0


if __name__ == "__main__":
    sys.exit(main())
