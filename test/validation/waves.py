#!/usr/bin/env python3
"""Regular waves by a piston in a flume, against theory:

waves.py WAVETANK_RUN DIRECTORY [PERIOD,HEIGHT,SPACING,ORDER]...

Water 0.4 m deep, a flume of three wavelengths and a damping zone of one and a quarter more. Gauges an eighth of a wavelength apart from one wavelength on; of
their records from the time at which the waves are there the heights from trough to crest, period by period, and the harmonics of the period, by least squares over whole periods.
Told are the height a wavelength from the paddle and, by its decay over the gauges, at the paddle; twice the amplitude of the first harmonic that comes, in the middle of the gauges (of steep
waves it is less than the height, of which the third harmonic is a part); the loss a wavelength, the wavelength that its phases have over that of linear theory and of Stokes' third order for the
height found, the reflected wave, and of the second harmonic
what travels by itself; and of the velocity at mid-depth under the first gauge what it is off linear theory by, which makes of each of the gauge's harmonics
a n ω cosh k z / sinh k d: root mean squares over that of theory, without the means (in a closed flume the mean brings back what waves carry).
Prints a table."""

import math
import os
import subprocess
import sys

import numpy
import yaml

from wavetank.recording import Recording

DEPTH, GRAVITY, FACE = 0.4, 9.81, 0.3  # m, m/s², m: of the piston at rest
PERIODS = 6  # looked at
DEFAULTS = ("1.2,0.1,0.0125,1", "1.2,0.1,0.0125,2", "0.9,0.1,0.0125,2", "1.6,0.1,0.0125,2")


def wave_number(omega):
    k = omega**2 / GRAVITY
    for _ in range(200):
        k = 0.5 * (k + omega**2 / (GRAVITY * math.tanh(k * DEPTH)))
    return k


def third_order(omega, amplitude):
    """The wave number of a wave of finite height (Stokes, third order): ω² = g k tanh kd (1 + (ka)² (8 + cosh 4kd − 2 tanh² kd)/(8 sinh⁴ kd))."""
    k = wave_number(omega)
    for _ in range(200):
        kd = k * DEPTH
        growth = 1 + (k * amplitude) ** 2 * (8 + math.cosh(4 * kd) - 2 * math.tanh(kd) ** 2) / (8 * math.sinh(kd) ** 4)
        k = 0.5 * (k + omega**2 / (GRAVITY * math.tanh(kd) * growth))
    return k


def case_of(period, height, spacing, order):
    length = 2 * math.pi / wave_number(2 * math.pi / period)
    end = FACE + 4.25 * length
    twice = wave_number(4 * math.pi / period)
    slowest = (2 * math.pi / period / twice) * (1 + 2 * twice * DEPTH / math.sinh(2 * twice * DEPTH))  # the group's speed of free second harmonics
    travel = 2.625 * length / slowest + period
    gauges = [FACE + length * (1 + k / 8) for k in range(14)]
    case = {
        "title": "regular waves",
        "dimensions": 2,
        "gravity": [0, -GRAVITY],
        "duration": travel + (PERIODS + 2) * period,
        "fluid": {
            "sound_speed": 20.0,
            "spacing": spacing,
            "fill": [{"box": {"min": [FACE, 0], "max": [end, DEPTH]}}],
            "damping": [{"box": {"min": [FACE + 3 * length, 0], "max": [end, 0.7]}, "direction": [1, 0], "strength": 10 / period}],
        },
        "tank": {"box": {"size": [end, 0.7]}},
        "bodies": [
            {
                "name": "piston",
                "box": {"min": [FACE - 0.1, 0], "max": [FACE, 0.7]},
                "motion": "prescribed",
                "prescribed": {"waves": {"kind": "regular", "depth": DEPTH, "height": height, "period": period, "order": order}},
            }
        ],
        "numerics": {"walls": {"slip": "free_slip"}, "artificial_viscosity": 0.005},
        "instruments": {
            "rate": 100,
            "wave_gauges": [{"name": "g%d" % k, "position": [x]} for k, x in enumerate(gauges)],
            "velocity_probes": [{"name": "v0", "position": [gauges[0], 0.5 * DEPTH]}],
        },
    }
    return case, numpy.array(gauges), length


def levels_of(bag):
    """Times, and the levels of every gauge at each."""
    gauges = Recording(bag).table("gauges")
    return gauges.times, gauges.array(*gauges.columns)


def velocities_of(bag):
    """Horizontal velocities of the probe, which is sampled with the gauges."""
    return Recording(bag).table("velocities/v0").columns["velocity_x"]


def harmonics(times, levels, period):
    """Complex amplitudes of the first two, a row each, a column a gauge: η = Re Σ a exp(−iωt)."""
    omega = 2 * math.pi / period
    columns = [numpy.ones_like(times)]
    for n in (1, 2, 3):
        columns += [numpy.cos(n * omega * times), numpy.sin(n * omega * times)]
    fit = numpy.linalg.lstsq(numpy.array(columns).T, levels, rcond=None)[0]
    return fit[1] + 1j * fit[2], fit[3] + 1j * fit[4]


