#!/usr/bin/env python3
"""hydrodynamics: its fits on signals whose coefficients are known, the cases that it makes, what it refuses, and a run of a small box."""

import contextlib
import io
import math
import os
import subprocess
import sys
import unittest
import xml.dom.minidom

import numpy
import program_runner
import yaml
from program_runner import PACKAGE, ProgramTest
from wavetank import Failure, fits, snippets
from wavetank.body_cases import BodyCase
from wavetank.hydrodynamics import judged
from wavetank.linear_waves import group_speed
from wavetank.rotations import angles_of_matrix, matrix_of

SCRIPT = os.path.join(PACKAGE, "scripts", "hydrodynamics")
SEED = 19
BOX = {"name": "hull", "box": {"min": [0.15, 0.15], "max": [0.25, 0.25]}, "motion": "free", "density": 500}


def oscillation(period, added_mass, damping, stiffness, amplitude=0.01, phase=0.4):
    """(times, motion) and (times, force), each on a clock of its own."""
    omega = 2 * math.pi / period
    poses, samples = numpy.arange(0, 10, 0.01), numpy.arange(0, 10, 0.003)
    moved = 0.7 + amplitude * numpy.sin(omega * poses + phase)
    at, rate = amplitude * numpy.sin(omega * samples + phase), amplitude * omega * numpy.cos(omega * samples + phase)
    return (poses, moved), (samples, 50.0 + (added_mass * omega**2 - stiffness) * at - damping * rate)


class Oscillations(unittest.TestCase):
    def test_exact_values_come_back(self):
        for period, mass, damping, stiffness in ((1.0, 12.0, 30.0, 2000.0), (0.83, 0.5, 0.0, 0.0), (1.37, 3.0, 200.0, 5.0)):
            found = fits.fit_oscillation(*oscillation(period, mass, damping, stiffness), period, 2.0, 9.9, stiffness)
            self.assertAlmostEqual(found["added_mass"], mass, delta=1e-7 * (mass + stiffness))
            self.assertAlmostEqual(found["damping"], damping, delta=1e-7 * (1 + damping + mass))
            self.assertAlmostEqual(found["amplitude"], 0.01, delta=1e-9)
            self.assertLess(found["residual"], 1e-7)
            self.assertEqual(found["periods_fitted"], math.floor(7.9 / period))

    def test_a_second_harmonic_is_told_and_does_no_harm(self):
        motion, (times, force) = oscillation(1.0, 12.0, 30.0, 2000.0)
        first = abs(12 * (2 * math.pi) ** 2 - 2000 - 30j * 2 * math.pi) * 0.01
        found = fits.fit_oscillation(motion, (times, force + 0.3 * first * numpy.cos(4 * math.pi * times)), 1.0, 2.0, 9.9, 2000.0)
        self.assertAlmostEqual(found["added_mass"], 12.0, delta=1e-4)
        self.assertAlmostEqual(found["second_harmonic"], 0.3, delta=1e-6)

    def test_noise(self):
        print("seed %d" % SEED)
        motion, (times, force) = oscillation(1.0, 12.0, 30.0, 2000.0)
        noisy = force + numpy.random.default_rng(SEED).normal(0, 2.0, len(force))  # of an amplitude of 15.4 N
        found = fits.fit_oscillation(motion, (times, noisy), 1.0, 2.0, 9.9, 2000.0)
        # of 2333 samples each amplitude is known to 2 √(2/2333) N, and 4 times that hardly ever is exceeded
        error = 4 * 2.0 * math.sqrt(2 / 2333) / 0.01
        self.assertAlmostEqual(found["added_mass"], 12.0, delta=error / (2 * math.pi) ** 2)
        self.assertAlmostEqual(found["damping"], 30.0, delta=error / (2 * math.pi))
        self.assertAlmostEqual(found["residual"], 2.0 / 15.4, delta=0.02)

    def test_less_than_a_period_is_refused(self):
        with self.assertRaisesRegex(Failure, "less than one period"):
            fits.fit_oscillation(*oscillation(1.0, 1, 1, 1), 1.0, 9.5, 9.9, 1)


