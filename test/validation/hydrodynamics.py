#!/usr/bin/env python3
"""What the tool hydrodynamics finds, against theory:

hydrodynamics.py HYDRODYNAMICS DIRECTORY cylinder [PARTICLES]   a cylinder that heaves half immersed in 2-D, against Ursell (1949)
hydrodynamics.py HYDRODYNAMICS DIRECTORY sphere [PARTICLES]     a sphere that surges in a closed box full of water, against potential theory
hydrodynamics.py HYDRODYNAMICS DIRECTORY cube [PARTICLES]       a cube towed face on at Re = 10⁴ in a closed box full of water, against the handbook

PARTICLES over the radius or the cube's side, 10, 5 and 6 unless given. Prints a table; exit code 1 if a bar is missed."""

import math
import os
import subprocess
import sys

import yaml

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from ursell import HalfImmersedCylinder  # noqa: E402

RADIUS, DENSITY, GRAVITY = 0.1, 1000.0, 9.81  # m, kg/m³, m/s²
WAVE_NUMBERS = (0.5, 1.0, 1.5)  # times the radius
DEPTH, HALF = 0.6, 1.6  # m, of the cylinder's tank: as deep as half the longest waves, and so long that they are not back before the end
BOX = 0.8  # m, side of the sphere's box
SIDE, SPEED, REYNOLDS, CHANNEL, DRAG = 0.1, 1.0, 1e4, (1.4, 0.5, 0.5), 1.05  # m, m/s, 1, m, 1: of the cube


def period_of(wave_number):
    return 2 * math.pi / math.sqrt(GRAVITY * wave_number / RADIUS)


def cylinder_case(particles):
    return {
        "title": "a half immersed cylinder",
        "dimensions": 2,
        "gravity": [0, -GRAVITY],
        "duration": 1.0,
        "fluid": {"density": DENSITY, "sound_speed": 24.0, "spacing": RADIUS / particles, "fill": [{"box": {"min": [-HALF, 0], "max": [HALF, DEPTH]}}]},
        "tank": {"box": {"origin": [-HALF, 0], "size": [2 * HALF, DEPTH + 0.3]}},
        "bodies": [
            {
                "name": "cylinder",
                "mesh": "shape://cylinder?radius=%g&length=0.4&facets=64" % RADIUS,
                "translation": [0, 0, DEPTH],
                "rotation": [90, 0, 0],
                "motion": "fixed",
            }
        ],
        "numerics": {"walls": {"slip": "free_slip"}, "artificial_viscosity": 0.005, "packing": {"settling": 2}},
    }


def sphere_case(particles):
    return {
        "title": "a sphere in a box full of water",
        "gravity": [0, 0, 0],
        "duration": 1.0,
        "fluid": {"density": DENSITY, "sound_speed": 6.0, "spacing": RADIUS / particles, "fill": [{"seed": [0.05, 0.05, 0.05], "level": BOX}]},
        "tank": {"box": {"size": [BOX] * 3, "closed": True}},
        "bodies": [{"name": "sphere", "mesh": "shape://sphere?radius=%g" % RADIUS, "translation": [BOX / 2] * 3, "motion": "fixed"}],
        "numerics": {"walls": {"slip": "free_slip"}, "artificial_viscosity": 0.005, "negative_pressure": "allowed"},
    }


def cube_case(particles):
    middle = 0.5 * CHANNEL[1]
    low, high = ([x, middle + half, middle + half] for x, half in ((0.1, -0.5 * SIDE), (0.1 + SIDE, 0.5 * SIDE)))
    return {
        "title": "a towed cube",
        "gravity": [0, 0, 0],
        "duration": 1.0,
        "fluid": {
            "density": DENSITY,
            "viscosity": DENSITY * SPEED * SIDE / REYNOLDS,
            "sound_speed": 10.0,
            "spacing": SIDE / particles,
            "fill": [{"seed": [0.05, 0.05, 0.05], "level": CHANNEL[2]}],
        },
        "tank": {"box": {"size": list(CHANNEL), "closed": True}},
        "bodies": [{"name": "cube", "box": {"min": low, "max": high}, "motion": "fixed"}],
        "numerics": {
            "walls": {"friction": {"law": "none"}},
            "negative_pressure": "allowed",
            "shifting": "michel",
            "artificial_viscosity": 0,
            "viscosity_model": "morris",
        },
    }


