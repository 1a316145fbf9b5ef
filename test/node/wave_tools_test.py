#!/usr/bin/env python3
"""waves and reflection: their figures against signals whose waves are known, and the scripts as a user runs them on a bag made here."""

import importlib.machinery
import importlib.util
import math
import os
import shutil
import subprocess
import sys
import tempfile
import unittest

import numpy
import rosbag
import rospy
from geometry_msgs.msg import Point
from wavetank.msg import WaveGaugeArray

SCRIPTS = os.path.join(os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__)))), "scripts")
sys.dont_write_bytecode = True


def load(name):
    loader = importlib.machinery.SourceFileLoader(name, os.path.join(SCRIPTS, name))
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader(name, loader))
    loader.exec_module(module)
    return module


waves, reflection = load("waves"), load("reflection")
DEPTH = 0.4
TIMES = numpy.arange(0, 60, 0.02)


def travelling(amplitude, frequency, x, way=1, phase=0.3):
    k = reflection.wave_number(frequency, DEPTH)
    return amplitude * numpy.cos(2 * math.pi * frequency * TIMES - way * k * x + phase)


def gauge(name, x, surface):
    return waves.Gauge(name, (x, 0, 0), TIMES, DEPTH + surface)


class Waves(unittest.TestCase):
    def test_of_a_sine(self):
        found = waves.figures(gauge("a", 0, 0.05 * numpy.sin(2 * math.pi * TIMES / 1.25)))
        self.assertEqual(found["waves"], 46)  # the crossing at 0 is not seen from below
        for key in ("mean", "third", "greatest"):
            self.assertAlmostEqual(found[key], 0.1, delta=1e-3)
        self.assertAlmostEqual(found["period"], 1.25, delta=1e-4)
        self.assertAlmostEqual(found["peak"], 1.25, delta=0.03)
        self.assertAlmostEqual(found["spectral"], 4 * 0.05 / math.sqrt(2), delta=1e-4)
        self.assertAlmostEqual(found["level"], DEPTH, delta=1e-4)

    def test_the_significant_height_is_of_the_highest_third(self):
        # nine waves of 1 s, whose heights are 1 to 9 cm
        surface = sum(numpy.where((TIMES >= n) & (TIMES < n + 1), 0.005 * (n + 1), 0) for n in range(9)) * numpy.sin(2 * math.pi * TIMES)
        whole = waves.Gauge("a", (0, 0, 0), TIMES[:451], surface[:451] - 1e-9)
        heights, periods = waves.zero_crossing_waves(whole)
        self.assertEqual(len(heights), 8)
        numpy.testing.assert_allclose(heights[1:], numpy.arange(2, 9) * 0.01, atol=1e-3)
        self.assertAlmostEqual(waves.figures(whole)["third"], 0.07, delta=1e-3)  # of 6, 7 and 8 cm; the ninth does not end

    def test_the_spectrum_has_the_variance(self):
        surface = travelling(0.03, 0.7, 0) + travelling(0.02, 1.1, 0)
        frequencies, density = waves.spectrum(gauge("a", 0, surface))
        self.assertAlmostEqual(density.sum() * frequencies[1], 0.5 * (0.03**2 + 0.02**2), delta=1e-5)
        self.assertAlmostEqual(frequencies[density.argmax()], 0.7, delta=0.02)


