#!/usr/bin/env python3
"""render and export --vtk as a user runs them, against bags whose every place is known, and the files that wavetank_run --vtk writes."""

import os
import re
import signal
import subprocess
import sys
import time
import unittest

import numpy

import program_runner
import water_bag
from program_runner import PACKAGE, ProgramTest
from vtk_reading import read_collection, read_vtp
from wavetank import Failure, camera, rotations
from wavetank.recording import Recording
from wavetank.render import colour_range
from wavetank.scenery import Scenery, Surface
from wavetank.vtk_files import PolyData, up_axis

SCRIPTS = os.path.join(PACKAGE, "scripts")
try:
    import vtkmodules.vtkCommonCore  # noqa: F401
except ImportError:
    vtkmodules = None


def is_there(program):
    return any(os.access(os.path.join(folder, program), os.X_OK) for folder in os.environ["PATH"].split(os.pathsep))


CAN_DRAW = vtkmodules is not None and is_there("Xvfb")
CAN_FILM = CAN_DRAW and is_there("ffmpeg")
MISSING = "python3-vtk9, xvfb or ffmpeg is not installed: scripts/install --render"


class ToolTest(ProgramTest):
    def run_tool(self, tool, *arguments, **environment):
        return subprocess.run(
            [sys.executable, os.path.join(SCRIPTS, tool)] + list(arguments), stdout=subprocess.PIPE, stderr=subprocess.PIPE, universal_newlines=True,
            cwd=self.folder, env=dict(os.environ, **environment), timeout=120,
        )  # fmt: skip

    def assert_sentence(self, done, words):
        self.assertEqual(done.returncode, 2, done.stdout + done.stderr)
        self.assertEqual(len(done.stderr.splitlines()), 1, done.stderr)
        self.assertIn(words, done.stderr)

    def bag(self, **choices):
        water_bag.write_bag(self.path("water.bag"), **choices)
        return "water.bag"


def wait_for(condition, seconds=30):
    end = time.time() + seconds
    while time.time() < end:
        if condition():
            return True
        time.sleep(0.01)
    return False


def runs(process):
    """Whether a process goes on; nobody may be there to take note of its end."""
    try:
        with open("/proc/%d/stat" % process) as file:
            return file.read().rpartition(")")[2].split()[0] != "Z"
    except FileNotFoundError:
        return False


def read_picture(path):
    """Rows of red, green and blue, 0 to 1."""
    from matplotlib import image

    picture = image.imread(path)[:, :, :3]
    return picture / 255.0 if picture.dtype == numpy.uint8 else picture


def blue_part(picture):
    """Of the pixels: those in which blue is well above red, and above green."""
    red, green, blue = (picture[:, :, k] for k in range(3))
    return float(numpy.mean((blue > red + 0.25) & (blue > green + 0.05)))


def orange(picture):
    return picture[:, :, 0] > picture[:, :, 2] + 0.3


