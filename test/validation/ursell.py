"""A circular cylinder that heaves half immersed in deep water, by linear theory (F. Ursell, Quarterly Journal of Mechanics and Applied Mathematics 2,
1949): a source on the axis and multipoles that leave the free surface as it is, so that the water goes with the cylinder."""

import math

import numpy

EULER = 0.57721566490153286
MULTIPOLES, POINTS = 12, 200


def principal_integral(w):
    """Of exp(-k w/K)/(k - K) over k from 0 to infinity, the principal value: -exp(-w) Ei(w) with Re w > 0, by its series."""
    total, term = EULER + numpy.log(w), numpy.ones_like(w)
    for n in range(1, 80):
        term = term * w / n
        total = total + term / n
    return -numpy.exp(-w) * total


class HalfImmersedCylinder:
    """radius, m; omega: of the oscillation, rad/s. Per metre of width: added_mass (kg/m), damping (kg/(m s)), and radiated, the damping by the energy of the
    waves far away, which is to be the same."""

    def __init__(self, radius, omega, density=1000.0, gravity=9.81):
        k = omega**2 / gravity
        theta = (numpy.arange(POINTS) + 0.5) * 0.5 * math.pi / POINTS  # from straight down to the surface
        zeta = radius * numpy.exp(-1j * theta)  # depth minus i times x
        integral, wave = principal_integral(k * zeta), numpy.exp(-k * zeta)
        potentials = [integral.real + 1j * math.pi * wave.real]
        speeds = [((-1 - k * zeta * integral).real + 1j * math.pi * (-k * zeta * wave).real) / radius]
        for m in range(1, MULTIPOLES + 1):  # in units of the radius
            potentials.append(numpy.cos(2 * m * theta) + k * radius / (2 * m - 1) * numpy.cos((2 * m - 1) * theta))
            speeds.append((-2 * m * numpy.cos(2 * m * theta) - k * radius * numpy.cos((2 * m - 1) * theta)) / radius)
        strengths = numpy.linalg.lstsq(numpy.array(speeds).T, numpy.cos(theta).astype(complex), rcond=None)[0]
        potential = strengths @ numpy.array(potentials)
        integral = 2 * radius * numpy.sum(potential * numpy.cos(theta)) * 0.5 * math.pi / POINTS
        self.added_mass = -density * integral.real
        self.damping = -density * omega * integral.imag
        self.radiated = density * omega * math.pi**2 * abs(strengths[0]) ** 2
