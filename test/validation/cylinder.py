#!/usr/bin/env python3
"""A round cylinder in a stream at Re = 100, in 2-D and without a free surface:

cylinder.py WAVETANK_RUN DIRECTORY [PARTICLES,WIDTH]...

A stream of 1 m/s comes in 5 diameters before the cylinder, of 0.1 m, and leaves under a pressure of zero 13 diameters behind it; PARTICLES over the diameter,
walls without friction WIDTH diameters apart. Means from 50 to 80 diameters' time on, in which vortices are shed: the drag's and the amplitude of the lift's
coefficients, and the Strouhal number. In unbounded water they are 1.33 to 1.40, 0.3 and 0.16 to 0.17. Prints a table."""

import math
import os
import subprocess
import sys

import numpy
import yaml

DIAMETER, SPEED, DENSITY, REYNOLDS = 0.1, 1.0, 1000.0, 100.0  # m, m/s, kg/m³
BEFORE, BEHIND = 5.0, 13.0  # diameters
FIRST, LAST = 50.0, 80.0  # D/U
DEFAULTS = ("12,12",)


def case_of(particles, width):
    length, height = DIAMETER * (BEFORE + BEHIND), DIAMETER * width
    middle = 0.5 * height
    return {
        "title": "a cylinder in a stream",
        "dimensions": 2,
        "gravity": [0, 0],
        "duration": LAST * DIAMETER / SPEED,
        "fluid": {
            "density": DENSITY,
            "viscosity": DENSITY * SPEED * DIAMETER / REYNOLDS,
            "sound_speed": 15.0,
            "spacing": DIAMETER / particles,
            "current": [SPEED, 0],
            "fill": [{"seed": [DIAMETER, middle], "level": height}],
        },
        "tank": {"box": {"size": [length, height], "closed": True}},
        "bodies": [
            {
                "name": "cylinder",
                "mesh": "shape://cylinder?radius=%g&length=0.4&facets=64" % (0.5 * DIAMETER),
                "translation": [DIAMETER * BEFORE, 0, middle],
                "rotation": [90, 0, 0],
                "skin_friction": {"law": "viscous"},
            }
        ],
        "openings": [
            {"name": "upstream", "kind": "inlet", "centre": [0, middle], "normal": [1, 0], "size": [1, height], "velocity": SPEED},
            {"name": "downstream", "kind": "pressure", "centre": [length, middle], "normal": [-1, 0], "size": [1, height], "head": 0},
        ],
        "numerics": {
            "walls": {"friction": {"law": "none"}},
            "negative_pressure": "allowed",
            "shifting": "michel",
            "artificial_viscosity": 0,
            "viscosity_model": "morris",
        },
        "instruments": {"rate": 50},
    }


def coefficients_of(bag):
    from wavetank.recording import Recording

    wrench = Recording(bag).table("bodies/cylinder/wrench")
    times = wrench.times * SPEED / DIAMETER
    wanted = times > FIRST + 1e-6
    drag, lift = wrench.array("force_x", "force_z")[wanted].T / (0.5 * DENSITY * SPEED**2 * DIAMETER)
    lift = lift - lift.mean()
    zeros = 16 * len(lift)
    spectrum = abs(numpy.fft.rfft(lift * numpy.hanning(len(lift)), zeros))
    strouhal = numpy.fft.rfftfreq(zeros, times[1] - times[0])[spectrum.argmax()]
    return drag.mean(), math.sqrt(2) * lift.std(), strouhal


def main(program, directory, cases):
    os.makedirs(directory, exist_ok=True)
    print("| D/Δx | width, D | drag | lift | Strouhal |\n|---|---|---|---|---|")
    for text in cases:
        particles, width = (float(number) for number in text.split(","))
        base = os.path.join(directory, "cylinder_" + text.replace(",", "_"))
        with open(base + ".yaml", "w") as file:
            yaml.safe_dump(case_of(particles, width), file)
        with open(base + ".log", "w") as log:
            if subprocess.call([program, base + ".yaml", "--bag", base + ".bag"], stdout=log, stderr=log) != 0:
                sys.exit("cylinder.py: the simulation failed; '%s.log' tells why." % base)
        print("| %g | %g | %.3f | %.3f | %.4f |" % ((particles, width) + coefficients_of(base + ".bag")), flush=True)
    return 0


if __name__ == "__main__":
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    sys.exit(main(sys.argv[1], sys.argv[2], sys.argv[3:] or DEFAULTS))