class Render(ToolTest):
    @unittest.skipUnless(CAN_DRAW, MISSING)
    def test_particles_make_a_picture(self):
        bag = self.bag()
        done = self.run_tool("render", bag, "-o", "water.png", "--at", "0.05", "--size", "320x180")
        self.assertEqual(done.returncode, 0, done.stderr)
        picture = read_picture(self.path("water.png"))
        self.assertEqual(picture.shape, (180, 320, 3))
        self.assertGreater(blue_part(picture), 0.05)
        hull = orange(picture)
        self.assertGreater(numpy.mean(hull), 0.002)
        self.assertEqual(self.run_tool("render", bag, "-o", "later.jpg", "--at", "0.16", "--size", "320x180").returncode, 0)
        with open(self.path("later.jpg"), "rb") as file:
            self.assertEqual(file.read(3), b"\xff\xd8\xff")
        later = orange(read_picture(self.path("later.jpg")))
        self.assertLess(numpy.nonzero(later)[0].mean(), numpy.nonzero(hull)[0].mean() - 5)  # it rises

    def test_moorings_are_where_they_were_drawn_last(self):
        scenery = Scenery(Recording(self.path(self.bag(moorings=True))))
        self.assertEqual(scenery.moorings_at(49000000).shape, (0, 3))
        self.assertEqual(scenery.moorings_at(149999999).tolist(), [[0, 0, 0.5], [0.5, 0, 0.9], [0.5, 0, 0.9], [1, 0, 0.5]])
        self.assertEqual(scenery.moorings_at(150000000)[1].tolist(), [-0.3, 0, 0.9])

    @unittest.skipUnless(CAN_DRAW, MISSING)
    def test_moorings_are_drawn(self):
        looks = ["--size", "320x180", "--eye", "0.5,-2,0.7", "--target", "0.5,0.5,0.5"]
        for name, moorings in (("with", True), ("without", False)):
            self.assertEqual(self.run_tool("render", self.bag(moorings=moorings), "-o", name + ".png", "--at", "0.05", *looks).returncode, 0)
        changed = numpy.abs(read_picture(self.path("with.png")) - read_picture(self.path("without.png"))).max(axis=2) > 0.1
        self.assertTrue(0.001 < changed.mean() < 0.05, changed.mean())

    @unittest.skipUnless(CAN_DRAW, MISSING)
    def test_a_surface_is_drawn_where_there_is_one(self):
        bag = self.bag(clouds=False, surface=True)
        done = self.run_tool("render", bag, "-o", "water.png", "--size", "320x180", "--eye", "-0.3,-1.5,1.6", "--target", "0.5,0.5,0.4")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertGreater(blue_part(read_picture(self.path("water.png"))), 0.05)

    @unittest.skipUnless(CAN_FILM, MISSING)
    def test_a_film_has_the_pictures_of_its_time(self):
        done = self.run_tool("render", self.bag(), "-o", "water:1.gif", "--size", "160x90", "--fps", "10", "--speed", "0.25")
        self.assertEqual(done.returncode, 0, done.stderr)
        with open(self.path("water:1.gif"), "rb") as file:
            content = file.read()
        self.assertEqual(content[:6] + content[6:10], b"GIF89a" + bytes([160, 0, 90, 0]))
        # from 0.05 s to 0.15 s, 0.025 s apart: some may be one picture shown for longer
        delays = [int.from_bytes(delay, "little") for delay in re.findall(rb"\x21\xf9\x04.(..).\x00", content, re.DOTALL)]
        self.assertGreaterEqual(len(delays), 2)
        self.assertLess(abs(sum(delays) - 50), 15)
        self.assertEqual([name for name in self.files() if "part" in name], [])

    @unittest.skipUnless(CAN_FILM, MISSING)
    def test_what_a_full_disk_does_not_take_is_told(self):
        disk, bag = self.small_disk("4k"), self.bag()
        for name in ("water.mp4", "water.gif", "water.png"):
            speed = ["--speed", "0.5"] if name != "water.png" else []
            done = self.run_tool("render", bag, "-o", os.path.join(disk, name), "--size", "320x180", *speed)
            self.assert_sentence(done, "%s': the disk is full" % name)
            self.assertEqual(os.listdir(disk), [])

    @unittest.skipUnless(vtkmodules, MISSING)
    def test_no_display_is_left_behind(self):
        # one that never takes connections: what draws waits for it
        os.mkdir(self.path("bin"))
        with open(self.path("bin/Xvfb"), "w") as file:
            file.write("#!/bin/sh\necho $$ > pid.part\nmv pid.part pid\nexec sleep 100\n")
        os.chmod(self.path("bin/Xvfb"), 0o755)
        environment = dict(os.environ, PATH=self.path("bin") + os.pathsep + os.environ["PATH"])
        command = [sys.executable, os.path.join(SCRIPTS, "render"), self.bag(), "-o", "a.png"]
        for signal_number in (signal.SIGTERM, signal.SIGINT, signal.SIGKILL):
            drawing = subprocess.Popen(command, cwd=self.folder, env=environment, stderr=subprocess.DEVNULL)
            self.assertTrue(wait_for(lambda: os.path.exists(self.path("pid"))))
            with open(self.path("pid")) as file:
                display = int(file.read())
            os.remove(self.path("pid"))
            drawing.send_signal(signal_number)
            self.assertNotEqual(drawing.wait(timeout=30), 0)
            self.assertTrue(wait_for(lambda: not runs(display)), signal_number)

    def test_colours_have_a_range_whatever_the_values(self):
        self.assertEqual(colour_range(numpy.linspace(0.0, 2.0, 1001), True), (0.0, 2.0))
        for values in (numpy.zeros(5), numpy.full(5, -300.0), numpy.linspace(-500.0, -10.0, 100), numpy.array([numpy.nan, -1.0, 3.0]), numpy.zeros(0)):
            low, high = colour_range(values, False)
            finite = values[numpy.isfinite(values)]
            self.assertTrue(numpy.isfinite([low, high]).all() and low < high, (low, high))
            if len(finite):
                self.assertLessEqual(low, numpy.percentile(finite, 1))
                self.assertGreaterEqual(high, numpy.percentile(finite, 99))

    def test_views_that_cannot_be_followed_are_refused(self):
        view = "Visualization Manager:\n  Global Options:%s\n  Views: {Current: {Focal Point: {X: 1, Y: 2, Z: 3}, Yaw: 0, Pitch: 0, Distance: 4%s}}\n"

        def read(fixed, target=""):
            with open(self.path("my.rviz"), "w") as file:
                file.write(view % (fixed, target))
            return camera.from_rviz(self.path("my.rviz"))

        self.assertEqual((read("").eye.tolist(), read("").in_world), ([5, 2, 3], False))
        self.assertTrue(read(" {Fixed Frame: world}", ", Target Frame: <Fixed Frame>").in_world)
        with self.assertRaisesRegex(Failure, "follows the frame 'tank/bodies/hull', which cannot be drawn"):
            read(" {Fixed Frame: world}", ", Target Frame: tank/bodies/hull")
        with self.assertRaisesRegex(Failure, "holds no view of rviz"):
            read(" [1]")

    def test_what_is_wrong_is_one_sentence(self):
        bag = self.bag()
        water_bag.write_bag(self.path("dry.bag"), clouds=False)
        water_bag.write_bag(self.path("surface.bag"), clouds=False, surface=True)
        for arguments, words in (
            (["none.bag", "-o", "a.png"], "there is no bag 'none.bag'"),
            (["dry.bag", "-o", "a.png"], "holds no water, neither a surface nor point clouds: write it with wavetank_run --surface, --particles or --clouds"),
            ([bag, "-o", "a.avi"], "'a.avi': films end in .mp4 or .gif, pictures in .png or .jpg"),
            ([bag, "-o", "no/such/a.png"], "there is no folder"),
            ([bag, "-o", "a.png", "--at", "0.5"], "--at 0.5 s is outside of what 'water.bag' has of the water: from 0.05 to 0.15 s"),
            ([bag, "-o", "a.mp4", "--from", "-1"], "--from -1 s is outside"),
            ([bag, "-o", "a.mp4", "--from", "0.15", "--to", "0.05"], "is before --from"),
            ([bag, "-o", "a.mp4", "--at", "0.1"], "--at is of a picture"),
            ([bag, "-o", "a.png", "--size", "big"], "--size 'big' is not WIDTHxHEIGHT"),
            ([bag, "-o", "a.png", "--water", "surface"], "holds no surface of the water"),
            (["surface.bag", "-o", "a.png", "--water", "particles"], "holds no particles of the water"),
            (["surface.bag", "-o", "a.png", "--colour", "speed"], "--colour is of particles"),
            (["surface.bag", "-o", "a.png", "--range", "0,1"], "--range is of particles"),
            ([bag, "-o", "a.png", "--target", "0,0,0"], "--target needs --eye"),
            ([bag, "-o", "a.png", "--eye", "0,0,0", "--view", "weir"], "--view tells where the camera is, as --eye does"),
            ([bag, "-o", "a.png", "--fps", "10"], "--fps is of a film"),
            ([bag, "-o", "a.png", "--speed", "1"], "--speed is of a film"),
            ([bag, "-o", "a.mp4", "--speed", "1e-9"], "--speed 1e-09 makes a film of 2.5e+09 pictures, and at most 100000 are drawn"),
            ([bag, "-o", "a.mp4", "--speed", "5e-324"], "pictures, and at most 100000 are drawn"),
        ):
            self.assert_sentence(self.run_tool("render", *arguments, PATH="/nowhere"), words)  # before anything draws
        self.assertEqual(self.files(), ["dry.bag", "surface.bag", "water.bag"])

    def test_what_is_not_installed_is_named(self):
        os.mkdir(self.path("vtkmodules"))
        with open(self.path("vtkmodules/__init__.py"), "w") as file:
            file.write("raise ImportError('not here')\n")
        found = self.folder + os.pathsep + os.environ.get("PYTHONPATH", "")
        done = self.run_tool("render", self.bag(), "-o", "a.png", PYTHONPATH=found)
        self.assert_sentence(done, "scripts/install --render installs it (Debian: python3-vtk9)")
        done = self.run_tool("render", "water.bag", "-o", "a.png", PATH="/nowhere", DISPLAY="")
        self.assert_sentence(done, "scripts/install --render installs it (Debian: xvfb)" if vtkmodules else "(Debian: python3-vtk9)")