def run_tool(tool, directory, name, case, arguments):
    folder = os.path.join(directory, "hydrodynamics_" + name)
    os.makedirs(folder, exist_ok=True)
    path = os.path.join(folder, name + ".yaml")
    with open(path, "w") as file:
        yaml.safe_dump(case, file)
    if subprocess.call([sys.executable, tool, path, "--out", os.path.join(folder, "out"), "--again"] + arguments) != 0:
        sys.exit("hydrodynamics.py: the tool failed: see above.")
    with open(os.path.join(folder, "out", "hydrodynamics.yaml")) as file:
        return yaml.safe_load(file)


def percent(part):
    return "%+.1f %%" % (100 * part)


def cylinder(tool, directory, particles):
    periods = ",".join("%.6g" % period_of(each) for each in WAVE_NUMBERS)
    options = ["--body", "cylinder", "--oscillate", "heave", "--periods", periods, "--amplitude", "0.01", "--rise", "1", "--wait", "1", "--cycles", "2"]
    found = run_tool(tool, directory, "cylinder_%g" % particles, cylinder_case(particles), options)["oscillate"]["heave"]
    missed = False
    print(
        "| Ka | T, s | added mass over ρπa²/2 | by Ursell | error | damping over ωρπa²/2 | by Ursell | error | residual |\n|---|---|---|---|---|---|---|---|---|"
    )
    for wave_number, row in zip(WAVE_NUMBERS, found["results"]):
        omega = 2 * math.pi / row["period"]
        theory, unit = HalfImmersedCylinder(RADIUS, omega, DENSITY, GRAVITY), DENSITY * math.pi * RADIUS**2 / 2
        errors = row["added_mass"] / theory.added_mass - 1, row["damping"] / theory.damping - 1
        missed |= max(map(abs, errors)) > 0.15
        print(
            "| %g | %.3f | %.3f | %.3f | %s | %.3f | %.3f | %s | %.3f |"
            % (
                wave_number, row["period"], row["added_mass"] / unit, theory.added_mass / unit, percent(errors[0]),
                row["damping"] / unit / omega, theory.damping / unit / omega, percent(errors[1]), row["residual"],
            )
        )  # fmt: skip
    (stiffness,) = found["hydrostatic_stiffness"].values()
    print(
        "hydrostatic stiffness %.1f N/m, by theory 2ρga = %.1f N/m: %s"
        % (stiffness, 2 * DENSITY * GRAVITY * RADIUS, percent(stiffness / (2 * DENSITY * GRAVITY * RADIUS) - 1))
    )
    return missed


def sphere(tool, directory, particles):
    options = ["--body", "sphere", "--oscillate", "surge", "--periods", "0.5", "--amplitude", "0.01", "--rise", "1", "--wait", "0", "--cycles", "2"]
    (row,) = run_tool(tool, directory, "sphere_%g" % particles, sphere_case(particles), options)["oscillate"]["surge"]["results"]
    theory = DENSITY * 2 / 3 * math.pi * RADIUS**3
    error = row["added_mass"] / theory - 1
    share = (RADIUS / (BOX / 2)) ** 3
    print("| added mass, kg | ρV/2 | error | in a sphere as wide as the box | damping over ωρV/2 | residual |\n|---|---|---|---|---|---|")
    print(
        "| %.4f | %.4f | %s | %s | %.3f | %.3f |"
        % (row["added_mass"], theory, percent(error), percent((1 + 2 * share) / (1 - share) - 1), row["damping"] / theory / (4 * math.pi), row["residual"])
    )
    return abs(error) > 0.10


def cube(tool, directory, particles):
    options = ["--body", "cube", "--tow", "surge", "--speeds", "%g" % SPEED, "--distance", "1.05"]
    (row,) = run_tool(tool, directory, "cube_%g" % particles, cube_case(particles), options)["tow"]["surge"]["results"]
    error = row["drag_coefficient"] / DRAG - 1
    print("| drag coefficient | handbook | error | standard deviation of the force |\n|---|---|---|---|")
    print("| %.3f | %.2f | %s | %.1f %% |" % (row["drag_coefficient"], DRAG, percent(error), 100 * row["standard_deviation"] / row["drag"]))
    return abs(error) > 0.20


CASES = {"cylinder": (cylinder, 10), "sphere": (sphere, 5), "cube": (cube, 6)}


def main(arguments):
    if len(arguments) < 3 or arguments[2] not in CASES:
        print(__doc__, file=sys.stderr)
        return 2
    measure, particles = CASES[arguments[2]]
    return 1 if measure(arguments[0], arguments[1], float(arguments[3]) if len(arguments) > 3 else particles) else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