class Decays(unittest.TestCase):
    TIMES = numpy.arange(0, 8, 0.01)

    def record(self, *parameters):
        """With steps a tenth as long as the fit's own."""
        fine = numpy.linspace(0, 8, 8001)[:-1]
        return fits.swing(fine, numpy.array(parameters, dtype=float)[:, None])[::10, 0]

    def test_exact_values_come_back(self):
        for wanted in ((0.1, 0, 0.02, 36, 0.4, 3.0), (0.2, 0.1, -0.5, 40, 0.05, 0.8), (0.1, 0, 0, 30, 1.0, 0.0)):
            found = fits.fit_decay(self.TIMES, self.record(*wanted))
            self.assertAlmostEqual(found["stiffness_over_mass"], wanted[3], delta=1e-5 * wanted[3])
            self.assertAlmostEqual(found["linear"], wanted[4], delta=1e-5)
            self.assertAlmostEqual(found["quadratic"], wanted[5], delta=1e-4)
            self.assertAlmostEqual(found["rest"], wanted[2], delta=1e-6)
            self.assertAlmostEqual(found["period"], 2 * math.pi / math.sqrt(wanted[3] - wanted[4] ** 2 / 4), delta=1e-5)
            self.assertLess(found["residual"], 1e-6)

    def test_linear_damping_alone_has_the_known_solution(self):
        k, linear = 25.0, 0.6
        omega = math.sqrt(k - linear**2 / 4)
        found = fits.fit_decay(self.TIMES, 0.1 * numpy.exp(-linear / 2 * self.TIMES) * numpy.cos(omega * self.TIMES))
        self.assertAlmostEqual(found["linear"], linear, delta=1e-5)
        self.assertAlmostEqual(found["quadratic"], 0.0, delta=1e-4)
        self.assertAlmostEqual(found["period"], 2 * math.pi / omega, delta=1e-5)

    def test_noise(self):
        print("seed %d" % SEED)
        noise = numpy.random.default_rng(SEED).normal(0, 0.001, len(self.TIMES))
        found = fits.fit_decay(self.TIMES, self.record(0.1, 0, 0.02, 36, 0.4, 3.0) + noise)
        self.assertAlmostEqual(found["period"], 1.04778, delta=0.001)
        self.assertAlmostEqual(found["linear"], 0.4, delta=0.1)
        self.assertAlmostEqual(found["quadratic"], 3.0, delta=0.6)

    def test_what_does_not_swing_is_refused(self):
        with self.assertRaisesRegex(Failure, "swings through rest only 0 times in 7.99 s; 3 are needed"):
            fits.fit_decay(self.TIMES, numpy.exp(-self.TIMES))


class Drags(unittest.TestCase):
    def test_exact_values_come_back(self):
        speeds = numpy.array([0.5, 1.0, -2.0])
        found = fits.fit_drag(speeds, 3 * speeds + 7 * speeds * abs(speeds))
        self.assertAlmostEqual(found["linear"], 3.0, delta=1e-12)
        self.assertAlmostEqual(found["quadratic"], 7.0, delta=1e-12)
        self.assertEqual(fits.fit_drag([2.0], [28.0])["quadratic"], 7.0)


class Convergence(unittest.TestCase):
    def test_more_than_a_tenth_is_told(self):
        with contextlib.redirect_stdout(io.StringIO()) as told:
            self.assertTrue(judged({"period": 0.8, "added_mass_change": 0.09, "damping_change": 0.02})["converged"])
        self.assertEqual(told.getvalue(), "")
        with contextlib.redirect_stdout(io.StringIO()) as told:
            self.assertFalse(judged({"period": 0.8, "added_mass_change": 0.02, "damping_change": 0.31})["converged"])
        self.assertEqual(told.getvalue(), "not converged at period 0.8: damping differs by 31 % between the two finest spacings\n")


