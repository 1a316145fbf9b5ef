#!/usr/bin/env python3
"""wavetank.Tank: the bits of wavetank_run whatever the spans, pushes and commands against mechanics, and how it ends and refuses."""

import gc
import logging
import os
import signal
import subprocess
import sys
import threading
import time
import unittest
import weakref
from unittest import mock

import numpy
import wavetank

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(os.path.dirname(HERE))
sys.path += [os.path.join(ROOT, "test", "node"), os.path.join(ROOT, "src", "python", "examples")]

from program_runner import PROGRAM, ProgramTest  # noqa: E402

FLOATING_BOX = os.path.join(ROOT, "test", "node", "floating_box.yaml")
G = 9.81  # m/s²

# A box in the air over a little water, which it does not meet before a tenth of a second has passed; a trolley beside it.
FLYING = {
    "title": "A box in the air",
    "dimensions": 2,
    "numerics": {"packing": {"iterations": 10}},
    "duration": 10.0,
    "fluid": {"density": 1000.0, "sound_speed": 20.0, "spacing": 0.02, "fill": [{"box": {"min": [0, 0, 0], "max": [0.4, 0, 0.1]}}]},
    "tank": {"box": {"size": [0.4, 0, 0.6]}},
    "bodies": [
        {"name": "box", "box": {"min": [0.16, -0.1, 0.4], "max": [0.24, 0.1, 0.44]}, "motion": "free", "density": 500.0},
        {
            "name": "trolley",
            "box": {"min": [0.3, -0.1, 0.5], "max": [0.36, 0.1, 0.54]},
            "motion": "commanded",
            "command": {"greatest_acceleration": 10.0, "timeout": 0.2},
        },
    ],
    "instruments": {"pressure_probes": [{"name": "P1", "position": [0, 0, 0.05]}], "wave_gauges": [{"name": "middle", "position": [0.2, 0]}]},
}


def same_bits(a, b):
    a, b = numpy.asarray(a), numpy.asarray(b)
    return a.dtype == b.dtype and a.shape == b.shape and a.tobytes() == b.tobytes()


def particles_of(tank):
    cloud = tank.particles()
    order = numpy.argsort(cloud.id)
    return [values[order] for values in cloud[1:]]


class TankTest(ProgramTest):
    def assert_same_particles(self, first, second):
        for a, b in zip(first, second):
            self.assertTrue(same_bits(a, b))

    def assert_refused(self, words, call, *arguments, **options):
        with self.assertRaises(wavetank.Error) as refused:
            call(*arguments, **options)
        for word in words:
            self.assertIn(word, str(refused.exception))


class AgainstOthers(TankTest):
    def test_every_sample_has_the_bits_of_wavetank_runs_bag(self):
        settings = {"duration": 0.06, "instruments/imu_rate": 250.0}
        given = [word for key, value in settings.items() for word in ("--set", "%s=%s" % (key, value))]
        self.assertEqual(self.run_program(FLOATING_BOX, "--bag", "out.bag", *given).returncode, 0)
        expected = wavetank.read_tables(self.path("out.bag"))
        with wavetank.Tank(FLOATING_BOX, settings) as tank:
            parts = [tank.take_samples()]
            while tank.time < tank.duration:
                tank.advance_to(min(tank.time + 0.0123, tank.duration))
                parts.append(tank.take_samples())
        names = [name for name in expected if name != "status"]
        self.assertGreater(len(names), 15)
        self.assertEqual(set(names), {name for part in parts for name in part} - {"energies"})
        for name in names:
            pieces = [part[name] for part in parts if name in part]
            table = expected[name]
            self.assertTrue(same_bits(table.stamps, numpy.concatenate([piece.stamps for piece in pieces])), name)
            self.assertEqual(list(table.columns), list(pieces[0].columns), name)
            self.assertEqual((table.units, table.frame, table.positions), (pieces[0].units, pieces[0].frame, pieces[0].positions), name)
            for column, values in table.columns.items():
                self.assertTrue(same_bits(values, numpy.concatenate([piece.columns[column] for piece in pieces])), "%s %s" % (name, column))

    def test_it_needs_nothing_of_ros(self):
        program = (
            "import sys, wavetank; tank = wavetank.Tank(sys.argv[1], {'numerics/packing/iterations': 0}); tank.advance(0.002);"
            "ros = [m for m in sys.modules if m.split('.')[0] in ('rospy', 'roslib', 'rosbag', 'genpy', 'std_msgs')]; sys.exit(', '.join(ros) or 0)"
        )
        done = subprocess.run([sys.executable, "-c", program, self.case()], stderr=subprocess.PIPE, universal_newlines=True)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        from wavetank import _simulation

        linked = subprocess.run(["ldd", _simulation.__file__], stdout=subprocess.PIPE, universal_newlines=True, check=True).stdout
        self.assertIn("libwavetank_simulation", linked)
        self.assertNotIn("libros", linked)

    def test_the_examples_do_what_they_say(self):
        import depth_hold
        import gym_loop

        depths = depth_hold.main(3.0)
        error = max(abs(depth - depth_hold.GOAL) for depth in depths[-25:])
        print("depth held to %.4f m in the last half second" % error)
        self.assertLess(error, 0.01)
        environment = gym_loop.DivingBox()
        self.addCleanup(environment.close)
        environment.LONGEST = 15
        observations, total = gym_loop.episode(environment, gym_loop.by_hand)
        _, idle = gym_loop.episode(environment, lambda observation: 0.0)
        self.assertGreater(total, idle)
        self.assertTrue(same_bits(gym_loop.episode(environment, gym_loop.by_hand)[0], observations), "an episode repeats itself")


