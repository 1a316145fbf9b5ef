"""Least squares of forces and motions: what a body's hydrodynamic coefficients are taken from. All in SI units, angles in rad."""

import math

import numpy

from wavetank import Failure

HARMONICS = 3  # fitted, of which the first is used
LEAST_SAMPLES = 20  # a period


class Harmonics:
    """mean and complex amplitudes of x = mean + Re Σ a_n exp(i n ω t), n = 1, 2, ...; residual: rms of what is left."""

    def __init__(self, mean, amplitudes, residual):
        self.mean, self.amplitudes, self.residual = mean, amplitudes, residual


def fit_harmonics(times, values, period, count=HARMONICS):
    """By least squares; the times are to span whole periods. Raises Failure if they are too few."""
    if len(times) < LEAST_SAMPLES:
        raise Failure("there are only %d samples of the motion to fit; %d are needed" % (len(times), LEAST_SAMPLES))
    phase = 2 * math.pi / period * numpy.asarray(times)
    columns = [numpy.ones_like(phase)]
    for n in range(1, count + 1):
        columns += [numpy.cos(n * phase), numpy.sin(n * phase)]
    matrix = numpy.column_stack(columns)
    found = numpy.linalg.lstsq(matrix, values, rcond=None)[0]
    left = values - matrix @ found
    return Harmonics(found[0], found[1::2] - 1j * found[2::2], float(numpy.sqrt(numpy.mean(left**2))))


def whole_periods(times, period, first, last):
    """Which samples lie within the last whole periods of [first, last]; the one at their beginning is left out, which has the phase of the end."""
    count = math.floor((last - first) / period + 1e-6)
    if count < 1:
        raise Failure("%g s are less than one period of %g s to fit" % (last - first, period))
    return (times > last - count * period + 1e-9) & (times <= last + 1e-9), count


def fit_oscillation(motion, force, period, first, last, stiffness):
    """Added mass and damping of F = F₀ − A ẍ − B ẋ − C x in a steady oscillation of the period, C being known.

    motion, force: (times, values) each with its own clock. Returns a dictionary: added_mass, damping, motion amplitude, periods fitted; residual: rms of what
    the harmonics leave of the force, over the amplitude of its first; second_harmonic of the force likewise."""
    fits = []
    for times, values in (motion, force):
        wanted, count = whole_periods(times, period, first, last)
        fits.append(fit_harmonics(times[wanted], values[wanted], period))
    moved, pushed = fits
    amplitude = abs(moved.amplitudes[0])
    if not amplitude > 0:
        raise Failure("the body does not move with the period of %g s" % period)
    omega = 2 * math.pi / period
    ratio = pushed.amplitudes[0] / moved.amplitudes[0]  # ω²A − C − iωB
    return {
        "added_mass": float((ratio.real + stiffness) / omega**2),
        "damping": float(-ratio.imag / omega),
        "amplitude": float(amplitude),
        "periods_fitted": count,
        "residual": float(pushed.residual / abs(pushed.amplitudes[0])),
        "second_harmonic": float(abs(pushed.amplitudes[1] / pushed.amplitudes[0])),
    }


def swings_of(times, offsets):
    """When a swing about zero comes over to the other side, and the extremes between: swings below a tenth of the greatest may be noise, and do not count."""
    least = 0.1 * numpy.abs(offsets).max()
    far = numpy.nonzero(numpy.abs(offsets) > least)[0]
    sides = numpy.sign(offsets[far])
    turns = far[1:][sides[1:] != sides[:-1]]
    extremes = [float(numpy.abs(offsets[begin:end]).max()) for begin, end in zip(turns[:-1], turns[1:])]
    return times[turns], extremes


def swing(times, parameters):
    """Solutions of x″ = −p₁ x′ − p₂ |x′| x′ − k (x − x₀) at the times, a column for each column of parameters (x, x′ at the first time, x₀, k, p₁, p₂)."""
    start, speed, rest, k, linear, quadratic = parameters

    def rate(x, v):
        return v, -linear * v - quadratic * numpy.abs(v) * v - k * (x - rest)

    x, v = start.copy(), speed.copy()
    result = numpy.empty((len(times), len(start)))
    result[0] = x
    longest = 0.1 / math.sqrt(max(float(k.max()), 1e-12))
    for n, gap in enumerate(numpy.diff(times), 1):
        steps = max(1, math.ceil(gap / longest))
        h = gap / steps
        for _ in range(steps):  # Runge and Kutta's, of fourth order
            x1, v1 = rate(x, v)
            x2, v2 = rate(x + 0.5 * h * x1, v + 0.5 * h * v1)
            x3, v3 = rate(x + 0.5 * h * x2, v + 0.5 * h * v2)
            x4, v4 = rate(x + h * x3, v + h * v3)
            x = x + h / 6 * (x1 + 2 * x2 + 2 * x3 + x4)
            v = v + h / 6 * (v1 + 2 * v2 + 2 * v3 + v4)
        result[n] = x
    return result


