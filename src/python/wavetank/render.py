"""Draws the water of a bag, with tank and bodies, as a picture or a film."""

import argparse
import contextlib
import errno
import os
import shutil
import subprocess
import sys
import tempfile

import numpy

from wavetank import Failure
from wavetank import camera as cameras
from wavetank.display import INSTALL, Display
from wavetank.recording import Recording
from wavetank.scenery import Particles, Scenery
from wavetank.vtk_files import write_whole

FILMS, PICTURES = (".mp4", ".gif"), (".png", ".jpg")
JPEG_QUALITY = 90  # of 100
MOST_PICTURES = 100000  # of a film, which is more than an hour
PLAIN = {"view": None, "eye": None, "target": None, "colour": "speed", "range": None, "fps": None, "speed": 1.0}  # where nothing is said
UNITS = {"speed": "speed (m/s)", "pressure": "pressure (Pa)"}


def pair(text, separator, kind):
    parts = text.split(separator)
    if len(parts) != 2:
        raise ValueError
    return tuple(kind(part) for part in parts)


def picture_size(text):
    try:
        size = pair(text, "x", int)
    except ValueError:
        raise Failure("--size '%s' is not WIDTHxHEIGHT in pixels, as 1280x720" % text)
    if min(size) < 16 or max(size) > 8192:
        raise Failure("--size '%s': from 16 to 8192 pixels" % text)
    return tuple(number + number % 2 for number in size)  # films take even numbers only


def numbers(text, count, what):
    try:
        values = [float(part) for part in text.split(",")]
        if len(values) != count or not numpy.all(numpy.isfinite(values)):
            raise ValueError
        return numpy.array(values)
    except ValueError:
        raise Failure("%s '%s' is not %s" % (what, text, ",".join("XYZ"[:count]) if count == 3 else "LOW,HIGH"))


def read_arguments(arguments):
    parser = argparse.ArgumentParser(prog="render", description=__doc__, epilog="docs/pictures.md has examples. Drawn without a display, by VTK.")
    parser.add_argument("bag", help="written by wavetank_run with --surface, --particles or --clouds")
    parser.add_argument("-o", "--output", metavar="FILE", required=True, help="a film (.mp4, .gif), or a picture (.png, .jpg)")
    parser.add_argument("--at", metavar="S", type=float, help="of a picture: simulated time, s; the nearest that was recorded (the last)")
    parser.add_argument("--from", metavar="S", type=float, dest="begin", help="of a film: simulated time that it begins at, s")
    parser.add_argument("--to", metavar="S", type=float, dest="end", help="and ends at")
    parser.add_argument("--fps", metavar="N", type=float, help="pictures a second of a film (25; gif: 12.5)")
    parser.add_argument("--speed", metavar="X", type=float, help="simulated seconds a second of a film (1)")
    parser.add_argument("--size", metavar="WxH", default="1280x720", help="pixels (1280x720)")
    parser.add_argument("--view", metavar="VIEW", help="of rviz: a file, or the name of one of the package's (that of the case, or all of the tank)")
    parser.add_argument("--eye", metavar="X,Y,Z", help="where the camera is, m")
    parser.add_argument("--target", metavar="X,Y,Z", help="what it looks at, m (the middle of the tank)")
    parser.add_argument("--water", choices=("surface", "particles"), help="what the water is drawn as (the surface, if the bag has it)")
    parser.add_argument("--colour", choices=("speed", "pressure"), help="that particles are coloured by (speed)")
    parser.add_argument("--range", metavar="LOW,HIGH", help="of the colours, m/s or Pa")
    parser.add_argument("-n", "--namespace", help="of the tank, if the bag holds several (/wavetank)")
    return parser.parse_args(with_values(arguments))


def with_values(arguments):
    """Places may begin with a minus, which argparse takes for an option if it stands by itself."""
    result = []
    for argument in arguments:
        if result and result[-1] in ("--eye", "--target", "--range"):
            result[-1] += "=" + argument
        else:
            result.append(argument)
    return result


