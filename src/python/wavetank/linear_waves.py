"""Linear theory of waves on water of even depth."""

import math

GRAVITY = 9.81  # m/s²


def wave_number(frequency, depth, gravity=GRAVITY):
    """1/m: the root of ω² = g k tanh kd, by bisection. frequency in Hz, depth in m."""
    target = (2 * math.pi * frequency) ** 2 * depth / gravity
    low, high = 0.0, max(target, math.sqrt(target)) + 1.0
    for _ in range(100):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if middle * math.tanh(middle) < target else (low, middle)
    return low / depth


def group_speed(frequency, depth, gravity=GRAVITY):
    """Of waves' energy, m/s."""
    k = wave_number(frequency, depth, gravity)
    twice = 2 * k * depth
    share = twice / math.sinh(twice) if twice < 300 else 0.0
    return 0.5 * (2 * math.pi * frequency / k) * (1 + share)