class WithoutItsExtension(unittest.TestCase):
    def test_the_package_is_imported_all_the_same(self):
        program = (
            "import sys; sys.path.insert(0, sys.argv[1]); import wavetank; assert wavetank.__file__.startswith(sys.argv[1]), wavetank.__file__;"
            "wavetank.read_tables\ntry:\n  wavetank.Tank\nexcept ImportError as error:\n  print(error)"
        )
        environment = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}
        command = [sys.executable, "-c", program, os.path.join(ROOT, "src", "python")]
        done = subprocess.run(command, env=environment, stdout=subprocess.PIPE, stderr=subprocess.PIPE, universal_newlines=True)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertEqual(len(done.stdout.splitlines()), 1)
        for word in ("wavetank._simulation", "pybind11-dev", "scripts/install --python"):
            self.assertIn(word, done.stdout)


class FlyingTest(TankTest):
    """With one tank, that every test finds as at the start."""

    @classmethod
    def setUpClass(cls):
        cls.tank = wavetank.Tank(FLYING)

    @classmethod
    def tearDownClass(cls):
        cls.tank.close()

    def setUp(self):
        super().setUp()
        self.tank.reset()
        self.box = self.tank.bodies["box"]


class Spans(FlyingTest):
    def test_change_no_bit_and_add_up(self):
        end = 0.05
        self.tank.advance(end)
        step, expected = self.tank.step, particles_of(self.tank)
        for spans in (5, 50, 500):  # the last ones shorter than a step
            self.tank.reset()
            self.assertEqual((self.tank.time, self.tank.step), (0.0, 0))
            for n in range(spans):
                before = self.tank.time
                self.tank.advance(end / spans)
                self.assertGreaterEqual(self.tank.time, (n + 1) * end / spans - 1e-9)
                if self.tank.time > before:
                    self.assertLess(self.tank.time - self.tank.time_step * 1.5, (n + 1) * end / spans, "not a step too many")
            self.assertEqual(self.tank.step, step)
            self.assert_same_particles(particles_of(self.tank), expected)

    def test_are_refused_as_they_should_be(self):
        self.tank.advance(0.01)
        before = self.tank.time
        for seconds in (-0.1, float("nan"), float("inf")):
            self.assert_refused(["seconds"], self.tank.advance, seconds)
        self.assert_refused(["10 s", "duration"], self.tank.advance, 11.0)
        self.assert_refused(["number"], self.tank.advance, "soon")
        self.assertEqual(self.tank.time, before)
        self.tank.advance_to(0.005)  # is over
        self.assertEqual(self.tank.time, before)

    def test_go_on_from_a_snapshot(self):
        self.tank.bodies["box"].push(force=[3.0, 0, 0], duration=0.03)
        self.tank.advance(0.02)
        self.tank.save(self.path("a.snapshot"))
        self.tank.take_samples()
        self.tank.advance_to(0.05)
        with wavetank.Tank(FLYING, restore=self.path("a.snapshot")) as restored:
            self.assertLess(restored.time, 0.03)
            restored.advance_to(0.05)
            self.assert_same_particles(particles_of(self.tank), particles_of(restored))
            self.assertTrue(same_bits(self.tank.bodies["box"].velocity, restored.bodies["box"].velocity))
            samples, expected = restored.take_samples(), self.tank.take_samples()
            self.assertEqual(list(samples), list(expected))
            for name, table in expected.items():
                self.assertTrue(same_bits(table.stamps, samples[name].stamps), name)

    def test_leave_the_interpreter_to_other_threads_but_not_the_tank(self):
        counted, refusals = [0], []

        def count():
            while not is_done.is_set():
                counted[0] += 1
                time.sleep(0.001)
                try:
                    self.tank.time
                except wavetank.Error as error:
                    refusals.append(str(error))

        is_done = threading.Event()
        thread = threading.Thread(target=count)
        thread.start()
        try:
            self.tank.advance(0.1)
        except wavetank.Error as error:  # the other thread was just looking
            self.assertIn("another thread", str(error))
            self.tank.advance(0.1)
        finally:
            is_done.set()
            thread.join()
        self.assertGreater(counted[0], 10)
        self.assertIn("another thread", refusals[0])

    def test_are_refused_in_a_process_that_was_forked(self):
        child = os.fork()
        if child == 0:  # leaves by _exit only: the rest of the tests is the parent's
            signal.alarm(30)  # rather than wait for ever, where it is not refused
            code = 1
            try:
                self.assert_refused(["forked", "spawn"], self.tank.advance, 0.01)
                self.assert_refused(["forked", "spawn"], self.tank.particles)
                self.tank.close()
                code = 0
            finally:
                os._exit(code)
        self.assertEqual(os.waitpid(child, 0)[1], 0)
        self.tank.advance(0.01)
        self.assertGreaterEqual(self.tank.time, 0.01)

    def test_are_ended_by_ctrl_c(self):
        timer = threading.Timer(0.3, signal.pthread_kill, (threading.main_thread().ident, signal.SIGINT))
        timer.start()
        begin = time.monotonic()
        with self.assertRaises(KeyboardInterrupt):
            self.tank.advance(9.0)
        self.assertLess(time.monotonic() - begin, 5.0)
        self.assertLess(self.tank.time, 9.0)
        before = self.tank.time
        self.tank.advance(0.01)
        self.assertLess(self.tank.time, before + 0.02, "what was cut short is not made up for")


