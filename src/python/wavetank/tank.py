"""A wave tank in this process, advanced step by step, without ROS: wavetank.Tank. Case, units and axes are those of docs/case.md; docs/python.md tells how."""

import collections
import collections.abc
import json
import os
import re

import numpy

from wavetank import Error
from wavetank.names import level_of
from wavetank.recording import AXES, Table
from wavetank.runs import read_yaml

try:
    from wavetank import _simulation
except ImportError as error:
    if isinstance(error, ModuleNotFoundError) or "cannot import name" in str(error):
        reason = "which is not there for this Python: install pybind11-dev and python3-dev (scripts/install --python), build again and source setup.bash"
    else:
        reason = "which cannot be loaded (%s): source setup.bash" % error
    raise ImportError("wavetank.Tank needs the extension wavetank._simulation, " + reason) from None

FOREVER = 1e300  # s
NOTHING = (0.0, 0.0, 0.0)
TANK = "tank"
QUATERNION = AXES + ("w",)
POSED_JOINTS = ("hinge", "slider", "spring")

Wrench = collections.namedtuple("Wrench", "time force torque")
Imu = collections.namedtuple("Imu", "time orientation angular_velocity specific_force")
SectionFlow = collections.namedtuple("SectionFlow", "discharge area")
Energies = collections.namedtuple("Energies", "time kinetic potential compression mass damper_power")
Particles = collections.namedtuple("Particles", "time id position velocity pressure density shepard surface eigenvalue")


# What follows has the simulation and not its Tank: a Tank that nobody has any more must go at once, with its memory on the device, and not wait for the
# collector of cycles.


def newest(simulation, kind):
    """Time and row of the newest sample of a kind."""
    samples = simulation.newest_samples()
    if kind not in samples:
        raise Error("there is no sample yet of %s: advance the tank" % kind)
    times, values = samples[kind]
    return float(times[0]), values[0]


class ByName(collections.abc.Mapping):
    """Things of a tank by their names in the case, in its order. what: they are, for messages."""

    def __init__(self, what, names, make):
        self._what, self._names, self._make = what, list(names), make

    def __getitem__(self, name):
        if name not in self._names:
            there_are = "only " + ", ".join(map(repr, self._names)) if self._names else "none at all"
            raise KeyError("there is no %s %r, %s" % (self._what, name, there_are))
        return self._make(self._names.index(name))

    def __iter__(self):
        return iter(self._names)

    def __len__(self):
        return len(self._names)

    def __repr__(self):
        return repr(dict(self))


class Readings(ByName):
    """The newest samples of instruments of a kind, by name. width: numbers of each."""

    def __init__(self, simulation, what, names, kind, width=1, shape=float):
        super().__init__(what, names, lambda n: shape(*newest(simulation, kind)[1][width * n : width * (n + 1)]))
        self._simulation, self._kind = simulation, kind

    @property
    def time(self):
        """s of simulated time, that they are of: the newest on the instruments' clock that the simulation has passed."""
        return newest(self._simulation, self._kind)[0]