def first_guess(times, values):
    """Of the parameters of swing(); the extremes between crossings tell rest, period and decay."""
    rest = values[len(values) // 2 :].mean()
    marks, extremes = swings_of(times, values - rest)
    if len(marks) < 3:
        raise Failure(
            "the body swings through rest only %d times in %.3g s; 3 are needed: make the run longer, or release it farther off"
            % (len(marks), times[-1] - times[0])
        )
    half = float(numpy.diff(marks).mean())
    decay = math.log(extremes[0] / extremes[-1]) / (len(extremes) - 1)
    speed = numpy.polyfit(times[:5] - times[0], values[:5], 1)[0]
    return numpy.array([values[0], speed, rest, (math.pi / half) ** 2, max(2 * decay / half, 0.0), 0.0])


def fit_decay(times, values, rounds=40):
    """Of a body that swings to rest: x″ + p₁ x′ + p₂ |x′| x′ + k (x − x₀) = 0 by least squares over the whole record (Levenberg and Marquardt).

    Returns a dictionary: period (s, of the damped swing), stiffness_over_mass k (1/s²), linear p₁ (1/s), quadratic p₂ (1/m or 1/rad), rest x₀, swings, and
    residual: rms of what is left, over the greatest distance from rest."""
    times, values = numpy.asarray(times, dtype=float), numpy.asarray(values, dtype=float)
    if len(times) < LEAST_SAMPLES:
        raise Failure("there are only %d samples of the motion to fit; %d are needed" % (len(times), LEAST_SAMPLES))
    found = first_guess(times, values)
    size = numpy.abs(values - found[2]).max()
    omega = math.sqrt(found[3])
    scale = numpy.array([size, size * omega, size, found[3], omega, 1.0 / size])
    step, caution = 1e-6, 1e-3
    left = values - swing(times, found[:, None])[:, 0]
    for _ in range(rounds):
        tried = found[:, None] + numpy.column_stack([numpy.zeros(6), numpy.diag(step * scale)])
        solutions = swing(times, tried)
        slopes = (solutions[:, 1:] - solutions[:, :1]) / step
        square, pull = slopes.T @ slopes, slopes.T @ left
        while True:
            change = numpy.linalg.solve(square + caution * numpy.diag(numpy.diag(square) + 1e-12 * square.max()), pull)
            candidate = found + change * scale
            with numpy.errstate(all="ignore"):  # a step too far is tried again, shorter
                ours = values - swing(times, candidate[:, None])[:, 0] if candidate[3] > 0 else numpy.full(len(values), numpy.inf)
            better = numpy.isfinite(ours).all() and ours @ ours <= left @ left
            if better or caution > 1e8:
                break
            caution *= 10
        if not better:
            break
        gained = left @ left - ours @ ours
        found, left, caution = candidate, ours, max(caution / 10, 1e-12)
        if numpy.abs(change).max() < 1e-10 or gained <= 1e-15 * (left @ left):
            break
    damped = found[3] - found[4] ** 2 / 4
    if not damped > 0:
        raise Failure("the body does not swing: its damping is above the critical one")
    return {
        "period": 2 * math.pi / math.sqrt(damped),
        "stiffness_over_mass": float(found[3]),
        "linear": float(found[4]),
        "quadratic": float(found[5]),
        "rest": float(found[2]),
        "swings": len(swings_of(times, values - found[2])[1]),
        "residual": float(numpy.sqrt(numpy.mean(left**2)) / numpy.abs(values - found[2]).max()),
    }


def fit_drag(speeds, forces):
    """D = d₁ U + d₂ |U| U by least squares; of one speed d₂ alone. Returns linear d₁, quadratic d₂ and residual: rms of what is left over the greatest force."""
    speeds, forces = numpy.asarray(speeds, dtype=float), numpy.asarray(forces, dtype=float)
    columns = [numpy.abs(speeds) * speeds] + ([speeds] if len(speeds) > 1 else [])
    matrix = numpy.column_stack(columns)
    found = numpy.linalg.lstsq(matrix, forces, rcond=None)[0]
    left = forces - matrix @ found
    return {
        "linear": float(found[1]) if len(found) > 1 else 0.0,
        "quadratic": float(found[0]),
        "residual": float(numpy.sqrt(numpy.mean(left**2)) / numpy.abs(forces).max()),
    }
