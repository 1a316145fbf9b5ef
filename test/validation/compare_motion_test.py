#!/usr/bin/env python3
"""The measures of compare_motion and the linear theory of heave, against known answers."""

import math
import os
import sys
import tempfile
import unittest

import numpy

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from compare_motion import (  # noqa: E402
    Failure,
    Record,
    Table,
    correlation,
    crossings,
    depth_inside,
    impulse,
    load_script,
    mean,
    peak,
    peak_to_peak,
    read_mesh,
    read_record,
    relative_error,
    rms_error,
    running_mean,
    rotated,
    volume_of,
)
from linear_heave import LinearHeave  # noqa: E402
from motion_checks import draught_of  # noqa: E402

plot_motion = load_script("plot_motion")
ROUNDING = 1e-12


class Records(unittest.TestCase):
    def test_running_mean_of_a_line_is_the_line_and_of_a_blow_is_spread(self):
        times = numpy.linspace(0, 1, 101)
        line = running_mean(Record(times, 3 * times), 0.1)
        numpy.testing.assert_allclose(line.values, 3 * line.times, atol=1e-12)
        self.assertAlmostEqual(line.times[0], 0.05)
        blow = running_mean(Record(times, times == 0.5), 0.1)
        self.assertAlmostEqual(blow.values.max(), 0.1)  # its area, 0.01 s, over the window

    def test_sorts_and_takes_the_mean_of_times_given_twice(self):
        record = Record([2, 1, 1, 3], [5, 1, 3, 7])
        numpy.testing.assert_array_equal(record.times, [1, 2, 3])
        numpy.testing.assert_array_equal(record.values, [2, 5, 7])

    def test_leaves_out_what_is_no_number(self):
        numpy.testing.assert_array_equal(Record([0, 1, 2], [1, math.nan, 3]).times, [0, 2])

    def test_refuses_columns_of_unlike_length(self):
        with self.assertRaises(ValueError):
            Record([0, 1], [1])

    def test_reads_a_column_by_its_name(self):
        with tempfile.NamedTemporaryFile("w", suffix=".csv") as file:
            file.write("# a remark\ntime_s,a,b\n0,1,2\n1,3,4\n")
            file.flush()
            numpy.testing.assert_array_equal(read_record(file.name, "b").values, [2, 4])
            numpy.testing.assert_array_equal(read_record(file.name).values, [1, 3])
            with self.assertRaisesRegex(Failure, "no column 'c', only time_s, a, b"):
                read_record(file.name, "c")

    def test_says_which_record_is_not_there(self):
        with self.assertRaisesRegex(Failure, "'/nowhere/a.csv' cannot be read"):
            read_record("/nowhere/a.csv")