class Reflection(unittest.TestCase):
    def test_wave_numbers(self):
        for frequency in (0.05, 0.5, 1.0, 3.0):
            k = reflection.wave_number(frequency, DEPTH)
            self.assertAlmostEqual(9.81 * k * math.tanh(k * DEPTH) / (2 * math.pi * frequency) ** 2, 1, delta=1e-9)

    def test_parts_two_ways(self):
        for places in ((0, 0.3, 0.7), (2.0, 2.25, 2.4, 3.1)):
            gauges = [
                gauge(str(x), x, travelling(0.05, 0.8, x) + travelling(0.01, 0.8, x, -1, 1.1) + travelling(0.02, 1.3, x) + travelling(0.002, 1.3, x, -1))
                for x in places
            ]
            self.assertLess(reflection.part(gauges, DEPTH)[:, 0].max(), 1.2)
            rows = reflection.part(gauges, DEPTH, band=(0.1, 3))
            for frequency, incident, reflected in ((0.8, 0.05, 0.01), (1.3, 0.02, 0.002)):
                row = rows[numpy.abs(rows[:, 0] - frequency).argmin()]
                self.assertAlmostEqual(row[0], frequency, delta=0.01)
                self.assertAlmostEqual(row[1], incident, delta=0.02 * incident)
                self.assertAlmostEqual(row[2] / row[1], reflected / incident, delta=0.01)

    def test_gauges_in_the_other_order_see_the_other_way(self):
        gauges = [gauge(str(x), x, travelling(0.05, 0.8, x) + travelling(0.01, 0.8, x, -1)) for x in (0.7, 0.3, 0.0)]
        row = reflection.part(gauges, DEPTH)[0]
        self.assertLess(row[1], row[2])

    def test_half_a_wavelength_is_refused(self):
        half = math.pi / reflection.wave_number(0.8, DEPTH)
        gauges = [gauge(str(k), k * half, travelling(0.05, 0.8, k * half)) for k in range(3)]
        with self.assertRaisesRegex(reflection.Failure, "cannot tell"):
            reflection.part(gauges, DEPTH)


class Programs(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.mkdtemp()
        cls.bag = os.path.join(cls.folder, "out.bag")
        places = (1.0, 1.3, 1.7)
        levels = numpy.array([DEPTH + 0.1 + travelling(0.05, 0.8, x) + travelling(0.005, 0.8, x, -1) for x in places])
        with rosbag.Bag(cls.bag, "w") as bag:
            for n in range(0, len(TIMES), 2):
                message = WaveGaugeArray(names=["a", "b", "c"], levels=levels[:, n].tolist())
                message.positions = [Point(x, 0, 0.1) for x in places]
                message.header.stamp = rospy.Time.from_sec(TIMES[n])
                bag.write("/wavetank/gauges", message, rospy.Time.from_sec(max(TIMES[n], 1e-9)))

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(cls.folder)

    def run_script(self, name, *arguments):
        return subprocess.run(
            [sys.executable, os.path.join(SCRIPTS, name)] + list(arguments), stdout=subprocess.PIPE, stderr=subprocess.PIPE, universal_newlines=True
        )

    def test_waves(self):
        picture = os.path.join(self.folder, "waves.png")
        done = self.run_script("waves", self.bag, "--gauge", "b", "--from", "10", "--output", picture)
        self.assertEqual(done.returncode, 0, done.stderr)
        words = done.stdout.splitlines()[1].split()
        self.assertEqual(words[0], "b")
        self.assertAlmostEqual(float(words[6]), 1.25, delta=0.01)
        self.assertGreater(os.path.getsize(picture), 5000)

    def test_reflection(self):
        done = self.run_script("reflection", self.bag, "--gauges", "a", "b", "c")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertRegex(done.stdout, r"of all: 0\.(09\d|10\d) of the amplitude, in water 0\.4 m deep")

    def test_what_is_wrong_is_one_sentence(self):
        for name, arguments, sentence in (
            ("waves", ["/no/such.bag"], "waves: there is no bag '/no/such.bag'"),
            ("waves", [self.bag, "--gauge", "d"], "holds no gauge d, only a, b, c"),
            ("waves", [self.bag, "--from", "70"], "has only 0 samples in that time"),
            ("waves", [self.bag, "--namespace", "pool"], "holds nothing of /pool, only of /wavetank"),
            ("reflection", [self.bag, "--gauges", "a", "b"], "three gauges at least must be named by --gauges, but 2 are"),
            ("reflection", [self.bag, "--gauges", "a", "b", "c", "--depth", "-1"], "the depth is -1 m; it must be greater than 0"),
        ):
            done = self.run_script(name, *arguments)
            self.assertNotEqual(done.returncode, 0)
            self.assertEqual(len(done.stderr.splitlines()), 1, done.stderr)
            self.assertIn(sentence, done.stderr)


if __name__ == "__main__":
    unittest.main()
