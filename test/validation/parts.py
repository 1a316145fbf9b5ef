#!/usr/bin/env python3
"""Whether cases are the same to the bit in any number of parts: usage: parts.py PROGRAM ROOT FOLDER [CASE]...

Each of the package's cases (or those named, by their files' names) makes some 200 steps in 2, 3, 4 and 7 parts on one device. Snapshots must be equal to
the byte, and so must all that the bags have but the case and the status of the run: every sample, pose and cloud. Exit code 1 if any differs, or if there was
nothing to compare."""

import hashlib
import os
import re
import subprocess
import sys

import rosbag

STEPS = 200
PARTS = (2, 3, 4, 7)
# what makes a case short enough to be run five times, or longer than a few blocks
CHANGES = {
    "boat_in_a_sea": ["fluid/spacing=0.05"],
    "dam_break_2d": ["fluid/spacing=0.025"],
    "dam_break_3d": ["fluid/spacing=0.04"],
    "floating_box": ["fluid/spacing=0.025"],
    "paddle_wheel": ["fluid/spacing=0.01"],
    "regular_waves": ["fluid/spacing=0.02"],
    "robot_paddle": ["fluid/spacing=0.03"],
    "sloshing_tank": ["fluid/spacing=0.006"],
    "wave_basin_robot": ["fluid/spacing=0.05"],
}
# more of one case each: schemes, shifting laws, walls, integrators, a periodic tank
VARIANTS = {
    "dam_break_2d": {
        "riemann_parshikov, michel, runge_kutta_4": ["scheme=riemann_parshikov", "shifting=michel", "integrator=runge_kutta_4", "density_diffusion=none"],
        "riemann_ale, sun": ["scheme=riemann_ale", "shifting=sun", "density_diffusion=none"],
        "antuono, oger, predictor_corrector": ["density_diffusion=antuono", "shifting=oger", "integrator=predictor_corrector"],
        "lind, double": ["shifting=lind", "precision=double"],
        "monaghan, ghosts": ["shifting=monaghan", "walls/method=ghost"],
        "semi_analytical elements": ["walls/elements=semi_analytical"],
    },
    "hydrostatic_2d": {"periodic": ["tank/periodic=[x]"]},
}
IGNORED = ("/wavetank/status", "/wavetank/case")


def run(program, case, folder, name, parts, duration, changes):
    """The snapshot's bytes and a digest of the bag; or the sentence with which it was refused."""
    base = os.path.join(folder, "%s_%d" % (re.sub(r"\W+", "_", name), parts))
    for path in (base + ".bag", base + ".snapshot"):
        if os.path.exists(path):
            os.remove(path)
    device = ["--device", ",".join(["auto"] * parts)] if parts > 1 else []
    command = [program, case, "--duration", repr(duration), "--bag", base + ".bag", "--save", base + ".snapshot", "--clouds", "--quiet"] + device
    for change in changes:
        command += ["--set", change]
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, universal_newlines=True)
    if done.returncode not in (0, 2):
        return None, None, "ended with %d: %s" % (done.returncode, done.stderr.strip().replace("the water is to be cut", "it is to be cut")[-300:])
    if done.returncode != 0:
        return None, None, done.stderr.strip().splitlines()[-1]
    digest, messages = hashlib.md5(), 0
    with rosbag.Bag(base + ".bag") as bag:
        for topic, message, time in bag.read_messages(raw=True):
            if topic in IGNORED:
                continue
            digest.update(("%s %s " % (topic, time)).encode() + message[1])
            messages += 1
    with open(base + ".snapshot", "rb") as file:
        return file.read(), (digest.hexdigest(), messages), ""


def compare(program, case, folder, name, changes):
    """A row of the table, and whether all were the same."""
    options = [word for change in changes for word in ("--set", change)]
    checked = subprocess.run([program, case, "--check"] + options, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, universal_newlines=True).stdout
    step = float(re.search(r"^time step +(\S+) s", checked, re.M).group(1))
    particles = re.search(r"^particles +(\d+)", checked, re.M).group(1)
    row, first, compared, good = [name, particles], None, 0, True
    for parts in PARTS:
        state, samples, sentence = run(program, case, folder, name, parts, STEPS * step, changes)
        if sentence:
            too_short = "the water is to be cut into" in sentence  # before the first step
            row.append("too short" if too_short else sentence)
            good = good and too_short
        elif first is None:
            first = (parts, state, samples)
            row.append("%d messages" % samples[1])
        else:
            same = (state == first[1], samples == first[2])
            compared += 1
            row.append("same" if all(same) else "other " + ("samples" if same[0] else "state"))
            good = good and all(same)
    return row, good and compared > 0


def main():
    if len(sys.argv) < 4:
        print(__doc__, file=sys.stderr)
        return 2
    program, root, folder = sys.argv[1:4]
    os.makedirs(folder, exist_ok=True)
    config = os.path.join(root, "config")
    names = sys.argv[4:] or sorted(name[:-5] for name in os.listdir(config) if name.endswith(".yaml"))
    print("| case | particles at first | " + " | ".join("%d parts" % parts for parts in PARTS) + " |")
    print("|---" * (2 + len(PARTS)) + "|", flush=True)
    good = True
    for name in names:
        kinds = {name: CHANGES.get(name, [])}
        for variant, words in VARIANTS.get(name, {}).items():
            kinds["%s: %s" % (name, variant)] = CHANGES.get(name, []) + [word if word.startswith("tank/") else "numerics/" + word for word in words]
        for title, changes in kinds.items():
            row, same = compare(program, os.path.join(config, name + ".yaml"), folder, title, changes)
            print("| " + " | ".join(row) + " |", flush=True)
            good = good and same
    return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main())