class Files(ToolTest):
    def test_export_has_points_values_and_bodies_where_they_are(self):
        done = self.run_tool("export", self.bag(surface=True), "--vtk", "out")
        self.assertEqual(done.returncode, 0, done.stderr)
        listed = read_collection(self.path("out/case.pvd"))
        names = ["surface", "spray", "water", "tank", "body_hull", "probes", "gauges"]
        self.assertEqual([(each, name) for each, name, _ in listed], [(time / 1e3, name) for time in water_bag.TIMES for name in names])
        files = {(each, name): file for each, name, file in listed}
        last = water_bag.TIMES[-1] / 1e3
        arrays, counts = read_vtp(files[last, "water"])
        rows = water_bag.particles()[:399]
        self.assertEqual((counts["Points"], counts["Verts"], counts["Polys"]), (399, 1, 0))
        self.assertEqual(arrays["points"].tolist(), rows[:, :3].tolist())
        self.assertEqual(arrays["velocity"].tolist(), rows[:, 3:6].tolist())
        self.assertEqual(arrays["pressure"].tolist(), rows[:, 6].tolist())
        self.assertEqual((arrays["connectivity"].tolist(), arrays["offsets"].tolist()), (list(range(399)), [399]))
        arrays, counts = read_vtp(files[last, "body_hull"])
        self.assertEqual((counts["Points"], counts["Polys"]), (36, 12))
        position, angle = water_bag.hull_at(water_bag.TIMES[-1])
        expected = (water_bag.box(-0.1 * numpy.ones(3), 0.1 * numpy.ones(3))) @ rotations.turn_about(1, angle).T + position
        numpy.testing.assert_allclose(arrays["points"], expected, atol=1e-9)
        numpy.testing.assert_allclose(arrays["points"].mean(axis=0), position, atol=1e-6)
        self.assertEqual(read_vtp(files[last, "tank"])[1]["Polys"], 10)
        self.assertEqual(read_vtp(files[last, "surface"])[1]["Polys"], 200)
        self.assertEqual(read_vtp(files[last, "spray"])[1]["Points"], 1)
        arrays, _ = read_vtp(files[last, "probes"])
        self.assertEqual((arrays["name"], arrays["pressure"].tolist()), (["P1", "P2"], [300.0, 7.0]))
        # by a quarter about y, x is down
        numpy.testing.assert_allclose(arrays["points"], [position - [0, 0, 0.1], [0.5, 0, 0]], atol=1e-9)
        arrays, _ = read_vtp(files[last, "gauges"])
        self.assertEqual((arrays["name"], arrays["level"].tolist()), (["G"], [0.4 + 0.01 * 3]))
        numpy.testing.assert_allclose(arrays["points"], [[0.2, 0.3, 0.43]], atol=1e-9)
        self.assertEqual([name for _, name, _ in read_collection(self.path("out/data/body_hull.pvd"))], ["body_hull"] * 2)
        with open(self.path("out/view.py")) as file:
            compile(file.read(), "view.py", "exec")
        self.assert_sentence(self.run_tool("export", "water.bag", "--vtk", "out"), "into 'out': it is not empty; give a new folder")
        self.assert_sentence(self.run_tool("export", "water.bag", "--vtk", "water.bag"), "it is no folder")

    def test_what_failed_can_be_tried_again(self):
        self.assert_sentence(self.run_tool("export", self.bag(), "--vtk", "out", ROS_PACKAGE_PATH="/nowhere"), "the package wavetank is not to be found")
        self.assertEqual(self.run_tool("export", "water.bag", "--vtk", "out").returncode, 0)

    def test_bodies_without_poses_are_left_out_with_a_warning(self):
        done = self.run_tool("export", self.bag(odometry=False), "--vtk", "out")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(len(done.stderr.splitlines()), 1, done.stderr)
        self.assertIn("'water.bag' does not tell where body 'hull' is", done.stderr)
        listed = read_collection(self.path("out/case.pvd"))
        self.assertEqual([name for _, name, _ in listed], ["water", "tank", "probes", "gauges"] * len(water_bag.TIMES))
        arrays, _ = read_vtp([file for _, name, file in listed if name == "probes"][-1])
        self.assertEqual((arrays["name"], arrays["pressure"].tolist(), arrays["points"].tolist()), (["P2"], [7.0], [[0.5, 0.0, 0.0]]))

    def test_levels_are_along_the_axis_of_the_top(self):
        # as test/scene has it of the node's
        for case, axis in (
            ({}, 2),
            ({"gravity": [0, 0, 0]}, 2),
            ({"gravity": [-9.81, 0, 0]}, 0),
            ({"gravity": [0, 9.81, 0.1]}, 1),
            ({"gravity": [-9.81, 0, 0], "dimensions": 2}, 0),
            ({"gravity": [7, 0, -7]}, 2),
            ({"gravity": [7, -7, 0]}, 1),
            ({"gravity": [9.0, 0, -1.0], "tank": {"periodic": ["x"]}}, 2),
            ({"gravity": [9.0, 0, 0], "tank": {"periodic": ["x"]}}, 2),
            ({"gravity": [1.0, 9.0, 0], "tank": {"periodic": ["y"]}}, 0),
        ):
            self.assertEqual(up_axis(case), axis, case)

    @unittest.skipUnless(vtkmodules, MISSING)
    def test_vtk_reads_the_same(self):
        from vtkmodules.util.numpy_support import vtk_to_numpy
        from vtkmodules.vtkIOXML import vtkXMLPolyDataReader

        self.assertEqual(self.run_tool("export", self.bag(surface=True), "--vtk", "out").returncode, 0)
        for _, name, file in read_collection(self.path("out/case.pvd")):
            reader = vtkXMLPolyDataReader()
            reader.SetFileName(file)
            reader.Update()
            data, (arrays, counts) = reader.GetOutput(), read_vtp(file)
            self.assertEqual(reader.GetErrorCode(), 0)
            self.assertEqual(
                (data.GetNumberOfPoints(), data.GetNumberOfVerts() + data.GetNumberOfPolys()), (counts["Points"], counts["Verts"] + counts["Polys"])
            )
            self.assertEqual(vtk_to_numpy(data.GetPoints().GetData()).tolist(), arrays["points"].tolist())
            for field in set(arrays) - {"points", "connectivity", "offsets", "name"}:
                self.assertEqual(vtk_to_numpy(data.GetPointData().GetArray(field)).tolist(), arrays[field].tolist(), field)
            if "name" in arrays:
                texts = data.GetPointData().GetAbstractArray("name")
                self.assertEqual([texts.GetValue(n) for n in range(texts.GetNumberOfValues())], arrays["name"])

    @unittest.skipUnless(is_there("pvpython") and is_there("xvfb-run"), "pvpython or xvfb-run is not installed: Debian's python3-paraview, xvfb and xauth")
    def test_paraview_shows_them(self):
        self.assertEqual(self.run_tool("export", self.bag(), "--vtk", "out").returncode, 0)
        command = ["xvfb-run", "-a", "pvpython", "out/view.py", "--png", "seen.png", "--at", "0.05", "--size", "320x180"]
        done = subprocess.run(command, cwd=self.folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, universal_newlines=True, timeout=120)
        self.assertTrue(os.path.exists(self.path("seen.png")), done.stdout)
        picture = read_picture(self.path("seen.png"))
        self.assertEqual(picture.shape, (180, 320, 3))
        red, green, blue = (picture[:, :, k] for k in range(3))
        self.assertGreater(numpy.mean(numpy.abs(red - blue) > 0.25), 0.05)  # the water, from blue to red by its speed
        self.assertGreater(numpy.mean((red > 0.3) & (red > blue + 0.2) & (green > blue + 0.1)), 0.002)  # the hull

    def test_many_particles_are_small_and_quick(self):
        # bars: 5 MB and 0.2 s a frame of 110 thousand; of time twice that, on a machine that is busy
        count, random = 110000, numpy.random.default_rng(20)
        fields = {"velocity": random.random((count, 3), "f4"), "pressure": random.random(count, "f4"), "density": random.random(count, "f4")}
        fields.update(mass=numpy.full(count, 6.1, "f4"), id=numpy.arange(count, dtype="u4"), gamma=numpy.ones(count, "f4"), surface=numpy.zeros(count, "u1"))
        data = PolyData(random.random((count, 3), "f4"), fields, "Verts")
        before = time.process_time()
        data.write(self.path("water.vtp"))
        self.assertLess(time.process_time() - before, 0.4)
        self.assertLess(os.path.getsize(self.path("water.vtp")), 5e6)