def times_of(options, stamps, ending):
    """Which of the recorded times are drawn, one after the other."""
    first, last = stamps[0] / 1e9, stamps[-1] / 1e9
    slack = 1e-6 + (0.5 * (last - first) / (len(stamps) - 1) if len(stamps) > 1 else 0.0)

    def checked(time, flag):
        if not first - slack <= time <= last + slack:
            raise Failure("%s %g s is outside of what '%s' has of the water: from %g to %g s" % (flag, time, options.bag, first, last))
        return time

    def nearest(times):
        after = numpy.clip(numpy.searchsorted(stamps, times * 1e9), 1, len(stamps) - 1) if len(stamps) > 1 else numpy.zeros(len(times), int)
        before = numpy.maximum(after - 1, 0)
        return numpy.where(times * 1e9 - stamps[before] <= stamps[after] - times * 1e9, before, after)

    if ending in PICTURES:
        if options.begin is not None or options.end is not None:
            raise Failure("a picture is of one time: give it by --at, or write a film (%s)" % ", ".join(FILMS))
        return nearest(numpy.array([last if options.at is None else checked(options.at, "--at")]))
    if options.at is not None:
        raise Failure("--at is of a picture (.png, .jpg): a film goes from --from to --to")
    begin = first if options.begin is None else checked(options.begin, "--from")
    end = last if options.end is None else checked(options.end, "--to")
    if end < begin:
        raise Failure("--to %g s is before --from %g s" % (end, begin))
    fps = frames_a_second(options, ending)
    if not (options.speed > 0 and numpy.isfinite(options.speed)):
        raise Failure("--speed must be greater than 0")
    count = float(end - begin) / options.speed * fps + 1
    if not count < MOST_PICTURES + 1:
        raise Failure("--speed %g makes a film of %.3g pictures, and at most %d are drawn" % (options.speed, numpy.floor(count), MOST_PICTURES))
    return nearest(numpy.arange(begin, end + 1e-9, options.speed / fps))


def frames_a_second(options, ending):
    fps = options.fps if options.fps is not None else 12.5 if ending == ".gif" else 25.0
    if not 0.1 <= fps <= 100:
        raise Failure("--fps %g: from 0.1 to 100" % fps)
    return fps


def ending_of(path):
    ending = os.path.splitext(path)[1].lower()
    if ending not in FILMS + PICTURES:
        raise Failure("'%s': films end in %s, pictures in %s" % (path, " or ".join(FILMS), " or ".join(PICTURES)))
    folder = os.path.dirname(os.path.abspath(path))
    if not os.path.isdir(folder):
        raise Failure("cannot write '%s': there is no folder '%s'" % (path, folder))
    if not os.access(folder, os.W_OK) or os.path.isdir(path):
        raise Failure("cannot write '%s': %s" % (path, "it is a folder" if os.path.isdir(path) else "the folder is not writable"))
    return ending


def value_of(cloud, name):
    if name == "pressure":
        return cloud["pressure"]
    return numpy.sqrt(cloud["vx"].astype(float) ** 2 + cloud["vy"].astype(float) ** 2 + cloud["vz"].astype(float) ** 2)


def check_choices(options, ending, water):
    """Of what is drawn and from where, before anything is: nothing that is asked for may have no effect. Fills in what is not."""

    def refuse(flag, why):
        if getattr(options, flag) is not None:
            raise Failure("--%s %s" % (flag, why))

    if ending in PICTURES:
        for flag in ("fps", "speed"):
            refuse(flag, "is of a film (%s), and a picture is asked for" % ", ".join(FILMS))
    if not isinstance(water, Particles):
        for flag in ("colour", "range"):
            refuse(flag, "is of particles, and the water is drawn as its surface: add --water particles, if the bag has them")
    if options.eye is None:
        refuse("target", "needs --eye, from where it is looked at")
    else:
        refuse("view", "tells where the camera is, as --eye does: give one of them")
    for flag, plain in PLAIN.items():
        if getattr(options, flag) is None:
            setattr(options, flag, plain)
    if options.eye is not None:
        options.eye = numbers(options.eye, 3, "--eye")
    if options.target is not None:
        options.target = numbers(options.target, 3, "--target")
    if options.range is not None:
        low, high = numbers(options.range, 2, "--range")
        if not low < high:
            raise Failure("--range '%s': the first must be less than the second" % options.range)
        options.range = (low, high)