class Theory(unittest.TestCase):
    def test_group_speeds(self):
        self.assertAlmostEqual(group_speed(2.0, 50.0), 9.81 / (4 * math.pi * 2.0), delta=1e-9)  # deep
        self.assertAlmostEqual(group_speed(0.001, 0.5), math.sqrt(9.81 * 0.5), delta=1e-4)  # shallow

    def test_angles_of_turns(self):
        for angles in ((0.3, -0.8, 2.0), (-1.0, 0.2, 0.1), (0.4, math.pi / 2, 0.0)):
            numpy.testing.assert_allclose(matrix_of(angles_of_matrix(matrix_of(angles))), matrix_of(angles), atol=1e-12)


class Cases(ProgramTest):
    def test_a_body_is_moved_and_turned(self):
        case = BodyCase(self.case(bodies=[BOX]), "hull")
        raised = case.body_in(case.held("heave", 0.01, 1.0, None))
        numpy.testing.assert_allclose([raised["box"]["min"], raised["box"]["max"]], [[0.15, 0.16], [0.25, 0.26]])
        self.assertEqual(raised["motion"], "fixed")
        turned = case.body_in(case.held("pitch", math.radians(10), 1.0, None))
        self.assertEqual(turned["mesh"][:24], "shape://box?size=0.1,0.1")
        numpy.testing.assert_allclose(turned["rotation"], [0, 10, 0], atol=1e-12)
        numpy.testing.assert_allclose(turned["translation"], [0.2, 0, 0.2], atol=1e-12)
        self.assertNotIn("box", turned)
        self.assertIn("box", case.body)  # which stays as it was

    def test_a_mesh_turns_about_its_centre_of_mass(self):
        mesh = {
            "name": "hull",
            "mesh": "shape://box?size=1,1,1",
            "translation": [1, 0, 0],
            "centre_of_mass": [0, 0, 0],
            "mass": 5,
            "inertia": [1, 2, 3, 0, 0, 0],
        }
        case = BodyCase(self.case(dimensions=3, bodies=[mesh]), "hull")
        turned = case.body_in(case.released("yaw", math.pi / 2, 1.0, None))
        numpy.testing.assert_allclose(turned["translation"], [0, 1, 0], atol=1e-12)
        numpy.testing.assert_allclose(turned["rotation"], [0, 0, 90], atol=1e-12)
        numpy.testing.assert_allclose(turned["inertia"], [2, 1, 3, 0, 0, 0], atol=1e-12)

    def test_what_goes_with_another_motion_is_left_out(self):
        hull = dict(BOX, wind={"velocity": [5, 0], "area": 0.05}, moorings=[{"anchor": [0, 0.1], "attachment": [0.15, 0.2], "stiffness": 9}], imu=True)
        paddle = {"name": "paddle", "imu": True, "prescribed": {"waves": {"kind": "regular", "absorption": {"gauge": "front"}}}}
        gauges = [{"name": "front", "position": [0.1]}, {"name": "far", "position": [0.3]}]
        instruments = {"imu_rate": 50, "gauge_rate": 50, "wave_gauges": gauges, "pressure_probes": [{}], "velocity_probes": [{}], "sections": [{}]}
        case = BodyCase(self.case(bodies=[hull, paddle], instruments=instruments), "hull")
        swung, let_go = case.oscillating("heave", 0.01, 1.0, 1.0, 2.0, None), case.released("heave", 0.01, 1.0, None)
        for tree in (swung, let_go):
            self.assertFalse({"wind", "moorings", "imu"} & set(case.body_in(tree)))
            self.assertNotIn("imu", tree["bodies"][1])
            self.assertEqual(set(tree["instruments"]), {"rate", "pose_rate", "wave_gauges"})
            self.assertEqual(tree["instruments"]["wave_gauges"], gauges[:1])  # by which the paddle absorbs
        alone = BodyCase(self.case(bodies=[hull], instruments=instruments), "hull")
        self.assertEqual(set(alone.held("heave", 0.01, 1.0, None)["instruments"]), {"rate", "pose_rate"})

    def test_files_that_are_set_lie_beside_the_case_too(self):
        case = BodyCase(self.case(bodies=[dict(BOX, mesh="a.stl")]), "hull", [("bodies/0/mesh", "hull.stl")])
        self.assertEqual(case.body["mesh"], self.path("hull.stl"))

    def test_settings_take_the_place_of_keys(self):
        case = BodyCase(self.case(bodies=[BOX]), "hull", [("fluid/particles", "500"), ("bodies/0/density", "300"), ("gravity", "[0, 0, -1.6]")])
        self.assertEqual(case.tree["fluid"]["particles"], 500)
        self.assertNotIn("spacing", case.tree["fluid"])
        self.assertEqual(case.body["density"], 300)
        with open(case.path, "a") as file:
            file.write("real_time_factor: 1e-3\n")  # text to PyYAML by itself
        self.assertEqual(BodyCase(case.path, "hull", [("fluid/viscosity", "2E-3")]).tree["real_time_factor"], 0.001)
        self.assertEqual(BodyCase(case.path, "hull", [("fluid/viscosity", "2E-3")]).tree["fluid"]["viscosity"], 0.002)
        with self.assertRaisesRegex(Failure, "--set bodies/7/mass=1 does not fit the case"):
            BodyCase(self.case(bodies=[BOX]), "hull", [("bodies/7/mass", "1")])