class Body:
    """A body of the tank, or "tank", the tank itself. Vectors are arrays of three in the tank's coordinates and axes (of the tank itself, in the world's)
    unless it is said otherwise; SI units; in 2-D forces, torques and masses are those of a metre of width."""

    def __init__(self, simulation, owner, name, motion, imus):
        self._simulation, self._owner, self._imus = simulation, owner, imus
        self.name = name
        self.motion = motion  # fixed, free, prescribed or commanded

    def _state(self, part):
        return numpy.array(self._simulation.body_state(self._owner)[part])

    @property
    def position(self):
        """m, of the centre of mass (of a tank that is not free, of the case's origin), at the tank's time."""
        return self._state(0)

    @property
    def orientation(self):
        """x, y, z, w of the quaternion that turns the body from where the case has it."""
        return self._state(1)

    @property
    def rotation(self):
        """The same as a matrix, which takes vectors from the body's axes to the tank's."""
        x, y, z, w = self.orientation
        return numpy.array(
            [
                [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
            ]
        )

    @property
    def velocity(self):
        """m/s, of that point, relative to the tank."""
        return self._state(2)

    @property
    def angular_velocity(self):
        """rad/s, relative to the tank."""
        return self._state(3)

    @property
    def mass(self):
        """kg; 0 of a body that is not free and has none in the case."""
        return self._simulation.mass_of(self._owner)[0]

    @property
    def inertia(self):
        """kg m², a matrix about the centre of mass, in the axes that the body has at the start; in 2-D only its middle counts."""
        return numpy.array(self._simulation.mass_of(self._owner)[1])

    @property
    def wrench(self):
        """The newest sample of what the water does to the body: time (s), force (N) and torque (N m, about the centre of mass) in the body's own axes."""
        time, row = newest(self._simulation, "wrenches")
        row = row[18 * self._owner :]
        return Wrench(time, row[0:3].copy(), row[3:6].copy())

    @property
    def imu(self):
        """The newest sample of the body's inertial measurement unit: time, orientation in the world, angular velocity and specific force in its own axes."""
        if self.name not in self._imus:
            raise Error("body '%s' has no imu in the case (bodies/N/imu)" % self.name)
        time, row = newest(self._simulation, "imus")
        row = row[10 * self._imus.index(self.name) :]
        return Imu(time, row[0:4].copy(), row[4:7].copy(), row[7:10].copy())

    def push(self, force=NOTHING, torque=NOTHING, point=None, duration=None, axes="tank"):
        """A force (N) and a torque (N m) from outside on a free body, from the next step on, in the place of those of the push before.

        point: m, where the force acts; None: at the centre of mass. duration: s of simulated time, rounded to whole steps, one at least; None: until the next push.
        axes: "tank": force, torque and point are in the tank's axes and coordinates as they are now, and keep their directions while it lasts;
        "body": in the body's, point counted from its centre of mass, and all turns with the body. Raises Error."""
        force, torque = vector_of("force", force), vector_of("torque", torque)
        if axes not in ("tank", "body"):
            raise Error("axes must be 'tank' or 'body', not %r" % (axes,))
        if duration is not None:
            duration = number_of("duration", duration)
        if duration is not None and not duration > 0:
            raise Error("duration must be greater than 0 s, or None for until the next push, not %r" % (duration,))
        if point is not None:
            if self._owner == 0:
                raise Error("a push of the tank itself acts at its centre of mass: give no point")
            arm = vector_of("point", point) - (self.position if axes == "tank" else 0.0)
            torque = torque + numpy.cross(arm, force)
        self._simulation.push(self._owner, force, torque, axes == "body", FOREVER if duration is None else duration)

    def command(self, velocity=NOTHING, angular_velocity=NOTHING):
        """The velocity (m/s) and angular velocity (rad/s), in the body's own axes, that a commanded body is to have, within the limits that the case sets;
        held for the case's command/timeout. Raises Error."""
        self._simulation.command_body(self._owner, vector_of("velocity", velocity), vector_of("angular_velocity", angular_velocity))


class Joint:
    """A joint of the case. position: rad or m from the start, of a spring its length; velocity; effort: N or N m of its own spring and damper."""

    def __init__(self, simulation, index, name):
        self._simulation, self._index = simulation, index
        self.name = name

    position = property(lambda self: self._simulation.joint_state(self._index)[0])
    velocity = property(lambda self: self._simulation.joint_state(self._index)[1])
    effort = property(lambda self: self._simulation.joint_state(self._index)[2])

    def command(self, value):
        """The effort (N or N m) or velocity (m/s or rad/s), as the case's command/quantity says, of a joint that has a command; held for its timeout.
        Raises Error."""
        self._simulation.command_joint(self._index, number_of("value", value))


class Opening:
    """An opening of the case. discharge: m³/s (2-D: m²/s) into the water in the last step; volume: m³ (2-D: m²) that came in, less what left."""

    def __init__(self, simulation, index, name):
        self._simulation, self._index = simulation, index
        self.name = name

    discharge = property(lambda self: self._simulation.opening_state(self._index)[0])
    volume = property(lambda self: self._simulation.opening_state(self._index)[1])

    def command(self, discharge):
        """The discharge (m³/s, 2-D m²/s, at least 0: into the tank of an inlet, out of it of an outlet) of an opening that has a command; held for its
        timeout. Raises Error."""
        self._simulation.command_discharge(self._index, number_of("discharge", discharge))


class Tank:
    """One simulation of a case, in this process.

    case: the path of its file, or the case itself as nested dictionaries and lists. settings: keys with their values, which replace or add to
    what the case has, as {"fluid/spacing": 0.02}. restore: a snapshot of the same case to go on from, as save() or wavetank_run --save writes it.
    Takes as long as the start of wavetank_run. Raises Error for what that refuses, and Stopped where the watchdog stops the start."""

    def __init__(self, case, settings=None, restore=None):
        file, text = ("", json_of(case)) if isinstance(case, dict) else (path_of("case", case, " or the case itself as a dictionary"), "")
        snapshot = "" if restore is None else path_of("restore", restore)
        self._simulation = _simulation.Simulation(file, text, pairs_of(settings), address_to_path, snapshot)
        self.case = read_yaml(self._simulation.scene())  # every default filled in
        self.dimensions = self.case["dimensions"]
        self.duration = self.case["duration"]  # s, that it can be advanced to
        instruments = self.case.get("instruments") or {}
        self._listed = {kind: instruments.get(kind) or [] for kind in ("pressure_probes", "wave_gauges", "velocity_probes", "sections")}
        bodies = self.case.get("bodies") or []
        self._owners = [(TANK, self.case["tank"].get("motion", "fixed"))] + [(body["name"], body.get("motion", "fixed")) for body in bodies]
        self._imus = [body["name"] for body in bodies if body.get("imu")]
        self._moorings = [
            (name, str(mooring.get("name") or place))
            for name, parts in [(TANK, self.case["tank"])] + [(body["name"], body) for body in bodies]
            for place, mooring in enumerate(parts.get("moorings") or [])
        ]
        self._joints = self.case.get("joints") or []
        self._openings = self.case.get("openings") or []
        self.probes = self._readings("pressure_probes", "pressure probe", "pressures")  # Pa, gauge
        self.gauges = self._readings("wave_gauges", "wave gauge", "levels")  # m
        self.velocities = self._readings("velocity_probes", "velocity probe", "velocities", 3, lambda *xyz: numpy.array(xyz))  # m/s
        self.sections = self._readings("sections", "section", "sections", 2, SectionFlow)
        simulation, owners, imus, joints, openings = self._simulation, self._owners, self._imus, self._joints, self._openings
        self.bodies = ByName("body", [name for name, _ in owners], lambda n: Body(simulation, n, *owners[n], imus))
        self.joints = ByName("joint", [joint["name"] for joint in joints], lambda n: Joint(simulation, n, joints[n]["name"]))
        self.openings = ByName("opening", [each["name"] for each in openings], lambda n: Opening(simulation, n, openings[n]["name"]))

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def close(self):
        """Gives the device's memory back; the tank is of no use any more."""
        self._simulation.close()

    # ------------------------------------------------------------ going on

    def advance(self, seconds):
        """Goes on by a span of simulated time, in whole steps; returns the time at the end of the last one.

        The span counts from the instant that was asked for last, and is over with the first step that ends at or after its end: so spans add up, the time is
        less than a step behind what was asked for, and a run has the same bits whatever its spans. Other threads run meanwhile; Ctrl-C
        ends it after the step in progress. Raises Error for a span that is negative, not a number, or goes beyond the case's duration; Stopped when the
        watchdog stops the simulation, and then until it is reset."""
        self._simulation.advance(number_of("seconds", seconds))
        return self.time

    def advance_to(self, time):
        """The same up to an instant of simulated time; one that is over already is no error. As after restoring, where there is no instant that was asked for."""
        self._simulation.advance_to(number_of("time", time))
        return self.time

    def reset(self):
        """Back to time 0, from where the run repeats itself bit for bit; samples that were not taken and pushes are forgotten."""
        self._simulation.reset()

    def save(self, path):
        """Writes a snapshot, whole or not at all."""
        self._simulation.save(path_of("path", path))

    # ------------------------------------------------------------ how it stands

    time = property(lambda self: self._simulation.state()[0], doc="s of simulated time, at the end of the last step")
    step = property(lambda self: self._simulation.state()[1], doc="how many steps there were since time 0")
    time_step = property(lambda self: self._simulation.state()[2], doc="s, of the next step")
    greatest_speed = property(lambda self: self._simulation.state()[4], doc="m/s, of the particles in the last step")
    summary = property(lambda self: self._simulation.summary(), doc="the lines that wavetank_run begins with")

    @property
    def energies(self):
        """The newest sample, J and kg (docs/topics.md); damper_power in W."""
        time, row = newest(self._simulation, "energies")
        return Energies(time, *row.tolist())

    def particles(self, surface_only=False):
        """All particles, or those on the free surface, at the tank's time, as arrays in no particular order: id (names a particle for good), position (m) and
        velocity (m/s) of three columns, pressure (Pa, gauge), density (kg/m³), shepard (0…1), surface (1 on the free surface),
        eigenvalue (λ: 1 inside the water, less towards its free surface)."""
        return Particles(time=self.time, **self._simulation.particles(surface_only))

    def take_samples(self):
        """Every sample of the instruments since it was last called, or since the start or a reset: a dictionary of wavetank.recording.Table by name, with the
        names, columns and bits that wavetank.read_tables finds in the bag of the same run; "energies" in the place of "status". Until it is called samples are kept.
        """
        kinds = self._simulation.take_samples()
        tables = {}
        for name, kind, columns, positions, frame in self._columns():
            if kind not in kinds or not columns:
                continue
            times, values = kinds[kind]
            arrays = {column: values[:, place].copy() for column, _, place in columns}
            tables[name] = Table(name, stamps_of(times), arrays, {column: unit for column, unit, _ in columns}, frame, positions)
        return tables

    def _readings(self, group, what, kind, width=1, shape=float):
        return Readings(self._simulation, what, [each["name"] for each in self._listed[group]], kind, width, shape)

    def _columns(self):
        """Of every table: name, kind of sample, columns (name, unit, place in the kind's row), positions, frame."""
        world = self.case.get("world_frame", "tank")
        owners = [name for name, _ in self._owners]

        def frame_of(owner):
            return world if owner == 0 else "%s/bodies/%s" % (world, level_of(owners[owner]))

        for name, kind, group, unit in (("probes", "pressures", "pressure_probes", "Pa"), ("gauges", "levels", "wave_gauges", "m")):
            listed = self._listed[group]
            columns = [(each["name"], unit, place) for place, each in enumerate(listed)]
            yield name, kind, columns, {each["name"]: place_of(each["position"]) for each in listed}, world
        for n, each in enumerate(self._listed["velocity_probes"]):
            yield "velocities/" + level_of(each["name"]), "velocities", placed(vector_columns("velocity", "m/s"), 3 * n), {}, world
        for n, each in enumerate(self._listed["sections"]):
            yield "sections/" + level_of(each["name"]), "sections", placed(SECTION, 2 * n), {}, world
        for owner, (name, motion) in enumerate(self._owners):
            topic = "bodies/" + level_of(name)
            if motion != "fixed":
                parent = world if owner else ("inertial" if world == "world" else "world")
                yield topic + "/odom", "poses", placed(POSE, 13 * owner), {}, parent
            for part, place in (("", 0), ("/pressure", 6), ("/viscous", 12)):
                yield topic + "/wrench" + part, "wrenches", placed(WRENCH, 18 * owner + place), {}, frame_of(owner)
        for n, name in enumerate(self._imus):
            yield "bodies/%s/imu" % level_of(name), "imus", placed(IMU, 10 * n), {}, "%s/bodies/%s/imu" % (world, level_of(name))
        for n, (body, mooring) in enumerate(self._moorings):
            topic = "bodies/%s/moorings/%s/tension" % (level_of(body), level_of(mooring))
            yield topic, "moorings", placed(MOORING, 3 * n), {}, frame_of(owners.index(body))
        for n, each in enumerate(self._openings):
            yield "openings/%s/flow" % level_of(each["name"]), "flows", placed(FLOW, 2 * n), {}, world
        joints = [(n, joint["name"]) for n, joint in enumerate(self._joints) if joint["type"] in POSED_JOINTS]
        columns = [("%s %s" % (name, field), unit, 3 * n + place) for n, name in joints for place, (field, unit) in enumerate(JOINT)]
        yield "joint_states", "joints", columns, {}, ""
        yield "energies", "energies", placed(ENERGIES), {}, world


def placed(columns, first=0):
    """With the places of numbers that stand side by side."""
    return [(name, unit, first + place) for place, (name, unit) in enumerate(columns)]


def vector_columns(what, unit, axes=AXES):
    return [("%s_%s" % (what, axis), unit) for axis in axes]


WRENCH = vector_columns("force", "N") + vector_columns("torque", "N m")
POSE = (
    vector_columns("position", "m")
    + vector_columns("orientation", "", QUATERNION)
    + vector_columns("velocity", "m/s")
    + vector_columns("angular_velocity", "rad/s")
)
IMU = vector_columns("orientation", "", QUATERNION) + vector_columns("angular_velocity", "rad/s") + vector_columns("specific_force", "m/s^2")
SECTION = [("discharge", "m^3/s"), ("area", "m^2")]
FLOW = [("discharge", "m^3/s"), ("volume", "m^3")]
MOORING = [("tension", "N"), ("anchor_tension", "N"), ("lying", "m")]
JOINT = [("position", "rad or m"), ("velocity", "rad/s or m/s"), ("effort", "N m or N")]
ENERGIES = [("kinetic", "J"), ("potential", "J"), ("compression", "J"), ("mass", "kg"), ("damper_power", "W")]


def place_of(position):
    values = [float(value) for value in position]
    return tuple(values + [0.0] * (3 - len(values)))


def stamps_of(times):
    """ns of simulated time, as ROS stamps have them."""
    whole = numpy.floor(times)
    return whole.astype(numpy.int64) * 1000000000 + numpy.floor((times - whole) * 1e9 + 0.5).astype(numpy.int64)


def vector_of(what, value):
    try:
        vector = numpy.asarray(value, dtype=float)
    except (TypeError, ValueError):
        vector = numpy.empty(0)
    if vector.shape != (3,):
        raise Error("%s must be three numbers, along x, y and z, not %r" % (what, value))
    return vector


def number_of(what, value):
    try:
        if isinstance(value, (str, bytes)):
            raise TypeError
        return float(value)
    except (TypeError, ValueError, OverflowError):
        raise Error("%s must be a number, not %r" % (what, value)) from None


def path_of(what, value, otherwise=""):
    try:
        return os.fspath(value)
    except TypeError:
        raise Error("%s must be the path of a file%s, not %r" % (what, otherwise, value)) from None


def pairs_of(settings):
    """Keys with their values as the library reads them."""
    if settings is None:
        return []
    if not isinstance(settings, collections.abc.Mapping):
        raise Error("settings must be a dictionary of keys and values, as {'fluid/spacing': 0.02}, not %r" % (settings,))
    for key in settings:
        if not isinstance(key, str):
            raise Error("settings: a key must be text, as 'fluid/spacing', not %r" % (key,))
    return [(key, json_of(value)) for key, value in settings.items()]


def json_of(value):
    """As YAML, which takes JSON; arrays and numbers of numpy too."""
    try:
        text = json.dumps(value, default=lambda other: other.tolist(), ensure_ascii=False)  # YAML knows no pairs of surrogates
        text.encode()  # nor halves of them
        return text
    except (TypeError, ValueError, AttributeError):
        raise Error("%r cannot be a value of a case: give numbers, text, True or False, lists and dictionaries of these" % (value,)) from None


def address_to_path(address):
    """Of package://PACKAGE/FILE: of this package without ROS, of others as rospack finds them."""
    found = re.match(r"package://([^/]+)/(.*)", address)
    if not found:
        raise Error("'%s': of such addresses only package://PACKAGE/FILE and file:///FILE can be read" % address)
    package, file = found.groups()
    own = own_folder()
    if package == "wavetank" and own:
        return os.path.join(own, file)
    try:
        import rospkg

        return os.path.join(rospkg.RosPack().get_path(package), file)
    except ImportError:
        raise Error("'%s': packages other than wavetank are found with python3-rospkg, which is not installed: give the file's path" % address) from None
    except rospkg.ResourceNotFound:
        raise Error("'%s': no ROS package '%s' is known here; source the setup.bash of the workspace that has it" % (address, package)) from None


def own_folder():
    """Where this package's config and meshes are: beside the source, or in the share folder of an install space; None if they are not."""
    here = os.path.dirname(os.path.realpath(__file__))
    source = os.path.join(here, "..", "..", "..")  # of src/python/wavetank
    installed = os.path.join(here, "..", "..", "..", "..", "share", "wavetank")  # of lib/python3/dist-packages/wavetank
    return next((os.path.normpath(folder) for folder in (source, installed) if os.path.isdir(os.path.join(folder, "meshes"))), None)