class Bodies(FlyingTest):
    def test_fall_and_are_pushed_as_mechanics_says(self):
        self.assertAlmostEqual(self.box.mass, 500.0 * 0.08 * 0.04, 9)
        numpy.testing.assert_allclose(self.box.position, [0.2, 0, 0.42], atol=1e-12)
        self.box.push(force=[5.0 * self.box.mass, 0, 0])
        self.tank.advance(0.02)
        t = self.tank.time
        numpy.testing.assert_allclose(self.box.velocity, [5.0 * t, 0, -G * t], atol=1e-9)
        numpy.testing.assert_allclose(self.box.angular_velocity, [0, 0, 0], atol=1e-12)
        self.box.push()  # no more
        self.tank.advance(0.02)
        numpy.testing.assert_allclose(self.box.velocity[0], 5.0 * t, atol=1e-9)

    def test_are_turned_by_forces_beside_their_centre(self):
        inertia = self.box.inertia[1, 1]
        self.assertAlmostEqual(inertia, self.box.mass * (0.08**2 + 0.04**2) / 12, 9)
        self.box.push(force=[0, 0, self.box.mass * G], point=[0.22, 0, 0.42])  # 2 cm before the centre: y × is -0.02 × F
        self.tank.advance(0.01)
        t = self.tank.time
        numpy.testing.assert_allclose(self.box.velocity, [0, 0, 0], atol=1e-9)
        numpy.testing.assert_allclose(self.box.angular_velocity, [0, -0.02 * self.box.mass * G / inertia * t, 0], atol=1e-6)
        turn = 2 * numpy.arctan2(self.box.orientation[1], self.box.orientation[3])
        numpy.testing.assert_allclose(self.box.rotation @ [1, 0, 0], [numpy.cos(turn), 0, -numpy.sin(turn)], atol=1e-12)
        self.assertLess(turn, -0.001)

    def test_are_pushed_for_as_long_as_is_said(self):
        self.box.push(force=[5.0 * self.box.mass, 0, 0], duration=0.01)
        self.tank.advance(0.05)
        self.assertAlmostEqual(self.box.velocity[0], 5.0 * 0.01, delta=5.0 * 2 * self.tank.time_step)

    def test_are_pushed_for_one_step_at_least(self):
        self.box.push(force=[5.0 * self.box.mass, 0, 0], duration=1e-7)
        self.tank.advance(1e-7)
        first = self.tank.time
        self.assertEqual(self.tank.step, 1)
        self.tank.advance(0.01)
        self.assertAlmostEqual(self.box.velocity[0], 5.0 * first, 9)

    def test_follow_commands_until_their_timeout(self):
        trolley = self.tank.bodies["trolley"]
        trolley.command(velocity=[-0.3, 0, 0])
        self.tank.advance(0.1)
        numpy.testing.assert_allclose(trolley.velocity, [-0.3, 0, 0], atol=1e-9)
        self.tank.advance(0.2)
        numpy.testing.assert_allclose(trolley.velocity, [0, 0, 0], atol=1e-9)

    def test_refuse_what_they_cannot_do(self):
        self.assert_refused(["trolley", "free"], self.tank.bodies["trolley"].push, force=[1, 0, 0])
        self.assert_refused(["box", "commanded"], self.box.command, velocity=[1, 0, 0])
        self.assert_refused(["force", "three numbers"], self.box.push, force=5.0)
        self.assert_refused(["finite"], self.box.push, force=[float("nan"), 0, 0])
        self.assert_refused(["axes", "'world'"], self.box.push, force=[1, 0, 0], axes="world")
        for duration in (-1, 0, float("nan"), "1", [1.0, 2.0], numpy.ones(2)):
            self.assert_refused(["duration"], self.box.push, force=[1, 0, 0], duration=duration)
        with self.assertRaises(KeyError) as missing:
            self.tank.bodies["bxo"]
        self.assertIn("'box', 'trolley'", str(missing.exception))

    def test_that_jump_stop_the_run_until_it_is_reset(self):
        self.assert_refused(["1000 m/s"], self.box.push, force=[1e9, 0, 0])
        self.box.push(force=[1400, 0, 0])  # 875 m/s² of its 1.6 kg: below what is refused, but soon as fast as sound
        for _ in range(2):
            with self.assertRaises(wavetank.Stopped) as stopped:
                self.tank.advance(0.1)
            self.assertIn("the simulation stops", str(stopped.exception))
        self.tank.reset()
        self.tank.advance(0.01)
        self.assertAlmostEqual(self.box.velocity[0], 0.0, 12)


