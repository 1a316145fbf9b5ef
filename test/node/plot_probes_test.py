#!/usr/bin/env python3
"""plot_probes: its smoothing and figures against known answers, and the script as a user runs it on a bag made here."""

import importlib.machinery
import importlib.util
import math
import os
import shutil
import struct
import subprocess
import sys
import tempfile
import unittest

import numpy
import rosbag
import rospy
from geometry_msgs.msg import Point, WrenchStamped

HERE = os.path.dirname(os.path.abspath(__file__))
SCRIPT = os.path.join(os.path.dirname(os.path.dirname(HERE)), "scripts", "plot_probes")
sys.dont_write_bytecode = True
loader = importlib.machinery.SourceFileLoader("plot_probes", SCRIPT)
plot_probes = importlib.util.module_from_spec(importlib.util.spec_from_loader("plot_probes", loader))
loader.exec_module(plot_probes)


def series(times, values, name="P1", position=None):
    return plot_probes.Series(name, times, values, position)


class Smoothing(unittest.TestCase):
    def test_keeps_polynomials_of_its_order_even_at_the_ends(self):
        t = numpy.linspace(-1, 2, 50)
        cubic = 3 * t**3 - t**2 + 2
        self.assertLess(numpy.abs(plot_probes.savitzky_golay(cubic, 11, 3) - cubic).max(), 1e-12)

    def test_has_the_published_coefficients(self):
        # Savitzky and Golay 1964: five points, quadratic: (-3, 12, 17, 12, -3)/35.
        impulse = numpy.zeros(21)
        impulse[10] = 35.0
        numpy.testing.assert_allclose(plot_probes.savitzky_golay(impulse, 5, 2)[8:13], [-3, 12, 17, 12, -3], atol=1e-12)

    def test_refuses_windows_that_cannot_be(self):
        for window, order in [(4, 2), (3, 3), (101, 2)]:
            with self.assertRaises(plot_probes.Failure):
                plot_probes.savitzky_golay(numpy.zeros(50), window, order)


class Figures(unittest.TestCase):
    def test_first_time_peak_and_impulse(self):
        t = numpy.arange(0, 1.0005, 0.001)
        ramp = series(t, numpy.where(t < 0.4, 0.0, 10000.0 * (t - 0.4)))
        first, peak, at, impulse = plot_probes.figures(ramp, (0.4, 1.0))
        self.assertAlmostEqual(first, 0.451, 6)
        self.assertAlmostEqual(peak, 6000.0, 6)
        self.assertAlmostEqual(at, 1.0, 6)
        self.assertAlmostEqual(impulse, 1800.0, 6)

    def test_noise_is_about_the_running_mean(self):
        t = numpy.arange(0, 1.0005, 0.001)
        waves = 1000 * t + 40 * numpy.sin(2 * math.pi * t / 0.0205)  # two whole periods of the waves in the mean, which leaves the slope alone
        self.assertAlmostEqual(plot_probes.noise(series(t, waves), 0.2, 0.8), 40 / math.sqrt(2), delta=0.3)
        self.assertAlmostEqual(plot_probes.noise(series(t, 1000 * t), 0.2, 0.8), 0.0, delta=1e-6)
        self.assertTrue(math.isnan(plot_probes.noise(series(t, waves), 0.5, 1.5)))

    def test_no_impulse_where_the_record_does_not_reach(self):
        t = numpy.arange(0, 0.5, 0.001)
        self.assertTrue(math.isnan(plot_probes.impulse(series(t, t), 0.35, 1.0)))


class References(unittest.TestCase):
    columns = {"P1_Pa": 1, "P10_Pa": 2, "level_x0.496_m": 3, "level_x1.488_m": 4}

    def test_probes_by_name(self):
        self.assertEqual(plot_probes.find_reference(series([], [], "P1", (0, 0, 0)), self.columns, {}), 1)
        self.assertEqual(plot_probes.find_reference(series([], [], "P10", (0, 0, 0)), self.columns, {}), 2)
        self.assertIsNone(plot_probes.find_reference(series([], [], "P2", (0, 0, 0)), self.columns, {}))

    def test_gauges_by_position_or_map(self):
        self.assertEqual(plot_probes.find_reference(series([], [], "H1", (1.488, 0.5, 0)), self.columns, {}), 4)
        self.assertEqual(plot_probes.find_reference(series([], [], "H1", (9, 0.5, 0)), self.columns, {"H1": "level_x0.496_m"}), 3)
        with self.assertRaises(plot_probes.Failure):
            plot_probes.find_reference(series([], [], "H1", (9, 0.5, 0)), self.columns, {"H1": "nothing"})