class Measures(unittest.TestCase):
    def setUp(self):
        self.times = numpy.linspace(0, 10, 1001)
        self.wave = Record(self.times, numpy.sin(self.times))

    def test_a_shift_is_the_error(self):
        shifted = self.wave.scaled(offset=0.25)
        self.assertAlmostEqual(rms_error(shifted, self.wave), 0.25, delta=ROUNDING)
        # sin runs from -1 to 1 within 0 to 10; the grid misses its extremes by (0.005)²/2.
        self.assertAlmostEqual(relative_error(shifted, self.wave), 0.125, delta=2e-6)

    def test_ours_is_interpolated_onto_the_references_times(self):
        reference = Record([0.5, 1.5, 2.5], [5, 15, 25])
        self.assertAlmostEqual(rms_error(Record([0, 3], [0, 30]), reference), 0.0, delta=ROUNDING)

    def test_only_what_both_cover_counts(self):
        reference = Record([0, 1, 2, 3], [100, 1, 2, 100])
        self.assertAlmostEqual(rms_error(Record([0.5, 2.5], [0.5, 2.5]), reference), 0.0, delta=ROUNDING)
        self.assertAlmostEqual(rms_error(Record([0, 3], [0, 3]), reference, 0.5, 2.5), 0.0, delta=ROUNDING)

    def test_a_record_that_does_not_reach_is_refused(self):
        with self.assertRaisesRegex(Failure, "does not reach"):
            rms_error(Record([0, 1], [0, 0]), Record([5, 6], [0, 0]))

    def test_correlation_is_blind_to_scale_and_offset_but_not_to_sign(self):
        self.assertAlmostEqual(correlation(self.wave.scaled(3, 7), self.wave), 1.0, delta=ROUNDING)
        self.assertAlmostEqual(correlation(self.wave.scaled(-1), self.wave), -1.0, delta=ROUNDING)
        quarter = Record(self.times, numpy.cos(self.times))
        self.assertLess(abs(correlation(quarter, self.wave, 0, 2 * math.pi)), 1e-2)  # whole periods but for a sample

    def test_peak_to_peak_of_a_part(self):
        self.assertAlmostEqual(peak_to_peak(self.wave, 0, math.pi), 1.0, delta=2e-5)  # the peak lies between samples
        self.assertAlmostEqual(peak_to_peak(self.wave), 2.0, delta=4e-5)

    def test_impulse_interpolates_its_ends(self):
        ramp = Record([0, 1, 2], [0, 1, 2])
        self.assertAlmostEqual(impulse(ramp, 0.5, 1.75), 0.5 * (1.75**2 - 0.5**2), delta=ROUNDING)
        self.assertAlmostEqual(mean(ramp, 0.5, 1.5), 1.0, delta=ROUNDING)

    def test_peak_is_looked_for_only_near_the_time(self):
        record = Record([0, 1, 2, 3, 4], [9, 1, 5, 2, 8])
        self.assertEqual(peak(record, 2, 1.5), (2.0, 5.0))
        self.assertTrue(math.isnan(peak(record, 20, 1)[0]))

    def test_crossings_of_a_wave(self):
        found = crossings(Record(self.times + 0.3, numpy.sin(self.times + 0.3)))
        # Straight lines between samples 0.01 apart: within 1e-6 of the sine's zeros.
        numpy.testing.assert_allclose(found, [math.pi, 2 * math.pi, 3 * math.pi], atol=1e-6)
        self.assertEqual(crossings(Record([0, 1], [1, 2])), [])


class Tables(unittest.TestCase):
    def test_fails_when_a_bar_is_missed_and_only_then(self):
        table = Table()
        table.add("a", "1", "1", "0", "0.1", True)
        table.add("b", "", "2", "")
        self.assertFalse(table.failed)
        table.add("c", "1", "2", "1", "0.1", False)
        self.assertTrue(table.failed)


class Angles(unittest.TestCase):
    def test_in_the_plane_pitch_goes_on_beyond_half_a_turn(self):
        turns = numpy.radians([0, 90, 170, 190, 350, 370])
        zero = numpy.zeros(6)
        angles = plot_motion.angles_of(numpy.column_stack([zero, numpy.sin(turns / 2), zero, numpy.cos(turns / 2)]))
        numpy.testing.assert_allclose(angles[:, 1], turns, atol=1e-12)

    def test_each_axis_has_its_own_angle(self):
        half = 0.5 * math.radians(30)
        rows = numpy.array([[math.sin(half), 0, 0, math.cos(half)], [0, 0, math.sin(half), math.cos(half)]])
        angles = numpy.degrees(plot_motion.angles_of(rows))
        numpy.testing.assert_allclose(angles, [[30, 0, 0], [0, 0, 30]], atol=1e-12)

    def test_positive_pitch_lowers_what_is_ahead(self):
        half = 0.5 * math.radians(30)
        turned = rotated(numpy.array([[0, math.sin(half), 0, math.cos(half)]]), numpy.array([1.0, 0, 0]))
        numpy.testing.assert_allclose(turned, [[math.cos(2 * half), 0, -0.5]], atol=1e-12)


class Meshes(unittest.TestCase):
    def test_the_ball_is_a_little_smaller_than_a_sphere(self):
        ball = read_mesh({"mesh": "package://wavetank/meshes/ball.stl", "scale": 2.0})
        self.assertAlmostEqual(numpy.linalg.norm(ball, axis=2).max(), 1.0, delta=1e-6)  # float32
        # The middles of its facets, whose edges span up to a third of a right angle, lie at 0.94 of the radius: the volume is between 0.94³ and 1 of a sphere's.
        self.assertTrue(0.83 < volume_of(ball) / (4 / 3 * math.pi) < 1.0)
        self.assertGreater(volume_of(ball), 0)

    def test_depth_is_the_way_to_the_nearest_plane(self):
        ball = read_mesh({"mesh": "ball.stl", "scale": 2.0})
        depths = depth_inside(ball, numpy.array([[0, 0, 0], [0.5, 0, 0], [0, 0, 0.99], [0, 1.1, 0]]))
        self.assertTrue(0.92 < depths[0] < 1.0)
        self.assertTrue(0.4 < depths[1] < 0.5)
        self.assertTrue(0 < depths[2] < 0.01)
        self.assertTrue(-0.1 - 1e-6 < depths[3] < -0.05)