class Readings(TankTest):
    def test_are_the_newest_samples(self):
        with wavetank.Tank(FLYING) as tank:
            tank.advance(0.01)
            tables = tank.take_samples()
            self.assertEqual(tank.gauges["middle"], tables["gauges"].columns["middle"][-1])
            self.assertEqual(tank.gauges.time, tables["gauges"].times[-1])
            self.assertLess(abs(tank.gauges["middle"] - 0.1), 0.02)
            self.assertEqual(dict(tank.probes), {"P1": tables["probes"].columns["P1"][-1]})
            wrench = tank.bodies["tank"].wrench
            self.assertEqual(wrench.force[2], tables["bodies/tank/wrench"].columns["force_z"][-1])
            self.assertEqual(tank.energies.mass, tables["energies"].columns["mass"][-1])
            self.assertAlmostEqual(tank.energies.mass, 1000.0 * 0.4 * 0.1, delta=1e-6 * 40)
            self.assertEqual(tank.take_samples(), {}, "each is taken once")
            cloud = tank.particles()
            self.assertEqual((cloud.position.shape, cloud.position.dtype), ((len(cloud.id), 3), numpy.float32))
            self.assertEqual(len(set(cloud.id.tolist())), 20 * 5)
            self.assertLess(len(tank.particles(surface_only=True).id), len(cloud.id))
            with self.assertRaises(KeyError):
                tank.gauges["P1"]

    def test_joints_are_commanded(self):
        with wavetank.Tank(FLOATING_BOX) as tank:
            shaft = tank.joints["shaft"]
            shaft.command(0.5)  # rad/s
            tank.advance(0.1)
            self.assertAlmostEqual(shaft.velocity, 0.5, 4)
            self.assertAlmostEqual(shaft.position, 0.05, delta=0.002)
            self.assertAlmostEqual(tank.joints["fender"].position, 0.28, delta=0.01, msg="a spring's length")
            self.assert_refused(["fender", "commanded"], tank.joints["fender"].command, 1.0)

    def test_openings_are_commanded(self):
        case = {
            **FLYING,
            "bodies": [],
            "openings": [{"name": "hose", "kind": "inlet", "centre": [0, 0, 0.05], "normal": [1, 0, 0], "size": [0, 0.06], "command": {"greatest_rate": 1.0}}],
        }
        with wavetank.Tank(case) as tank:
            tank.openings["hose"].command(0.012)
            tank.advance(0.1)
            self.assertAlmostEqual(tank.openings["hose"].discharge, 0.012, delta=1e-6)
            self.assertGreater(tank.openings["hose"].volume, 0.0)
            self.assert_refused(["'hose'", "from 0 to"], tank.openings["hose"].command, -1.0)


