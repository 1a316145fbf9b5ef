#!/usr/bin/env python3
"""A turbulent channel in 2-D, by the law of the wall on rough walls and Smagorinsky's eddies, against the logarithmic profile:

channel.py WAVETANK_RUN DIRECTORY [HALF,COEFFICIENT,ROUGHNESS]...

Water between two walls, of a half height of 0.2 m, which repeats itself along the channel and is driven by a force that the walls' stress balances at the friction velocity of 0.1 m/s. It
begins at an even speed, which is the mean of the profile. HALF: particles over the half height; COEFFICIENT: Smagorinsky's C_s; ROUGHNESS: of the walls, m. Told are the speeds that probes read in the middle of the rows over
what they would read of u_τ (ln(z/k_s)/0.41 + 8.5), up to half of the half height, in the mean over the second half of the time and both halves of the channel, the greatest and the root mean square of their errors, and the mean
speed over the profile's. Prints a table."""

import math
import os
import subprocess
import sys

import numpy
import yaml

HALF, FRICTION_VELOCITY, DENSITY, KARMAN, ROUGH = 0.2, 0.1, 1000.0, 0.41, 8.5
TIMES = 24  # half heights over the friction velocity, in which the profile develops and is looked at
BAR = 0.1
DEFAULTS = ("8,1,0.002",)


def profile(z, roughness):
    """m/s, at a distance from the wall, m."""
    return FRICTION_VELOCITY * (math.log(z / roughness) / KARMAN + ROUGH)


def as_read(z, count, roughness):
    """What a probe at z, m, reads of a profile: the mean of the rows by the kernel's weights along x, which over the concave profile beside a wall is not its middle's."""
    spacing = HALF / count
    rows = numpy.array([(k + 0.5) * spacing for k in range(count)])
    along = numpy.linspace(-4, 4, 401) * spacing
    q = numpy.hypot(along[:, None], (rows - z)[None, :]) / (2 * spacing)
    weights = (numpy.clip(1 - 0.5 * q, 0, None) ** 4 * (1 + 2 * q)).sum(axis=0)
    return float((weights * [profile(row, roughness) for row in rows]).sum() / weights.sum())


def mean_of_profile(roughness):
    return FRICTION_VELOCITY * ((math.log(HALF / roughness) - 1) / KARMAN + ROUGH)


def case_of(count, coefficient, roughness):
    spacing = HALF / count
    length = 4 * HALF
    heights = [(k + 0.5) * spacing for k in range(2 * count)]
    return {
        "title": "a rough channel",
        "dimensions": 2,
        "gravity": [FRICTION_VELOCITY**2 / HALF, 0],
        "duration": TIMES * HALF / FRICTION_VELOCITY,
        "fluid": {
            "density": DENSITY,
            "viscosity": 0.001,
            "sound_speed": 12 * profile(HALF, roughness),
            "spacing": spacing,
            "fill": [{"box": {"min": [0, 0], "max": [length, 2 * HALF]}}],
            "initial": {"u": str(mean_of_profile(roughness))},
        },
        "tank": {"box": {"size": [length, 2 * HALF], "closed": True}, "periodic": ["x"]},
        "numerics": {
            "artificial_viscosity": 0,
            "negative_pressure": "allowed",
            "turbulence": "smagorinsky",
            "smagorinsky_coefficient": coefficient,
            "walls": {"friction": {"law": "law_of_the_wall", "roughness": roughness}},
        },
        "instruments": {
            "rate": 20,
            "velocity_probes": [{"name": "v%d" % k, "position": [0.5 * length, z]} for k, z in enumerate(heights)],
        },
    }, heights


def speeds_of(bag, count):
    """Mean speed of each row from the wall on, of both halves, m/s."""
    from wavetank.recording import Recording

    recording = Recording(bag)
    means = []
    for k in range(2 * count):
        table = recording.table("velocities/v%d" % k)
        means.append(table.columns["velocity_x"][table.times > 0.5 * TIMES * HALF / FRICTION_VELOCITY].mean())
    return [0.5 * (means[k] + means[2 * count - 1 - k]) for k in range(count)]


def main(program, directory, cases):
    os.makedirs(directory, exist_ok=True)
    print(
        "| particles over the half height | C_s | k_s, m | rows' speeds over the profile's | greatest error | root mean square | bar | mean speed |\n|---|---|---|---|---|---|---|---|"
    )
    missed = False
    for text in cases:
        count, coefficient, roughness = int(text.split(",")[0]), *(float(number) for number in text.split(",")[1:])
        base = os.path.join(directory, "channel_" + text.replace(",", "_"))
        case, heights = case_of(count, coefficient, roughness)
        with open(base + ".yaml", "w") as file:
            yaml.safe_dump(case, file)
        with open(base + ".log", "w") as log:
            if subprocess.call([program, base + ".yaml", "--bag", base + ".bag"], stdout=log, stderr=log) != 0:
                sys.exit("channel.py: the simulation failed; '%s.log' tells why." % base)
        speeds = speeds_of(base + ".bag", count)
        ratios = [speed / as_read(z, count, roughness) for speed, z in zip(speeds, heights) if z < 0.5 * HALF]
        greatest = max(abs(ratio - 1) for ratio in ratios)
        missed = missed or greatest > BAR
        print(
            "| %d | %g | %g | %s | %.1f %% | %.1f %% | %.0f %% | %+.1f %% |"
            % (
                count,
                coefficient,
                roughness,
                ", ".join("%.3f" % ratio for ratio in ratios),
                100 * greatest,
                100 * math.sqrt(sum((ratio - 1) ** 2 for ratio in ratios) / len(ratios)),
                100 * BAR,
                100 * (sum(speeds) / count / mean_of_profile(roughness) - 1),
            ),
            flush=True,
        )
    return 1 if missed else 0


if __name__ == "__main__":
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    sys.exit(main(sys.argv[1], sys.argv[2], sys.argv[3:] or DEFAULTS))
