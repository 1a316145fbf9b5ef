#!/usr/bin/env python3
"""Friction of a flat plate in a stream, in 2-D, by the law of the wall, against lines of turbulent boundary layers:

flat_plate.py WAVETANK_RUN DIRECTORY [REYNOLDS,SPACING,ROUGHNESS]...

A plate of 1 m with sharp ends stands in the middle of a closed channel that repeats itself, in which the water begins at 1 m/s; the mean of the viscous force
on both sides from 1 to 3 s counts; the speed beside it is 1 m/s times the channel's height over what the plate leaves of it. SPACING and ROUGHNESS (of sand grains) in m. Smooth plates against Prandtl and Schlichting, C_F = 0.455/(log10 Re)^2.58,
rough ones against Schlichting, (1.89 + 1.62 log10(L/k_s))^-2.5. Prints a table."""

import math
import os
import subprocess
import sys

import yaml

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "scripts"))
from make_meshes import write_stl  # noqa: E402

LENGTH, SPEED, DENSITY = 1.0, 1.0, 1000.0  # m, m/s, kg/m³
CHANNEL = (4.0, 1.0)  # m
FIRST, LAST = 1.0, 3.0  # s
DEFAULTS = ("1e5,0.01,0", "1e6,0.01,0", "1e7,0.01,0", "1e7,0.01,0.001", "1e7,0.01,0.005")


def plate(spacing):
    """Four spacings thick, with ends of 1 : 6, from 1 m on; in 3-D, across the channel's plane."""
    half, middle, start = 2 * spacing, 0.5 * CHANNEL[1], 1.0
    taper = 6 * half
    outline = [
        (start, middle),
        (start + taper, middle - half),
        (start + LENGTH - taper, middle - half),
        (start + LENGTH, middle),
        (start + LENGTH - taper, middle + half),
        (start + taper, middle + half),
    ]
    near, far = [(x, -0.1, z) for x, z in outline], [(x, 0.1, z) for x, z in outline]
    triangles = []
    for k in range(len(outline)):
        after = (k + 1) % len(outline)
        triangles += [(near[k], far[after], near[after]), (near[k], far[k], far[after])]
    for k in range(1, len(outline) - 1):
        triangles += [(near[0], near[k], near[k + 1]), (far[0], far[k + 1], far[k])]
    return triangles


def case_of(reynolds, spacing, roughness, mesh):
    return {
        "title": "a flat plate in a stream",
        "dimensions": 2,
        "gravity": [0, -9.81],
        "duration": LAST,
        "fluid": {
            "density": DENSITY,
            "viscosity": DENSITY * SPEED * LENGTH / reynolds,
            "sound_speed": 20.0,
            "spacing": spacing,
            "fill": [{"box": {"min": [0, 0], "max": list(CHANNEL)}}],
            "initial": {"u": "1"},
        },
        "tank": {"box": {"size": list(CHANNEL), "closed": True}, "periodic": ["x"]},
        "bodies": [{"name": "plate", "mesh": mesh, "skin_friction": {"law": "law_of_the_wall", "roughness": roughness}}],
        "numerics": {"walls": {"friction": {"law": "none"}}},
        "instruments": {"rate": 50},
    }


def friction_of(bag):
    from wavetank.recording import Recording

    wrench = Recording(bag).table("bodies/plate/wrench/viscous")
    return wrench.columns["force_x"][(wrench.times > FIRST) & (wrench.times <= LAST)].mean()


def line_of(reynolds, roughness):
    if roughness > 0:
        return (1.89 + 1.62 * math.log10(LENGTH / roughness)) ** -2.5
    return 0.455 / math.log10(reynolds) ** 2.58


def main(program, directory, cases):
    os.makedirs(directory, exist_ok=True)
    print("| Re | Δx, m | k_s, m | C_F | by the line | error | bar |\n|---|---|---|---|---|---|---|")
    missed = False
    for text in cases:
        reynolds, spacing, roughness = (float(number) for number in text.split(","))
        base = os.path.join(directory, "plate_" + text.replace(",", "_"))
        write_stl(base + ".stl", plate(spacing))
        with open(base + ".yaml", "w") as file:
            yaml.safe_dump(case_of(reynolds, spacing, roughness, base + ".stl"), file)
        with open(base + ".log", "w") as log:
            if subprocess.call([program, base + ".yaml", "--bag", base + ".bag"], stdout=log, stderr=log) != 0:
                sys.exit("flat_plate.py: the simulation failed; '%s.log' tells why." % base)
        beside = SPEED * CHANNEL[1] / (CHANNEL[1] - 4 * spacing)
        found = friction_of(base + ".bag") / (0.5 * DENSITY * beside**2 * 2 * LENGTH)
        line = line_of(reynolds, roughness)
        bar = 0.2 if roughness > 0 else 0.15
        missed = missed or abs(found / line - 1) > bar
        print(
            "| %g | %g | %g | %.5f | %.5f | %+.0f %% | %.0f %% |" % (reynolds, spacing, roughness, found, line, 100 * (found / line - 1), 100 * bar), flush=True
        )
    return 1 if missed else 0


if __name__ == "__main__":
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    sys.exit(main(sys.argv[1], sys.argv[2], sys.argv[3:] or DEFAULTS))
