"""A body's hydrodynamic coefficients from runs of wavetank_run: forced oscillation, free decay, and towing at constant speeds."""

import argparse
import math
import os

import numpy
import yaml

from wavetank import Failure, fits
from wavetank.body_cases import DIRECTIONS, SHIFTS, TURNS, BodyCase
from wavetank.recording import Recording
from wavetank.rotations import angles_of
from wavetank.runs import Run, Runner, numbers_of
from wavetank.snippets import WRITERS
from wavetank.sweep import read_setting
from wavetank.tank_facts import TankFacts

RESULTS = "hydrodynamics.yaml"
CONVERGED = 0.10  # largest difference of two spacings
AXES = ("x", "y", "z")


def force_name(direction):
    return ("force_" if direction in SHIFTS else "torque_") + AXES[DIRECTIONS.index(direction) % 3]


def force_on(recording, body, direction):
    """(times, values) of the water's force along, or torque about, the direction's axis. Of a body that turns about this axis alone, its own axis is this one."""
    table = recording.table("bodies/%s/wrench" % body)
    return table.times, table.columns[force_name(direction)]


def motion_of(recording, body, direction):
    """(times, values) in m or rad."""
    table = recording.table("bodies/%s/odom" % body)
    if direction in SHIFTS:
        return table.times, table.columns["position_" + AXES[SHIFTS.index(direction)]]
    turned = table.array(*("orientation_" + axis for axis in AXES + ("w",)))
    return table.times, angles_of(turned)[:, TURNS.index(direction)]


class Study:
    """What the three kinds of study share: the case, the folder, the runs and what is told. A kind has its name `section`, and says what it is about by
    check(), before anything is run, prepare(), with the sizes of tank and body at hand, run() and coefficients()."""

    def __init__(self, options, direction):
        self.options, self.direction = options, direction
        self.axis, self.turns = DIRECTIONS.index(direction) % 3, direction in TURNS
        self.case = BodyCase(options.case, options.body, [read_setting(text) for text in options.set])
        self.case.check_direction(direction)
        self.spacings = sorted(numbers_of(options.spacings, "the spacings"), reverse=True) if options.spacings else [None]
        if any(spacing is not None and not spacing > 0 for spacing in self.spacings):
            raise Failure("the spacings '%s' are not all greater than 0" % options.spacings)
        self.check(options)
        self.runner = Runner(options.out, options.again)
        self.folder = os.path.join(options.out, "cases")
        os.makedirs(self.folder, exist_ok=True)
        self.failed = False
        self.facts = TankFacts(self.case, self.write(self.case.changed("fixed", 1.0, self.spacings[0]), "as_given"))
        self.prepare(options)

    def write(self, tree, name):
        path = os.path.join(self.folder, name + ".yaml")
        with open(path + ".part", "w", encoding="utf-8") as file:
            yaml.safe_dump(tree, file, sort_keys=False)
        os.replace(path + ".part", path)
        return path

    def do(self, cases):
        """Recordings of the runs of cases, a dictionary of trees by name; those that failed are left out and told by the runner."""
        device = ["--device", self.options.device] if self.options.device else []
        results = self.runner.do([Run(name, self.write(tree, name), options=device) for name, tree in cases.items()])
        self.failed |= any(result.exit_code != 0 for result in results)
        return {result.run.name: Recording(result.bag) for result in results if result.exit_code == 0}

    def name(self, *words, spacing=None):
        return "_".join(words) + ("_spacing=%.9g" % spacing if spacing is not None else "")

    def tell_blockage(self):
        axis = 2 if self.turns else self.axis
        body, water = self.facts.across(axis)
        section = ("section across x", "section across y", "horizontal section")[axis]
        print("blockage: the body takes %.3g %% of the water's %s" % (100 * body / water, section))
        return float(body / water)

    def tell_waves(self, period, end):
        """When waves are back, s, None where none are."""
        back = self.facts.waves_return(period)
        if not math.isfinite(back):
            return None
        known = "" if self.facts.to_the_ends()[1] else ", were it in the tank's middle"
        damped = ", but for the damping zones" if (self.case.tree.get("fluid") or {}).get("damping") else ""
        word = "what they bring is in the fit" if end > back else "so the fit is free of them"
        print("period %g s: waves are back at the body after %.3g s%s%s; the fit ends at %.3g s, %s" % (period, back, known, damped, end, word))
        return float(back)

    def stiffness(self):
        """By spacing: the hydrostatic stiffness, from two runs with the body held to either side; 0 where there is none, or as it is given."""
        if self.options.stiffness is not None:
            return {spacing: self.options.stiffness for spacing in self.spacings}
        if self.direction in ("surge", "sway", "yaw") or self.facts.gravity == 0:
            return {spacing: 0.0 for spacing in self.spacings}
        amount, duration = self.held_apart(), self.options.hold
        names = {
            (spacing, sign): self.name("held", self.direction, word, spacing=spacing) for spacing in self.spacings for sign, word in ((1, "up"), (-1, "down"))
        }
        cases = {name: self.case.held(self.direction, sign * amount, duration, spacing) for (spacing, sign), name in names.items()}
        recordings = self.do(cases)
        found = {}
        for spacing in self.spacings:
            means = []
            for sign in (1, -1):
                if names[spacing, sign] not in recordings:
                    raise Failure("the hydrostatic stiffness is not known without the run '%s': give it by --stiffness" % names[spacing, sign])
                times, forces = force_on(recordings[names[spacing, sign]], self.case.name, self.direction)
                means.append(forces[times > 0.5 * times[-1]].mean())
            found[spacing] = float((means[1] - means[0]) / (2 * amount))
            print("hydrostatic stiffness%s: %.5g" % ("" if spacing is None else " at spacing %g m" % spacing, found[spacing]))
        return found