class Cases(TankTest):
    def test_are_refused_in_a_sentence(self):
        self.assert_refused(["setting fluid/spacin", "spacing"], wavetank.Tank, self.case(), {"fluid/spacin": 0.02})
        self.assert_refused(["nowhere.yaml"], wavetank.Tank, self.path("nowhere.yaml"))
        self.assert_refused(["the case: fluid is missing"], wavetank.Tank, {"title": "Dry", "duration": 1.0})
        self.assert_refused(["cannot be a value"], wavetank.Tank, self.case(), {"fluid/spacing": object()})
        self.assert_refused(["cannot be a value"], wavetank.Tank, self.case(), {"title": "half a pair: \ud83c"})
        self.assert_refused(["case", "path", "dictionary", "5"], wavetank.Tank, 5)
        moorings = [{"name": "line", "anchor": [x, 0, 0], "attachment": [0, 0, 0], "stiffness": 10.0} for x in (0.1, 0.3)]
        bodies = [dict(FLYING["bodies"][0], moorings=moorings)]
        self.assert_refused(["moorings/1/name is line", "a name of its own"], wavetank.Tank, dict(FLYING, bodies=bodies))
        self.assert_refused(["restore", "path", "5"], wavetank.Tank, self.case(), restore=5)
        self.assert_refused(["settings", "dictionary"], wavetank.Tank, self.case(), ["fluid/spacing"])
        self.assert_refused(["settings", "text", "5"], wavetank.Tank, self.case(), {5: 0.02})
        self.assert_refused(["package"], wavetank.Tank, self.case(tank={"mesh": "package://no_such_package/a.stl"}))
        self.assert_refused(["a.snapshot"], wavetank.Tank, self.case(), restore=self.path("a.snapshot"))

    def test_are_left_by_ctrl_c_in_a_log_line_and_in_an_address(self):
        class Interrupting(logging.Handler):
            def emit(self, record):
                raise KeyboardInterrupt

        logger, handler = logging.getLogger("wavetank"), Interrupting()
        logger.addHandler(handler)
        try:
            with self.assertRaises(KeyboardInterrupt):
                wavetank.Tank(self.case(), {"fluid/spacing": 0.1})  # with a warning: the water is only two spacings deep
        finally:
            logger.removeHandler(handler)
        module = sys.modules[wavetank.Tank.__module__]
        with mock.patch.object(module, "address_to_path", side_effect=KeyboardInterrupt):
            with self.assertRaises(KeyboardInterrupt):
                wavetank.Tank(self.case(tank={"mesh": "package://wavetank/meshes/a.stl"}))
        wavetank.Tank(self.case()).close()  # it was raised once, and is over

    def test_that_nobody_has_any_more_are_gone_at_once(self):
        tank = wavetank.Tank(self.case())
        kept = tank.bodies["step"], tank.gauges
        gone = [weakref.ref(tank), weakref.ref(tank.bodies), weakref.ref(tank._simulation)]
        gc.disable()
        try:
            del tank
            self.assertEqual([reference() is None for reference in gone], [True, True, False], "a body and the gauges still have the simulation")
            self.assertEqual(kept[0].velocity.tolist(), [0, 0, 0])
            del kept
            self.assertIsNone(gone[2]())
        finally:
            gc.enable()

    def test_settings_of_numpy_and_closed_tanks(self):
        tank = wavetank.Tank(self.case(), {"title": "waves \U0001f30a", "duration": numpy.float64(0.04), "fluid/fill/0/box/max": numpy.array([0.4, 0, 0.2])})
        self.assertEqual((tank.duration, tank.case["duration"]), (0.04, 0.04))
        self.assert_refused(["path"], tank.save, 5)
        self.assertEqual(tank.case["title"], "waves \U0001f30a")
        tank.close()
        tank.close()
        self.assert_refused(["closed"], tank.advance, 0.01)


if __name__ == "__main__":
    if not os.environ.get("WAVETANK_PYTHON"):
        print("left out: wavetank.Tank was not built, for want of pybind11-dev or python3-dev")
        sys.exit(0)
    print("wavetank_run is %s" % PROGRAM)
    unittest.main()