class Snippets(unittest.TestCase):
    COEFFICIENTS = {
        "heave": {"added_mass": 12.0, "linear": 3.0, "quadratic": 4.0, "from": "heave: made here"},
        "surge": {"drag_coefficient": 1.05, "from": "tow"},
    }

    def test_signs_and_places(self):
        text = snippets.uuv_simulator("hull", self.COEFFICIENTS, 1000.0, 3)
        tree = xml.dom.minidom.parseString(text)
        numbers = {
            name: [float(word) for word in tree.getElementsByTagName(name)[0].firstChild.data.split()]
            for name in ("added_mass", "linear_damping", "quadratic_damping")
        }
        self.assertEqual(len(numbers["added_mass"]), 36)
        self.assertEqual(numbers["added_mass"][14], 12.0)
        self.assertEqual(sum(numbers["added_mass"]), 12.0)
        self.assertEqual(numbers["linear_damping"], [0, 0, -3, 0, 0, 0])
        self.assertEqual(numbers["quadratic_damping"], [0, 0, -4, 0, 0, 0])
        self.assertIn("Not measured, and therefore 0: sway, roll, pitch, yaw.", text)
        tree = xml.dom.minidom.parseString(snippets.gz("hull", self.COEFFICIENTS, 1000.0, 3))
        found = {tag: float(tree.getElementsByTagName(tag)[0].firstChild.data) for tag in ("zDotW", "zW", "zWabsW", "xDotU")}
        self.assertEqual(found, {"zDotW": -12.0, "zW": -3.0, "zWabsW": -4.0, "xDotU": 0.0})
        self.assertIn('quadratic_drag="1.05 1 1"', snippets.stonefish("hull", self.COEFFICIENTS, 1000.0, 3))