class Draught(unittest.TestCase):
    CASE = {
        "fluid": {"fill": [{"box": {"min": [-1, 0, 0], "max": [1, 0, 0.5]}}]},
        "tank": {"box": {"size": [2, 0, 0.8]}},
        "bodies": [{"box": {"min": [-0.15, 0, 0.42], "max": [0.15, 0, 0.62]}}],
    }

    def test_at_the_start_it_is_what_the_case_says(self):
        self.assertAlmostEqual(draught_of(self.CASE, 0.52), 0.08, delta=ROUNDING)

    def test_the_level_rises_as_the_box_sinks(self):
        # 10 mm down take 0.3 m × 10 mm of water, which raises the 1.7 m beside the box by 3/1.7 mm.
        self.assertAlmostEqual(draught_of(self.CASE, 0.51), 0.09 + 0.003 / 1.7, delta=ROUNDING)


class Heave(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.heave = LinearHeave(0.3, 0.1, 2.0, 0.5, 0.01)

    def test_what_the_box_pushes_away_comes_up_beside_it(self):
        self.assertAlmostEqual(2 * self.heave.cell * self.heave.rise[:, 0].sum(), -0.3, delta=1e-9)

    def test_a_potential_that_is_the_same_everywhere_moves_nothing(self):
        self.assertLess(numpy.abs(self.heave.rise[:, 1:].sum(axis=1)).max(), 1e-9)

    def test_force_and_motion_are_reciprocal(self):
        numpy.testing.assert_allclose(self.heave.pull, -2 * self.heave.cell * self.heave.rise[:, 0], atol=1e-12)

    def test_added_mass_below_a_wide_box_is_that_of_the_jet_beside_it(self):
        # A box 0.2 m over the floor that leaves 0.1 m at either end of a 2 m tank: w x under the box, w 0.9/0.1 upwards beside it. Kinetic energy, of
        # one half: ∫ (w x)²/0.2² 0.2 dx/2 + (9 w)² 0.1 · 0.3/2, and at the corner between a part of the order of the gap.
        heave = LinearHeave(1.8, 0.3, 2.0, 0.5, 0.01)
        expected = 2 * 1000 * (0.9**3 / 3 / 0.2 + 81 * 0.1 * 0.3)
        self.assertAlmostEqual(heave.added_mass / expected, 1.0, delta=0.25)
        self.assertGreater(heave.added_mass, expected)

    def test_the_grid_is_fine_enough(self):
        finer = LinearHeave(0.3, 0.1, 2.0, 0.5, 0.005)
        # The corners' singularity makes it converge with about the first order: 0.7 % are left, 0.2 % of the period.
        self.assertAlmostEqual(self.heave.added_mass / finer.added_mass, 1.0, delta=0.01)

    def test_decay_keeps_to_the_period_and_loses_to_waves(self):
        times, heights = self.heave.decay(0.02, 2.0)
        self.assertAlmostEqual(heights[0], 0.02, delta=1e-9)
        first, _, third = crossings(Record(times, heights))[:3]
        self.assertAlmostEqual((third - first) / self.heave.period_without_waves(), 1.0, delta=0.1)
        self.assertLess(-heights.min(), 0.95 * 0.02)

    def test_energy_is_kept(self):
        # The eigenvalues of a system without damping are imaginary.
        times, heights = self.heave.decay(0.02, 200.0, rate=20.0)
        late = numpy.abs(heights[times > 100]).max()
        self.assertGreater(late, 0.01)
        self.assertLess(late, 0.021)

    def test_refuses_lengths_that_the_grid_does_not_divide(self):
        with self.assertRaisesRegex(ValueError, "not a multiple"):
            LinearHeave(0.3, 0.1, 2.0, 0.5, 0.02)


if __name__ == "__main__":
    unittest.main()