def colour_range(values, starts_at_zero):
    """(low, high) of a scale that nearly all values lie in, as wide as reads well; from 0 on, or from below where values are."""
    values = values[numpy.isfinite(values)]
    low, high = numpy.percentile(values, [1, 99]) if len(values) else (0.0, 1.0)
    low = 0.0 if starts_at_zero else min(0.0, float(low))
    return low, low + rounded_up(max(float(high) - low, 1e-6))


def rounded_up(value):
    """To a number that reads well."""
    step = 0.4 * 10.0 ** numpy.floor(numpy.log10(value))  # so that a quarter of it does, too
    return float(step * numpy.ceil(value / step - 1e-9))


def find_ffmpeg():
    program = shutil.which("ffmpeg")
    if program is None:
        raise Failure("films are written by ffmpeg, which is not there: %s (Debian: ffmpeg); pictures (.png, .jpg) do without" % INSTALL)
    return program


# Each picture with a palette of its own: one for all of them would have ffmpeg keep them all until the end.
GIF_COLOURS = "split[a][b];[a]palettegen=stats_mode=single[p];[b][p]paletteuse=new=1:dither=bayer:bayer_scale=4"


class Film:
    """Pictures one after the other into a file, by ffmpeg."""

    def __init__(self, path, ending, size, fps):
        self._path, self._part = path, path + ".part" + ending
        self._errors = tempfile.TemporaryFile()  # not a pipe, which nobody would empty while pictures are drawn
        command = [find_ffmpeg(), "-loglevel", "error", "-xerror", "-y"]
        command += ["-f", "rawvideo", "-pix_fmt", "rgb24", "-s", "%dx%d" % size, "-r", "%g" % fps, "-i", "-"]
        if ending == ".gif":
            command += ["-filter_complex", GIF_COLOURS]
        else:
            command += ["-c:v", "libx264", "-preset", "veryfast", "-crf", "20", "-pix_fmt", "yuv420p", "-movflags", "+faststart"]
        command.append("file:" + self._part)  # or else a colon in the name makes a protocol of it
        self._process = subprocess.Popen(command, stdin=subprocess.PIPE, stderr=self._errors, start_new_session=True)

    def add(self, picture):
        try:
            self._process.stdin.write(picture.tobytes())
        except BrokenPipeError:
            self._end(is_whole=False)

    def end(self):
        """The file gets its name if all of it was written."""
        try:
            self._process.stdin.close()
        except BrokenPipeError:
            self._end(is_whole=False)
        self._end(is_whole=True)

    def _end(self, is_whole):
        code = self._process.wait()
        self._errors.seek(0)
        errors = self._errors.read().decode("utf-8", "replace").strip()
        if code != 0 or errors or not is_whole:  # of a full disk it may tell and yet end with 0
            self.discard()
            reason = (
                "the disk is full" if os.strerror(errno.ENOSPC) in errors else errors.splitlines()[-1] if errors else "ffmpeg ends with exit code %d" % code
            )
            raise Failure("cannot write '%s': %s" % (self._path, reason))
        os.replace(self._part, self._path)

    def discard(self):
        """Of a film that does not come to its end."""
        if self._process.poll() is None:
            self._process.kill()
            self._process.wait()
        try:
            self._process.stdin.close()
        except OSError:
            pass  # what it did not take
        self._errors.close()
        if os.path.exists(self._part):
            os.remove(self._part)


def write_picture(path, ending, picture):
    from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
    from vtkmodules.vtkCommonDataModel import vtkImageData
    from vtkmodules.vtkIOImage import vtkJPEGWriter, vtkPNGWriter

    height, width, _ = picture.shape
    image = vtkImageData()
    image.SetDimensions(width, height, 1)
    image.GetPointData().SetScalars(numpy_to_vtk(numpy.ascontiguousarray(picture[::-1]).reshape(-1, 3), deep=True))
    if ending == ".png":
        writer = vtkPNGWriter()
    else:
        writer = vtkJPEGWriter()
        writer.SetQuality(JPEG_QUALITY)
    writer.SetInputData(image)
    writer.WriteToMemoryOn()
    writer.Write()
    write_whole(path, [vtk_to_numpy(writer.GetResult()).tobytes()])