FALLING = {"name": "ball", "box": {"min": [0.05, -0.1, 0.28], "max": [0.11, 0.1, 0.34]}, "motion": "free", "density": 500.0}


class FilesOfARun(ToolTest):
    def test_are_those_of_the_bag(self):
        case = self.case(bodies=[FALLING], instruments__pose_rate=1000, rates={"cloud_bag": 50}, duration=0.09)
        result = self.run_program(case, "--bag", "out.bag", "--particles", "--vtk", "out", "--vtk-rate", "50")
        self.assert_runs(result)
        self.assertIn("out/case.pvd", result.stdout)
        recording = Recording(self.path("out.bag"))
        clouds = list(recording.clouds("particles"))
        listed = read_collection(self.path("out/case.pvd"))
        water = [(at, file) for at, name, file in listed if name == "water"]
        self.assertEqual([name for _, name, _ in listed[:5]], ["water", "tank", "body_ball", "probes", "gauges"])
        self.assertEqual((len(water), len(clouds)), (6, 5))
        numpy.testing.assert_allclose([at for at, _ in water[:5]], [stamp / 1e9 for stamp, _ in clouds], rtol=1e-8)
        self.assertAlmostEqual(water[5][0], 0.09, delta=1e-3)  # the end, which no frame is due at
        self.assertEqual(sorted(os.listdir(self.path("out"))), ["case.pvd", "data", "view.py"])
        for (_, file), (_, cloud) in zip(water, clouds):
            arrays, _ = read_vtp(file)
            self.assertEqual(arrays["id"].tolist(), sorted(arrays["id"].tolist()))
            for field, column in (("pressure", "pressure"), ("density", "density"), ("gamma", "shepard"), ("lambda", "eigenvalue"), ("surface", "surface")):
                self.assertEqual(sorted(arrays[field].tolist()), sorted(cloud[column].tolist()))
            rows = numpy.column_stack([cloud[axis] for axis in ("x", "y", "z", "vx", "vy", "vz")])
            self.assertEqual(sorted(numpy.column_stack([arrays["points"], arrays["velocity"]]).tolist()), sorted(rows.tolist()))
            self.assertAlmostEqual(float(arrays["mass"].sum()), 0.4 * 0.2 * 1000.0, delta=0.05)
        odometry = recording.table("bodies/ball/odom")
        for at, name, file in listed:
            if name == "body_ball":
                centre = read_vtp(file)[0]["points"].reshape(-1, 3).mean(axis=0)
                # a body that falls is between two samples where a parabola has it
                after = int(numpy.clip(numpy.searchsorted(odometry.times, at), 2, len(odometry) - 1))
                fit = numpy.polyfit(odometry.times[after - 2 : after + 1] - at, odometry.columns["position_z"][after - 2 : after + 1], 2)
                self.assertAlmostEqual(centre[2], fit[-1], delta=1e-6)
        self.assertLess(centre[2], 0.305)  # it fell by gt²/2
        gauge = [read_vtp(file)[0] for _, name, file in listed if name == "gauges"][-1]
        self.assertEqual(gauge["name"], ["H1"])
        self.assertAlmostEqual(gauge["level"][0], recording.table("gauges").columns["H1"][-1], delta=0.01)
        probes = [read_vtp(file)[0] for _, name, file in listed if name == "probes"][0]
        self.assertEqual(probes["pressure"].tolist(), [recording.table("probes").columns[name][0] for name in ("P1", "P2")])

    def test_are_whole_after_a_kill(self):
        run = self.start_program(self.case(duration=1000.0), "--vtk", "out", "--vtk-rate", "1000")
        deadline = time.time() + 60
        while time.time() < deadline and not os.path.exists(self.path("out/data/water_00020.vtp")):
            time.sleep(0.01)
        run.send_signal(signal.SIGKILL)
        run.wait()
        listed = read_collection(self.path("out/case.pvd"))
        self.assertGreaterEqual(len(listed), 20 * 5)
        for _, _, file in listed:
            self.assertGreater(read_vtp(file)[1]["Points"], 0, file)
        for name in ("water", "tank", "body_step", "probes", "gauges"):
            self.assertGreaterEqual(len(read_collection(self.path("out/data/%s.pvd" % name))), 11)  # replaced every ten frames

    def test_have_the_surface_of_the_bag(self):
        case = self.case(rates={"surface_bag": 50})
        result = self.run_program(case, "--surface", "--bag", "out.bag", "--vtk", "out", "--vtk-rate", "50")
        if result.returncode == 2 and "scripts/install --surface" in result.stderr:
            self.skipTest("this build finds no surface: OpenVDB was not there")
        self.assert_runs(result)
        listed = read_collection(self.path("out/case.pvd"))
        self.assertEqual([name for _, name, _ in listed[:4]], ["surface", "spray", "water", "tank"])
        surface = Surface(Recording(self.path("out.bag")))
        written = [read_vtp(file) for _, name, file in listed if name == "surface"]
        self.assertEqual(len(written), len(surface.stamps) + 1)  # and one at the end
        for n, (arrays, counts) in enumerate(written[:-1]):
            corners, _ = surface.at(n)
            self.assertGreater(counts["Polys"], 100)
            self.assertEqual(arrays["points"].tolist(), corners.tolist())

    def test_have_the_state_that_the_watchdog_stopped(self):
        water = [{"box": {"min": [0, 0, 0.1], "max": [0.1, 0, 0.38]}}]  # falls faster than half of the speed of sound
        case = self.case(duration=2.0, fluid__sound_speed=0.6, fluid__fill=water, bodies=None)
        result = self.run_program(case, "--vtk", "out", "--vtk-rate", "1")
        self.assertEqual(result.returncode, 3, result.stdout + result.stderr)
        times = [at for at, name, _ in read_collection(self.path("out/case.pvd")) if name == "water"]
        self.assertEqual((len(times), times[0]), (2, 0.0))  # the second before one is due
        self.assertTrue(0.0 < times[1] < 0.5, times)
        self.assertEqual([at for at, _, _ in read_collection(self.path("out/data/water.pvd"))], times)

    def test_what_is_wrong_is_one_sentence(self):
        os.mkdir(self.path("full"))
        open(self.path("full/other"), "w").close()
        case = self.case()
        for arguments, words in (
            (["--vtk", "full"], "into 'full': it is not empty; give a new folder, or empty it"),
            (["--vtk", "no/such"], "into 'no/such': there is no folder 'no'"),
            (["--vtk", case], "it is no folder"),
            (["--vtk", "/proc/out"], "cannot write files for ParaView into '/proc/out'"),
            (["--vtk-rate", "10"], "--vtk-rate needs --vtk DIR"),
            (["--vtk", "new", "--vtk-rate", "0"], "--vtk-rate must be greater than 0"),
            (["--vtk", ""], "--vtk: the folder has no name"),
            (["--particles"], "--particles needs --bag FILE"),
            (["--bag", "new", "--vtk", "new"], "--bag and --vtk are both 'new'; give each a name of its own"),
            (["--save", "new", "--vtk", "./new/"], "--vtk and --save are both './new/'"),
        ):
            self.assert_refused(self.run_program(case, *arguments), words)
        self.assertEqual(self.files(), ["case.yaml", "full"])

    def test_a_full_disk_ends_the_run_with_all_until_then(self):
        disk = self.small_disk("1m")
        result = self.run_program(self.case(duration=1000.0), "--bag", "out.bag", "--vtk", os.path.join(disk, "out"), "--vtk-rate", "1000")
        self.assert_refused(result, "cannot write the file for ParaView", "the disk is full", "the run stops at", "the bag has all samples until then")
        listed = read_collection(os.path.join(disk, "out", "case.pvd"))
        self.assertGreater(len(listed), 5)
        for _, _, file in listed:
            read_vtp(file)
        self.assertTrue({"out.bag", "out.snapshot"} <= set(self.files()))

    def test_a_disk_too_small_for_the_first_frame(self):
        disk = self.small_disk("16k")  # for view.py and not for the water
        result = self.run_program(self.case(duration=1000.0), "--vtk", os.path.join(disk, "out"), "--vtk-rate", "1")
        self.assert_refused(result, "cannot write the file for ParaView", "the disk is full", "the run stops at")  # long before another frame is due
        self.assertLess(float(re.search(r"stops at ([0-9.e+-]+) s", result.stderr).group(1)), 0.9)
        self.assertNotIn("for ParaView", result.stdout)


if __name__ == "__main__":
    program_runner.main()