class Program(ProgramTest):
    def hydrodynamics(self, *arguments):
        return subprocess.run(
            [sys.executable, SCRIPT] + list(arguments), cwd=self.folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, universal_newlines=True
        )

    def test_a_box_heaves(self):
        case = self.case(bodies=[BOX], fluid__spacing=0.02, numerics={"packing": {"settling": 1}})
        command = [
            case,
            "--body",
            "hull",
            "--oscillate",
            "heave",
            "--periods",
            "0.3",
            "--amplitude",
            "0.01",
            "--cycles",
            "1",
            "--rise",
            "1",
            "--wait",
            "0",
            "--out",
            "out",
            "--hold",
            "0.2",
        ]
        done = self.hydrodynamics(*command)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        with open(self.path("out/hydrodynamics.yaml")) as file:
            found = yaml.safe_load(file)
        (row,) = found["oscillate"]["heave"]["results"]
        self.assertAlmostEqual(row["amplitude"], 0.01, delta=1e-4)
        self.assertEqual(row["periods_fitted"], 1)
        # coarse, in a tank four times as wide as the box: the stiffness ρ g b is 981 N/m a metre, and the mass that moves with it some ρ b²/2
        self.assertAlmostEqual(found["oscillate"]["heave"]["hydrostatic_stiffness"]["as given"], 981.0, delta=100.0)
        self.assertGreater(row["added_mass"], 1.0)
        self.assertLess(row["added_mass"], 20.0)
        self.assertRegex(done.stdout, r"blockage: the body takes 25 % of the water's horizontal section")
        self.assertRegex(done.stdout, r"waves are back at the body after [\d.]+ s; the fit ends at 0.6 s, so the fit is free of them")
        self.assertEqual(found["coefficients"]["heave"]["added_mass"], row["added_mass"])
        for name in ("uuv_simulator.xml", "gz.sdf", "stonefish.xml"):
            with open(self.path("out/" + name)) as file:
                xml.dom.minidom.parseString("<all>%s</all>" % file.read())
        os.remove(self.path("out/held_heave_up/out.bag"))
        self.assertEqual(self.hydrodynamics(*command).stdout.count("done before"), 2)

        # a tow into the same folder adds to what is there
        done = self.hydrodynamics(case, "--body", "hull", "--tow", "surge", "--speeds", "0.5", "--out", "out")
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.assertIn("tow over 0.1 m", done.stdout)
        with open(self.path("out/hydrodynamics.yaml")) as file:
            both = yaml.safe_load(file)
        self.assertEqual(both["oscillate"], found["oscillate"])
        (towed,) = both["tow"]["surge"]["results"]
        self.assertGreater(towed["drag"], 0.0)
        self.assertAlmostEqual(towed["drag"], towed["drag_coefficient"] * 0.5 * 1000 * 0.5**2 * 0.1, delta=1e-9 * towed["drag"])
        self.assertAlmostEqual(both["coefficients"]["surge"]["quadratic"], towed["drag"] / 0.5**2, delta=1e-9 * towed["drag"])

    def test_what_is_wrong_is_one_sentence(self):
        case = self.case(bodies=[BOX])
        hinged = self.case("hinged.yaml", bodies=[BOX], joints=[{"name": "knee", "type": "hinge", "child": "hull"}])
        light = dict(BOX)
        del light["density"]
        massless = self.case("massless.yaml", bodies=[dict(light, motion="fixed")])
        heave = ["--oscillate", "heave", "--periods", "1", "--out", "out"]
        for arguments, sentence in (
            ([case, "--body", "boat"] + heave, "has no body 'boat', only hull"),
            ([hinged, "--body", "hull"] + heave, "the body 'hull' hangs on the joint 'knee'"),
            (
                [case, "--body", "hull", "--oscillate", "roll", "--periods", "1", "--out", "out"],
                "in two dimensions there are surge, heave and pitch, but no roll",
            ),
            ([case, "--body", "hull", "--oscillate", "heave", "--out", "out"], "--oscillate needs --periods"),
            ([case, "--body", "hull", "--oscillate", "heave", "--periods", "1:2", "--out", "out"], "the periods '1:2' are neither numbers"),
            ([case, "--body", "hull", "--oscillate", "heave", "--periods", "0,1", "--out", "out"], "the periods '0,1' are not all greater than 0"),
            ([case, "--body", "hull", "--decay", "surge", "--displacement", "0.1", "--duration", "1", "--out", "out"], "nothing brings a body back in surge"),
            (
                [massless, "--body", "hull", "--decay", "heave", "--displacement", "0.02", "--duration", "1", "--stiffness", "1", "--out", "out"],
                "needs a mass or a density",
            ),
            ([case, "--body", "hull", "--tow", "surge", "--speeds", "1", "--distance", "3", "--out", "out"], "a tow of 3 m is not possible"),
            ([case, "--body", "hull", "--set", "fluid/spacing=-1"] + heave, "wavetank_run does not take the case: "),
        ):
            done = self.hydrodynamics(*arguments)
            self.assertEqual(done.returncode, 2, done.stdout + done.stderr)
            self.assertEqual(len(done.stderr.splitlines()), 1, done.stderr)
            self.assertRegex(done.stderr, "^hydrodynamics: ")
            self.assertIn(sentence, done.stderr)


if __name__ == "__main__":
    program_runner.main()