def heights(times, levels, period):
    """From trough to crest, m, of each gauge the mean over whole periods."""
    step = int(round(period / (times[1] - times[0])))
    whole = len(times) // step * step
    return numpy.ptp(levels[:whole].reshape(-1, step, levels.shape[1]), axis=1).mean(axis=0)


def off_linear_theory(times, level, velocity, period):
    """Of a velocity at mid-depth under a gauge, both over whole periods: root mean square of the difference over that of theory."""
    theory = numpy.zeros_like(times)
    for n in (1, 2, 3, 4):
        omega = 2 * math.pi * n / period
        k = wave_number(omega)
        turn = numpy.exp(1j * omega * times)
        amplitude = 2 * numpy.mean(level * numpy.conj(turn))
        theory += omega * math.cosh(0.5 * k * DEPTH) / math.sinh(k * DEPTH) * numpy.real(amplitude * turn)
    return float(numpy.sqrt(numpy.mean((velocity - velocity.mean() - theory) ** 2) / numpy.mean(theory**2)))


def measured(times, levels, gauges, period, velocities=None):
    """By name; of the velocity only where there are velocities, those of a probe under the first gauge."""
    omega = 2 * math.pi / period
    k, free = wave_number(omega), wave_number(2 * omega)
    end = times[-1]
    wanted = times > end - PERIODS * period
    first, second = harmonics(times[wanted], levels[wanted], period)
    x = gauges - FACE
    k_found = numpy.polyfit(x, numpy.unwrap(numpy.angle(first)), 1)[0]
    # incident and reflected, with the wave number found; bound and free of the second harmonic
    waves = numpy.linalg.lstsq(numpy.array([numpy.exp(1j * k_found * x), numpy.exp(-1j * k_found * x)]).T, first, rcond=None)[0]
    twice = numpy.linalg.lstsq(numpy.array([numpy.exp(2j * k_found * x), numpy.exp(1j * free * x)]).T, second, rcond=None)[0]
    length = 2 * math.pi / k
    slope, at_paddle = numpy.polyfit(x, numpy.log(heights(times[wanted], levels[wanted], period)), 1)
    found = {
        "height": math.exp(at_paddle + slope * length),
        "height at the paddle": math.exp(at_paddle),
        "first harmonic": 2 * abs(waves[0]),
        "length": k / k_found - 1,
        "length of third order": third_order(omega, abs(waves[0])) / k_found - 1,
        "loss": -slope * length,
        "reflected": abs(waves[1] / waves[0]),
        "free": 2 * abs(twice[1]),
    }
    if velocities is not None:
        found["velocity"] = off_linear_theory(times[wanted], levels[wanted][:, 0], velocities[wanted], period)
    return found


def main(program, directory, cases):
    os.makedirs(directory, exist_ok=True)
    print(
        "| T, s | H, m | order | Δx, m | height at the paddle | a wavelength on | first harmonic | wavelength over linear | over third-order theory | loss a wavelength | reflected | free second harmonic | velocity off linear theory |\n|---|---|---|---|---|---|---|---|---|---|---|---|---|---|"
    )
    for text in cases:
        period, height, spacing, order = (float(number) for number in text.split(","))
        base = os.path.join(directory, "waves_" + text.replace(",", "_"))
        case, gauges, _ = case_of(period, height, spacing, int(order))
        with open(base + ".yaml", "w") as file:
            yaml.safe_dump(case, file)
        with open(base + ".log", "w") as log:
            if subprocess.call([program, base + ".yaml", "--bag", base + ".bag"], stdout=log, stderr=log) != 0:
                sys.exit("waves.py: the simulation failed; '%s.log' tells why." % base)
        times, levels = levels_of(base + ".bag")
        found = measured(times, levels, gauges, period, velocities_of(base + ".bag"))
        print(
            "| %g | %g | %d | %g | %+.1f %% | %+.1f %% | %+.1f %% | %+.1f %% | %+.1f %% | %.1f %% | %.1f %% | %.1f %% | %.1f %% |"
            % (
                period,
                height,
                order,
                spacing,
                100 * (found["height at the paddle"] / height - 1),
                100 * (found["height"] / height - 1),
                100 * (found["first harmonic"] / height - 1),
                100 * found["length"],
                100 * found["length of third order"],
                100 * found["loss"],
                100 * found["reflected"],
                100 * found["free"] / height,
                100 * found["velocity"],
            ),
            flush=True,
        )
    return 0


if __name__ == "__main__":
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    sys.exit(main(sys.argv[1], sys.argv[2], sys.argv[3:] or DEFAULTS))