class Oscillation(Study):
    section = "oscillate"

    def check(self, options):
        if not options.periods:
            raise Failure("--oscillate needs --periods, as in --periods 0.8:1.6:5")
        self.periods = numbers_of(options.periods, "the periods")
        if not all(period > 0 for period in self.periods):
            raise Failure("the periods '%s' are not all greater than 0" % options.periods)
        if options.amplitude is not None and not options.amplitude > 0:
            raise Failure("the amplitude is %g; it must be greater than 0" % options.amplitude)

    def prepare(self, options):
        given = math.radians(options.amplitude) if options.amplitude and self.turns else options.amplitude
        self.amplitude = given or (math.radians(3.0) if self.turns else 0.05 * float(self.facts.body[[0, 2] if self.case.dimensions == 2 else [0, 1, 2]].min()))

    def held_apart(self):
        return self.amplitude

    def run(self):
        reach = self.amplitude * (0.5 * float(self.facts.body.max()) if self.turns else 1.0)
        if reach < self.facts.spacing:
            print("the body moves by %.3g spacings to either side; forces are coarse below one" % (reach / self.facts.spacing))
        blockage = self.tell_blockage()
        stiffness = self.stiffness()
        back = {period: self.tell_waves(period, self.end(period)) for period in self.periods}
        each = [(period, spacing) for spacing in self.spacings for period in self.periods]
        names = [self.name("oscillate", self.direction, "T=%.9g" % period, spacing=spacing) for period, spacing in each]
        recordings = self.do({name: self.swinging(*which) for name, which in zip(names, each)})
        rows = [
            dict(self.row_of(recordings[name], period, spacing, stiffness[spacing]), waves_return_after=back[period])
            for name, (period, spacing) in zip(names, each)
            if name in recordings
        ]
        print_rows(rows, ("period", "spacing", "added_mass", "damping", "residual", "second_harmonic"))
        found = {"amplitude": self.amplitude, "blockage": blockage, "results": rows}
        found["hydrostatic_stiffness"] = {("as given" if spacing is None else "%g" % spacing): value for spacing, value in stiffness.items()}
        found["convergence"] = self.convergence(rows)
        return found

    def end(self, period):
        """Of what is fitted, s."""
        return (self.options.rise + self.options.wait + self.options.cycles) * period

    def swinging(self, period, spacing):
        # a little longer, so that the last sample is there
        return self.case.oscillating(self.direction, self.amplitude, period, self.options.rise * period, self.end(period) + 0.03 * period, spacing)

    def row_of(self, recording, period, spacing, stiffness):
        motion, force = (of(recording, self.case.name, self.direction) for of in (motion_of, force_on))
        first = (self.options.rise + self.options.wait) * period
        return dict(noted(period=period, spacing=spacing), **fits.fit_oscillation(motion, force, period, first, self.end(period), stiffness))

    def convergence(self, rows):
        if len(self.spacings) < 2:
            return "not looked at: give two --spacings"
        changes = []
        for period in self.periods:
            fine = {row["spacing"]: row for row in rows if row["period"] == period}
            if not {self.spacings[-2], self.spacings[-1]} <= set(fine):
                continue
            coarser, finer = fine[self.spacings[-2]], fine[self.spacings[-1]]
            omega = 2 * math.pi / period
            change = {"period": period}
            for what, least in (("added_mass", 0.02 * abs(finer["damping"]) / omega), ("damping", 0.02 * abs(finer["added_mass"]) * omega)):
                # a value that hardly acts beside the other may differ by as much of itself as it likes
                change[what + "_change"] = abs(coarser[what] - finer[what]) / max(abs(finer[what]), least, 1e-300)
            changes.append(judged(change))
        return changes

    def coefficients(self, found):
        """Of the finest spacing and the middle one of the periods."""
        rows = [row for row in found["results"] if row.get("spacing") == self.spacings[-1] or self.spacings == [None]]
        if not rows:
            return {}
        row = sorted(rows, key=lambda each: each["period"])[len(rows) // 2]
        return {"added_mass": row["added_mass"], "linear": row["damping"], "from": "%s: oscillation of %g s" % (self.direction, row["period"])}


class Decay(Study):
    section = "decay"

    def check(self, options):
        if self.direction in ("surge", "sway", "yaw"):
            raise Failure("nothing brings a body back in %s: --decay is of heave, roll or pitch" % self.direction)
        if not options.displacement:
            raise Failure("--decay needs --displacement, in m or, of roll and pitch, in degrees")
        if not options.duration:
            raise Failure("--decay needs --duration, s, of several swings")
        self.displacement = math.radians(options.displacement) if self.turns else options.displacement
        self.case.check_released()

    def prepare(self, options):
        pass

    def held_apart(self):
        return abs(self.displacement)

    def run(self):
        blockage = self.tell_blockage()
        stiffness = self.stiffness()
        names = {spacing: self.name("decay", self.direction, spacing=spacing) for spacing in self.spacings}
        recordings = self.do({name: self.case.released(self.direction, self.displacement, self.options.duration, spacing) for spacing, name in names.items()})
        rows = [self.row_of(recordings[name], spacing, stiffness[spacing]) for spacing, name in names.items() if name in recordings]
        print_rows(rows, ("spacing", "period", "linear", "quadratic", "inertia_with_water", "added_mass", "swings", "residual"))
        found = {"displacement": self.displacement, "blockage": blockage, "results": rows, "convergence": "not looked at: give two --spacings"}
        if len(rows) > 1:
            coarser, finer = rows[-2:]
            found["convergence"] = [judged({"period_change": abs(coarser["period"] / finer["period"] - 1)})]
        return found

    def row_of(self, recording, spacing, stiffness):
        row = dict(noted(spacing=spacing), **fits.fit_decay(*motion_of(recording, self.case.name, self.direction)))
        inertia = stiffness / row["stiffness_over_mass"]  # with that of the water
        row.update(inertia_with_water=inertia, linear_damping=row["linear"] * inertia, quadratic_damping=row["quadratic"] * inertia)
        if self.facts.mass and not self.turns:
            row["added_mass"] = inertia - self.facts.mass
        row["waves_return_after"] = self.tell_waves(row["period"], self.options.duration)
        if row["swings"] < 4:
            print("in %d half swings linear and quadratic damping are hardly told apart" % row["swings"])
        return row

    def coefficients(self, found):
        if not found["results"]:
            return {}
        row = found["results"][-1]
        result = {"linear": row["linear_damping"], "quadratic": row["quadratic_damping"], "from": "%s: decay of %.3g s" % (self.direction, row["period"])}
        if "added_mass" in row:
            result["added_mass"] = row["added_mass"]
        return result


class Tow(Study):
    section = "tow"

    def check(self, options):
        if self.turns:
            raise Failure("a body is towed in surge, sway or heave, not in %s" % self.direction)
        if not options.speeds:
            raise Failure("--tow needs --speeds, as in --speeds 0.5,1.0")
        self.speeds = numbers_of(options.speeds, "the speeds")
        if 0 in self.speeds:
            raise Failure("a speed of 0 tells no drag")

    def prepare(self, options):
        self.distance = self._distance(options.distance)

    def _distance(self, wanted):
        """m, that the body goes; half of its length stays between it and the tank's end unless more is asked for."""
        ways = [self.facts.free_way(self.axis, speed) for speed in self.speeds]
        if None in ways:
            if wanted is None:
                raise Failure("how far the body '%s' can go, the case does not tell: give --distance" % self.case.name)
            return wanted
        free = min(ways)
        if wanted is None:
            wanted = free - 0.5 * float(self.facts.body[self.axis])
        if not 0 < wanted < free:
            raise Failure("the body can go %.4g m before it meets the tank's end; a tow of %.4g m is not possible" % (free, wanted))
        return wanted

    def _record(self, speed, name):
        """Writes the way over time: a smooth start over a fifth of the distance, then constant speed. Returns path, end (s) and begin of constant speed (s)."""
        start = 0.4 * self.distance / abs(speed)
        end = start + 0.8 * self.distance / abs(speed)
        times = numpy.linspace(0, end, 601)
        rising = numpy.minimum(times, start)
        way = speed * (0.5 * (rising - start / math.pi * numpy.sin(math.pi * rising / start)) + numpy.maximum(times - start, 0))
        path = os.path.abspath(os.path.join(self.folder, name + ".csv"))
        with open(path + ".part", "w", encoding="utf-8") as file:
            file.write("time,%s\n" % self.direction)
            file.writelines("%.12g,%.12g\n" % row for row in zip(times, way))
        os.replace(path + ".part", path)
        return path, float(end), float(start)

    def run(self):
        blockage = self.tell_blockage()
        print("tow over %.4g m, forces from the last half of constant speed" % self.distance)
        names = {(speed, spacing): self.name("tow", self.direction, "U=%.9g" % speed, spacing=spacing) for spacing in self.spacings for speed in self.speeds}
        cases, begins = {}, {}
        for (speed, spacing), name in names.items():
            record, end, start = self._record(speed, name)
            cases[name] = self.case.towed(self.direction, record, end, spacing)
            begins[name] = 0.5 * (start + end)
        recordings = self.do(cases)
        area = self.facts.across(self.axis)[0]
        rows = [self.row_of(recordings[name], speed, spacing, begins[name], area) for (speed, spacing), name in names.items() if name in recordings]
        print_rows(rows, ("speed", "spacing", "drag", "standard_deviation", "drag_coefficient"))
        found = {"distance": self.distance, "blockage": blockage, "area_across": area, "results": rows, "fits": self.fitted(rows)}
        found["convergence"] = self.convergence(rows)
        return found

    def row_of(self, recording, speed, spacing, begin, area):
        times, forces = force_on(recording, self.case.name, self.direction)
        forces = forces[times >= begin]
        drag = float(-forces.mean())
        row = noted(speed=speed, spacing=spacing, drag=drag, standard_deviation=float(forces.std()))
        row["drag_coefficient"] = drag / (0.5 * self.case.density() * speed * abs(speed) * area)
        return row

    def fitted(self, rows):
        result = []
        for spacing in self.spacings:
            ours = [row for row in rows if row.get("spacing") == spacing]
            if ours:
                fit = fits.fit_drag([row["speed"] for row in ours], [row["drag"] for row in ours])
                result.append(dict(noted(spacing=spacing), **fit))
        print_rows(result, ("spacing", "linear", "quadratic", "residual"))
        return result

    def convergence(self, rows):
        if len(self.spacings) < 2:
            return "not looked at: give two --spacings"
        changes = []
        for speed in self.speeds:
            drags = {row["spacing"]: row["drag"] for row in rows if row["speed"] == speed}
            if {self.spacings[-2], self.spacings[-1]} <= set(drags):
                changes.append(judged({"speed": speed, "drag_change": abs(drags[self.spacings[-2]] / drags[self.spacings[-1]] - 1)}))
        return changes

    def coefficients(self, found):
        if not found["fits"]:
            return {}
        fit = found["fits"][-1]
        row = found["results"][-1]
        return {
            "linear": fit["linear"], "quadratic": fit["quadratic"], "drag_coefficient": row["drag_coefficient"],
            "from": "%s: tow up to %g m/s" % (self.direction, max(self.speeds, key=abs)),
        }  # fmt: skip


def noted(**values):
    """What there is of them."""
    return {name: value for name, value in values.items() if value is not None}


def judged(change):
    """Tells and notes whether two spacings agree."""
    name, greatest = max(((key, value) for key, value in change.items() if key.endswith("_change")), key=lambda item: item[1])
    change["converged"] = bool(greatest <= CONVERGED)
    where = ", ".join("%s %g" % (key, value) for key, value in change.items() if key in ("period", "speed"))
    if not change["converged"]:
        print(
            "not converged%s: %s differs by %.0f %% between the two finest spacings"
            % (" at " + where if where else "", name[: -len("_change")], 100 * greatest)
        )
    return change


def print_rows(rows, columns):
    columns = [column for column in columns if any(column in row for row in rows)]
    if not rows:
        return
    print("  ".join("%14s" % column[:18] for column in columns))
    for row in rows:
        print("  ".join("%14.5g" % row[column] if column in row else "%14s" % "-" for column in columns))


def read_results(path, options):
    """What is there already of the same body, for other directions and kinds to be added to."""
    try:
        with open(path, encoding="utf-8") as file:
            there = yaml.safe_load(file)
    except OSError:
        return {}
    except yaml.YAMLError:
        raise Failure("'%s' is not YAML, and is not replaced: give another --out" % path)
    if not isinstance(there, dict) or there.get("body") != options.body or there.get("case") != os.path.abspath(options.case):
        raise Failure("'%s' is of another body or case: give another --out" % path)
    return there


def write_results(study, found):
    options = study.options
    path = os.path.join(options.out, RESULTS)
    whole = read_results(path, options)
    density = study.case.density()
    whole.update(body=options.body, case=os.path.abspath(options.case), dimensions=study.case.dimensions, density=density)
    whole["units"] = "SI, angles in rad" + ("; of one metre of width" if study.case.dimensions == 2 else "")
    whole.setdefault(study.section, {})[study.direction] = found
    own = whole.setdefault("coefficients", {}).setdefault(study.direction, {})
    added = study.coefficients(found)
    if "from" in own and "from" in added and own["from"] != added["from"]:
        added["from"] = "; ".join(dict.fromkeys(own["from"].split("; ") + [added["from"]]))
    own.update(added)
    files = {path: yaml.safe_dump(whole, sort_keys=False)}
    coefficients = {direction: value for direction, value in whole["coefficients"].items() if value}
    for name, writer in WRITERS.items():
        files[os.path.join(options.out, name)] = writer(options.body, coefficients, density, study.case.dimensions)
    for name, text in files.items():
        with open(name + ".part", "w", encoding="utf-8") as file:
            file.write(text)
        os.replace(name + ".part", name)
        print("wrote '%s'" % name)


def read_arguments(arguments):
    parser = argparse.ArgumentParser(
        prog="hydrodynamics",
        description="Finds a body's added mass, damping, decay or drag by moving it in the tank, and writes them to DIR/%s and for other simulators." % RESULTS,
        epilog="Runs that are in DIR already are not repeated; other directions are added to what DIR has. Exit code: 0 done, 1 a run failed, 2 an error.",
    )
    parser.add_argument("case", help="the case, a YAML file; in it the body is at rest where it belongs")
    parser.add_argument("-b", "--body", required=True, help="name of the body")
    parser.add_argument("-o", "--out", metavar="DIR", required=True, help="folder for cases, runs and results")
    kind = parser.add_mutually_exclusive_group(required=True)
    kind.add_argument("--oscillate", choices=DIRECTIONS, help="force it to swing: added mass and damping")
    kind.add_argument("--decay", choices=DIRECTIONS, help="let it go off its rest: period and damping")
    kind.add_argument("--tow", choices=DIRECTIONS, help="draw it at constant speeds: drag")
    parser.add_argument("--periods", metavar="LIST", help="of --oscillate, s: a,b,c or FIRST:LAST:COUNT")
    parser.add_argument("--amplitude", type=float, help="of --oscillate, m or degrees; default a twentieth of the body's least extent, or 3 degrees")
    parser.add_argument("--rise", type=float, default=2.0, help="periods in which the oscillation rises; default 2")
    parser.add_argument("--wait", type=float, default=1.0, help="periods after it that are not fitted; default 1")
    parser.add_argument("--cycles", type=int, default=4, help="periods that are fitted; default 4")
    parser.add_argument("--displacement", type=float, help="of --decay, m or degrees")
    parser.add_argument("--duration", type=float, help="of --decay, s")
    parser.add_argument("--speeds", metavar="LIST", help="of --tow, m/s: a,b,c or FIRST:LAST:COUNT; negative: backwards")
    parser.add_argument("--distance", type=float, help="of --tow, m; default: as far as the tank allows")
    parser.add_argument("--stiffness", type=float, help="hydrostatic, N/m or N m/rad; default: from two runs with the body held off its rest")
    parser.add_argument("--hold", type=float, default=0.6, help="s, of those two runs; default 0.6")
    parser.add_argument("--spacings", metavar="LIST", help="of the particles, m: all is done with each, and the two finest are compared")
    parser.add_argument("--set", metavar="KEY=VALUE", action="append", default=[], help="a key of the case; may be repeated")
    parser.add_argument("--device", help="OpenCL device, as wavetank_run takes it")
    parser.add_argument("--again", action="store_true", help="run anew what was run before with another case")
    options = parser.parse_args(arguments)
    if not (options.rise > 0 and options.wait >= 0 and options.cycles >= 1 and options.hold > 0):
        raise Failure("--rise and --hold must be greater than 0, --wait at least 0 and --cycles at least 1")
    return options


def main(arguments):
    options = read_arguments(arguments)
    kind, direction = next((each, getattr(options, each.section)) for each in (Oscillation, Decay, Tow) if getattr(options, each.section))
    read_results(os.path.join(options.out, RESULTS), options)
    study = kind(options, direction)
    found = study.run()
    write_results(study, found)
    return 1 if study.failed else 0