class KeyFigures(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.mkdtemp()
        self.path = os.path.join(self.folder, "figures.csv")

    def tearDown(self):
        shutil.rmtree(self.folder)

    def write(self, lines):
        with open(self.path, "w") as file:
            file.write("# a remark\ninstrument,figure,time,until,value\n" + lines)
        return self.path

    def test_are_found_in_a_series(self):
        t = numpy.arange(0, 1.0005, 0.001)
        ramp = series(t, 1000.0 * t)
        figures = plot_probes.read_figures(self.write("P1,arrival,0.4,,500\nP1,peak,0.9,,800\nP1,impulse,0.5,1,300\nP1,level,0.25,,7\n"))["P1"]
        self.assertEqual([figure.measured() for figure in figures], [0.4, 800, 300, 7])
        numpy.testing.assert_allclose([figure.simulated(ramp) for figure in figures], [0.501, 1000, 375, 250], rtol=1e-6)

    def test_beyond_the_record_are_not_numbers(self):
        short = series([0.0, 0.1], [0.0, 0.0])
        figures = plot_probes.read_figures(self.write("P1,arrival,0.4,,500\nP1,peak,0.9,,800\nP1,impulse,0.5,1,300\nP1,level,0.25,,7\n"))["P1"]
        self.assertTrue(all(math.isnan(figure.simulated(short)) for figure in figures))

    def test_of_the_benchmark_name_instruments_of_its_case(self):
        config = os.path.join(os.path.dirname(os.path.dirname(HERE)), "config")
        figures = plot_probes.read_figures(os.path.join(config, "spheric2_key_figures.csv"))
        with open(os.path.join(config, "dam_break_3d.yaml")) as file:
            case = file.read()
        self.assertEqual(len(figures), 12)
        for instrument in figures:
            self.assertIn("{name: %s," % instrument, case)

    def test_name_the_faulty_line(self):
        for line in ("P1,arrival,soon,,500", "P1,guess,1,,500", "P1,impulse,1,,500", "P1,peak,1"):
            with self.assertRaisesRegex(plot_probes.Failure, "line 4 "):
                plot_probes.read_figures(self.write("P1,peak,1,,5\n" + line + "\n"))
        with self.assertRaises(plot_probes.Failure):
            plot_probes.read_figures(os.path.join(self.folder, "missing.csv"))


class Script(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.mkdtemp(prefix="plot_probes_")
        self.addCleanup(shutil.rmtree, self.folder, ignore_errors=True)

    def path(self, name):
        return os.path.join(self.folder, name)

    def make_bag(self, namespaces=("/wavetank",)):
        from wavetank.msg import ProbeArray, WaveGaugeArray

        with rosbag.Bag(self.path("a.bag"), "w") as bag:
            for i in range(200):
                for namespace in namespaces:
                    stamp = rospy.Time(0, i * 1000000)
                    probes = ProbeArray(names=["P1"], positions=[Point(1, 2, 3)], pressures=[10.0 * i])
                    gauges = WaveGaugeArray(names=["H1"], positions=[Point(0.496, 0.5, 0)], levels=[0.001 * i])
                    wrench = WrenchStamped()
                    for topic, message in [("probes", probes), ("gauges", gauges), ("bodies/box/wrench", wrench)]:
                        message.header.stamp = stamp
                        bag.write(namespace + "/" + topic, message, rospy.Time(0, max(1, i * 1000000)))
        return self.path("a.bag")

    def run_script(self, *arguments):
        return subprocess.run(
            ["/usr/bin/env", "python3", SCRIPT] + list(arguments),
            cwd=self.folder,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            universal_newlines=True,
            timeout=120,
        )

    def test_draws_and_prints(self):
        with open(self.path("reference.csv"), "w") as file:
            file.write("time_s,P1_Pa,level_x0.496_m\n0.0,1.0,0.1\n0.1,600.0,0.2\n0.3,2.0,\n")
        result = self.run_script(
            self.make_bag(), "--output", "a.png", "--reference", "reference.csv", "--smooth", "11", "--print-table", "--window", "0.05", "0.15"
        )
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("P1", result.stdout)
        self.assertIn("100.0", result.stdout, "the impulse of 10 Pa/ms over 0.05-0.15 s")
        self.assertIn("reference", result.stdout)
        with open(self.path("a.png"), "rb") as file:
            header = file.read(24)
        self.assertEqual(header[:8], b"\x89PNG\r\n\x1a\n")
        self.assertGreater(struct.unpack(">I", header[16:20])[0], 300)

    def test_says_what_is_wrong(self):
        bag = self.make_bag(["/a", "/b"])
        with open(self.path("bad.csv"), "w") as file:
            file.write("time_s,P1_Pa\n0,1\n0.1\n")
        with open(self.path("no.bag"), "w") as file:
            file.write("no bag")
        for arguments, word in [
            (["missing.bag"], "missing.bag"),
            (["no.bag"], "no.bag"),
            ([bag, "-t"], "--namespace"),
            ([bag, "-t", "-n", "c"], "/c"),
            ([bag, "-t", "-n", "a", "-r", "bad.csv"], "line 3"),
            ([bag, "-t", "-n", "a", "-s", "4"], "odd"),
            ([bag, "-n", "a", "-o", "no/such/a.png"], "no/such/a.png"),
            ([bag, "-n", "a", "-m", "P1", "-o", "a.png"], "P1"),
        ]:
            result = self.run_script(*arguments)
            self.assertEqual(result.returncode, 1, arguments)
            self.assertEqual(len(result.stderr.strip().splitlines()), 1, result.stderr)
            self.assertIn(word, result.stderr)

    def test_takes_one_of_several_tanks(self):
        result = self.run_script(self.make_bag(["/a", "/b"]), "-t", "-n", "b")
        self.assertEqual(result.returncode, 0, result.stderr)


if __name__ == "__main__":
    unittest.main()
