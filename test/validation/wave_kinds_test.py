#!/usr/bin/env python3
"""What wave_kinds and waves make of gauges whose waves are those of linear theory."""

import contextlib
import io
import math
import os
import re
import sys
import tempfile
import unittest
from unittest import mock

import numpy

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import wave_kinds  # noqa: E402
import waves  # noqa: E402
from wavetank.recording import Table  # noqa: E402
from waves import DEPTH, FACE, wave_number  # noqa: E402

PERIOD = 1.2  # s
TIMES = numpy.arange(0, 14.0, 0.01)


def table(elevation):
    """Of the gauges of the case that was written last; elevation: of times (a column) and places (a row), m."""
    gauges = wave_kinds.flume.cases[-1]["instruments"]["wave_gauges"]
    levels = DEPTH + elevation(TIMES[:, None], numpy.array([gauge["position"][0] for gauge in gauges]))
    return Table("gauges", (TIMES * 1e9).round().astype(numpy.int64), {gauge["name"]: levels[:, n] for n, gauge in enumerate(gauges)}, {})


def told(kind, elevation):
    """The numbers that a kind prints, of these waves."""

    def flume(*arguments, **others):
        flume.cases.append(real(*arguments, **others))
        return flume.cases[-1]

    real, flume.cases = wave_kinds.flume, []
    recording = mock.Mock()
    recording.return_value.table.side_effect = lambda name: table(elevation) if name == "gauges" else recording.nothing(name)
    with tempfile.TemporaryDirectory() as folder, contextlib.redirect_stdout(io.StringIO()) as output:
        with mock.patch("wave_kinds.flume", flume), mock.patch("waves.Recording", recording):
            kind("true", os.path.join(folder, "case"), 0.02)
    recording.nothing.assert_not_called()
    return [float(number) for number in re.findall(r"[-+]\d+\.\d+|\d+(?= %)", output.getvalue())]


class Kinds(unittest.TestCase):
    def test_regular_waves_have_the_height_that_is_asked_for(self):
        k, omega = wave_number(2 * math.pi / PERIOD), 2 * math.pi / PERIOD
        at_paddle, farther = told(wave_kinds.flap, lambda t, x: 0.03 * numpy.cos(omega * t - k * x))
        self.assertAlmostEqual(at_paddle, 0.0, delta=0.15)
        self.assertAlmostEqual(farther, 0.0, delta=0.15)

    def test_a_focused_wave_is_the_sum_of_its_components(self):
        frequencies = numpy.linspace(0.5, 3.0, 200) / PERIOD
        sizes = numpy.exp(-0.5 * ((frequencies * PERIOD - 1.2) / 0.25) ** 2)
        sizes *= 0.04 / sizes.sum()
        for left in (1.0, 0.5):  # of them beyond the gauge near the paddle

            def elevation(t, x):
                total = 0.0
                for frequency, size in zip(frequencies, sizes):
                    omega = 2 * math.pi * frequency
                    near = x < FACE + 1
                    total = total + numpy.where(near, size, left * size) * numpy.cos(wave_number(omega) * (x - FACE - 4.0) - omega * (t - 12.0))
                return total

            crest, late, highest, farther, made, *parts = told(wave_kinds.focused, elevation)
            self.assertAlmostEqual(crest, 100 * (left - 1), delta=1.0)
            self.assertAlmostEqual(highest, 100 * (left - 1), delta=1.0)
            self.assertAlmostEqual(late, 0.0, delta=0.01)
            self.assertEqual(farther, 0.0)
            self.assertAlmostEqual(made, 0.0, delta=3.0)
            self.assertEqual(len(parts), 3)
            for part in parts:
                self.assertAlmostEqual(part, 100 * left, delta=3.0)


class Velocities(unittest.TestCase):
    def test_of_linear_theory_are_off_by_nothing(self):
        k, omega = wave_number(2 * math.pi / PERIOD), 2 * math.pi / PERIOD
        gauges = FACE + numpy.arange(9) * 0.2
        levels = DEPTH + 0.03 * numpy.cos(omega * TIMES[:, None] - k * (gauges - FACE))
        velocities = 0.03 * omega * math.cosh(0.5 * k * DEPTH) / math.sinh(k * DEPTH) * numpy.cos(omega * TIMES)
        self.assertNotIn("velocity", waves.measured(TIMES, levels, gauges, PERIOD))
        self.assertAlmostEqual(waves.measured(TIMES, levels, gauges, PERIOD, velocities)["velocity"], 0.0, delta=1e-3)
        self.assertAlmostEqual(waves.measured(TIMES, levels, gauges, PERIOD, 1.1 * velocities)["velocity"], 0.1, delta=1e-3)


if __name__ == "__main__":
    unittest.main()