def outer_walls(corners):
    """Of triangles of a tank: which have all of it on one side, and their normals to that side."""
    normals = numpy.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals /= numpy.maximum(numpy.linalg.norm(normals, axis=1, keepdims=True), 1e-300)
    points = numpy.unique(corners.reshape(-1, 3), axis=0)
    points = points[:: max(1, len(points) // 2000)]  # of a fine mesh some are enough
    slack = 1e-4 * numpy.linalg.norm(points.max(axis=0) - points.min(axis=0))
    least, most = numpy.empty(len(corners)), numpy.empty(len(corners))
    for begin in range(0, len(corners), 1000):
        part = slice(begin, begin + 1000)
        distances = normals[part] @ points.T - numpy.einsum("ij,ij->i", normals[part], corners[part, 0])[:, None]
        least[part], most[part] = distances.min(axis=1), distances.max(axis=1)
    return (least > -slack) | (most < slack), numpy.where(most[:, None] < slack, -normals, normals)


class Drawing:
    """The stage of a bag, and how it changes with time."""

    def __init__(self, scenery, water, options, size):
        from wavetank import picture

        self._picture, self._scenery, self._water, self._options = picture, scenery, water, options
        self._dimensions = int(scenery.number("dimensions") or 3)
        self._spacing = scenery.number("fluid", "spacing")
        low, high = self._bounds()
        self._camera = self._find_camera(low, high, size)
        self.stage = picture.Stage(size, self._camera)
        self._actors = []  # (actor, pose or None)
        self._glass = numpy.empty((0, 3))
        self._add_shapes()
        self._moorings = self.stage.add_lines(picture.MOORING, max(1.5, size[1] / 300))
        self._add_water(high - low)
        self._add_glass()
        self._clock = self.stage.add_text((0.02, 0.02), max(12, size[1] // 26))

    def _bounds(self):
        points = [shape.points for shape in self._scenery.shapes() if shape.pose is None]
        if not points:
            points = [self._points_of_water(0)]
        points = numpy.concatenate(points)
        return points.min(axis=0), points.max(axis=0)

    def _points_of_water(self, n):
        if isinstance(self._water, Particles):
            cloud = self._water.cloud(n)
            return numpy.column_stack([cloud[axis] for axis in "xyz"])
        return self._water.at(n)[0]

    def _find_camera(self, low, high, size):
        camera = self._wanted_camera(low, high, size)
        camera.is_flat = self._dimensions == 2
        return camera

    def _wanted_camera(self, low, high, size):
        options = self._options
        if options.eye is not None:
            eye, target = options.eye, options.target if options.target is not None else (low + high) / 2
            if numpy.allclose(eye, target):
                raise Failure("--eye and --target are one place: there is nothing to see")
            upright = numpy.linalg.norm((eye - target)[:2]) > 1e-3 * numpy.linalg.norm(eye - target)
            return cameras.Camera(eye, target, up=(0, 0, 1) if upright else (0, 1, 0))
        view = cameras.find_view(options.view) if options.view else cameras.view_of(self._scenery.title)
        if view:
            return cameras.from_rviz(view)
        return cameras.fitting(low, high, self._dimensions, size[0] / size[1])

    def _add_shapes(self):
        picture, stage = self._picture, self.stage
        width = max(1.0, stage.size[1] / 500)
        for name, shape in self._scenery.meshes.items():
            if name == "tank":
                self._add_tank(shape)
            else:
                self._actors.append((stage.add_mesh(shape.points, picture.BODY), shape.pose))
        for name, shape in self._scenery.edges.items():
            colour = picture.GLASS_EDGE if name == "tank" else picture.BODY_EDGE
            self._actors.append((stage.add_edges(shape.points, colour, width), shape.pose))

    def _add_tank(self, shape):
        """Walls behind the water as they are, those before it as glass; those within the tank, which may be either, let something through."""
        if self._dimensions == 2:
            return  # its edges say all
        corners = shape.points.reshape(-1, 3, 3)
        outer, inwards = outer_walls(corners)
        behind = outer & (numpy.einsum("ij,ij->i", inwards, self.stage.eye - corners[:, 0]) > 0)
        for which, opacity in ((behind, 1.0), (~outer, 0.4)):
            if which.any():
                self._actors.append((self.stage.add_mesh(corners[which].reshape(-1, 3), self._picture.FLOOR, opacity), None))
        self._glass = corners[outer & ~behind].reshape(-1, 3)

    def _add_glass(self):
        """After the water, since it is before it."""
        if len(self._glass):
            self._actors.append((self.stage.add_mesh(self._glass, self._picture.GLASS, 0.08), None))

    def _add_water(self, extent):
        radius = 0.5 * (self._spacing or 0.005 * float(numpy.linalg.norm(extent)))
        if isinstance(self._water, Particles):
            low, high = self._range()
            table = self._picture.colour_table(self._options.colour, low, high)
            is_flat = self._dimensions == 2
            self._look = self._picture.SphereLook(self.stage, (1.7 if is_flat else 1.1) * radius, table, is_flat)
            self.stage.add_scale(table, UNITS[self._options.colour])
        else:
            self._look = self._picture.SurfaceLook(self.stage, 0.7 * radius)
        self._actors += [(actor, None) for actor in self._look.actors]

    def _range(self):
        """Of the colours, the same in all pictures: nearly all values that a few of the times have."""
        if self._options.range:
            return self._options.range
        count = len(self._water.stamps)
        values = [value_of(self._water.cloud(n), self._options.colour) for n in sorted(set(numpy.linspace(0, count - 1, 12).astype(int)))]
        values = numpy.concatenate(values) if values else numpy.zeros(0)
        return colour_range(values, self._options.colour == "speed")

    def draw(self, n):
        stamp = int(self._water.stamps[n])
        picture = self._picture
        tank = world = numpy.eye(4)  # from the frames of the tank and of the world to the camera's
        if self._scenery.tank_pose is not None:
            in_world = picture.matrix_of(*self._scenery.tank_pose.at(stamp))
            tank, world = (in_world, world) if self._camera.in_world else (tank, numpy.linalg.inv(in_world))
        for actor, pose in self._actors:
            picture.place(actor, tank if pose is None else tank @ picture.matrix_of(*pose.at(stamp)))
        picture.set_lines(self._moorings, self._scenery.moorings_at(stamp))
        picture.place(self._moorings, world)
        if isinstance(self._water, Particles):
            cloud = self._water.cloud(n)
            self._look.show(numpy.column_stack([cloud[axis] for axis in "xyz"]), value_of(cloud, self._options.colour))
        else:
            eye = numpy.linalg.solve(tank, numpy.append(self.stage.eye, 1.0))[:3]
            self._look.show(*self._water.at(n), eye)
        self._clock.SetInput("t = %.2f s" % (stamp / 1e9))
        return self.stage.draw()


def main(arguments):
    options = read_arguments(arguments)
    ending, size = ending_of(options.output), picture_size(options.size)
    recording = Recording(options.bag, options.namespace)
    scenery = Scenery(recording)
    water = scenery.particles() if options.water == "particles" else scenery.water()
    if options.water == "surface" and isinstance(water, Particles):
        raise Failure("'%s' holds no surface of the water: write it with wavetank_run --surface" % options.bag)
    check_choices(options, ending, water)
    times = times_of(options, water.stamps, ending)
    # told before anything is drawn
    if ending in FILMS:
        find_ffmpeg()
    from wavetank import picture  # noqa: F401: imports VTK

    with Display():
        write(options, ending, size, Drawing(scenery, water, options, size), times)
    print("wrote '%s'" % options.output)


@contextlib.contextmanager
def told_of(path):
    """What the disk refuses becomes a sentence."""
    try:
        yield
    except OSError as error:
        raise Failure("cannot write '%s': %s" % (path, "the disk is full" if error.errno == errno.ENOSPC else error.strerror or error))


def write(options, ending, size, drawing, times):
    try:
        if ending in PICTURES:
            picture = drawing.draw(times[0])
            with told_of(options.output):
                write_picture(options.output, ending, picture)
            return
        film = Film(options.output, ending, size, frames_a_second(options, ending))
        try:
            for count, n in enumerate(times):
                picture = drawing.draw(n)
                with told_of(options.output):
                    film.add(picture)
                if sys.stdout.isatty():
                    print("\rpicture %d of %d" % (count + 1, len(times)), end="", flush=True)
            with told_of(options.output):
                film.end()
        finally:
            film.discard()
            if sys.stdout.isatty():
                print("\r\033[K", end="")
    finally:
        drawing.stage.end()
