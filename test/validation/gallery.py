#!/usr/bin/env python3
"""A picture of every demo, with its command and what it takes:

gallery.py WAVETANK_RUN RENDER DIRECTORY DOCS [DEMO]...

Runs each demo, or those that are named, at a coarse setting and for as long as its picture needs, in a folder of its own in DIRECTORY; draws the picture into DOCS/images/gallery
and writes DOCS/gallery.md. Runs that are in DIRECTORY already, of the same command, are not run again; the page tells of all that are there."""

import json
import os
import resource
import shutil
import subprocess
import sys

SIZE = "600x340"
COLUMNS = 160  # of a page
RATE = 10  # Hz of simulated time, of what is recorded


class Demo:
    """settings: of wavetank_run, by key; at: the time of the picture, s, at which the run ends; render: options of render."""

    def __init__(self, name, what, at, settings=(), render=(), live=None):
        self.name, self.what, self.at, self.settings, self.render = name, what, at, dict(settings), list(render)
        self.is_flat = self.name in FLAT
        self.live = live or ("roslaunch wavetank %s.launch rviz:=true" % name if name not in WITHOUT_LAUNCH else None)

    def options(self):
        return ["--duration", "%g" % self.at] + [word for key, value in self.settings.items() for word in ("--set", "%s=%s" % (key, value))]


FLAT = (
    "dam_break_2d",
    "dam_break_mls",
    "jet_on_plate",
    "weir",
    "wave_flume",
    "piston_flume",
    "regular_waves",
    "sloshing_tank",
    "paddle_wheel",
    "hydrostatic_2d",
)
WITHOUT_LAUNCH = ("robot_paddle", "still_tank_3d", "hydrostatic_2d")

DEMOS = [
    Demo("dam_break_3d", "SPHERIC benchmark 2: water falls onto a box", 0.6, {"fluid/spacing": 0.03}),
    Demo("dam_break_2d", "A column of water collapses in a box", 1.3, {"fluid/spacing": 0.03}),
    Demo("dam_break_mls", "The same by second-order moving least squares", 1.3),
    Demo("dam_break_cube", "A cube that a dam break carries off", 1.0),
    Demo("ten_bodies", "Ten bodies in the way of a dam break", 0.8),
    Demo("water_entry", "A ball falls into water", 0.4, {"fluid/spacing": 0.03}),
    Demo("floating_box", "A box that bobs", 0.7, {"fluid/spacing": 0.03}),
    Demo(
        "pushed_boat",
        "A boat that is pushed by messages; here it is set going at 0.8 m/s instead",
        0.6,
        {"fluid/spacing": 0.04, "bodies/0/velocity": "[0.8, 0, 0]"},
    ),
    Demo("boat_in_a_sea", "A boat in an irregular sea", 2.2, {"fluid/spacing": 0.05}),
    Demo("wave_basin_robot", "A robot from a URDF file in regular waves", 1.8, {"fluid/spacing": 0.04}),
    Demo("robot_paddle", "An arm from a URDF file swings into the water, and a buoy rides the waves", 0.6, {"fluid/spacing": 0.03}),
    Demo("current_past_pier", "A pier in a current", 0.8, {"fluid/spacing": 0.035}),
    Demo("filling_tank", "A hose fills a tank", 3.0),
    Demo("still_tank_3d", "Archimedes' force on a box in still water", 0.1, {"fluid/spacing": 0.03}),
    Demo("wave_flume", "Waves of a flap and a floating box", 4.0, {"fluid/spacing": 0.025}),
    Demo("piston_flume", "Waves of a piston that moves as the record of an experiment says", 4.0, {"fluid/spacing": 0.02}),
    Demo("regular_waves", "Waves of a given height and period, and a zone that takes them away", 5.0, {"fluid/spacing": 0.025}),
    Demo("sloshing_tank", "SPHERIC benchmark 10: a tank that rolls", 2.4),
    Demo(
        "paddle_wheel",
        "A paddle wheel that messages drive; here it turns by half in 1.5 s, as its case is told to",
        1.0,
        {
            "bodies/0": "{name: wheel, box: {min: [.795,.14], max: [.855,.54]}, motion: prescribed, "
            "prescribed: {ramps: [{direction: pitch, change: -180, to: 1.5}]}}"
        },
    ),
    Demo("jet_on_plate", "A plane jet on a plate", 1.0),
    Demo("weir", "Flow over a sharp-crested weir", 3.0, {"fluid/spacing": 0.015}),
    Demo("hydrostatic_2d", "A tank at rest, coloured by its pressure", 0.5, render=["--colour", "pressure"]),
]

HEAD = """# Gallery

Every demo: `roslaunch` shows it live, and its picture was drawn by [`render`](pictures.md) from the bag of the second command, which takes the demo coarsely and
until that instant. All pictures and this page are made by `scripts/validate gallery`, those of some demos by `scripts/validate gallery weir dam_break_2d`.

*Took* is the processor time of that second command, on a machine of two cores that had much other work. On two idle ones a run takes some 0.55 of it, since both
work, or less.
"""


def command_of(demo, program, root):
    rates = ["--set", "rates/%s_bag=%d" % ("cloud" if demo.is_flat else "surface", RATE)]
    return [program, os.path.join(root, "config", demo.name + ".yaml"), "--particles" if demo.is_flat else "--surface"] + rates + demo.options()


def told(demo):
    """What a user types, without rates; on lines that are not too long."""
    words = [word if not set(word) & set(" {}[]") else "'%s'" % word for word in demo.options()]
    command = "rosrun wavetank wavetank_run config/%s.yaml --bag out.bag %s %s" % (demo.name, "--particles" if demo.is_flat else "--surface", " ".join(words))
    return command if len(command) <= COLUMNS else command.replace(" --set", " \\\n  --set")


def run(demo, program, root, folder):
    """What it took: kept beside the bag, so that it need not run again."""
    record, command = os.path.join(folder, "took.json"), command_of(demo, program, root)
    if os.path.exists(record):
        with open(record) as file:
            took = json.load(file)
        if took["options"] == command[2:]:
            return took
    shutil.rmtree(folder, ignore_errors=True)
    os.makedirs(folder)
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    with open(os.path.join(folder, "log.txt"), "w") as log:
        code = subprocess.call(command + ["--bag", os.path.join(folder, "out.bag")], stdout=log, stderr=subprocess.STDOUT)
    if code != 0:
        with open(os.path.join(folder, "log.txt")) as log:
            raise SystemExit("gallery: %s ends with exit code %d: %s" % (demo.name, code, log.read().strip().splitlines()[-1]))
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    took = {"options": command[2:], "processor_seconds": after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime}
    with open(record, "w") as file:
        json.dump(took, file)
    return took


def draw(demo, render, folder, picture):
    command = [render, os.path.join(folder, "out.bag"), "-o", picture, "--size", SIZE, "--at", "%g" % demo.at] + demo.render
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, encoding="utf-8")
    if done.returncode != 0:
        raise SystemExit("gallery: %s: %s" % (demo.name, done.stdout.strip()))


def seconds_text(seconds):
    return "%.0f s" % seconds if seconds < 100 else "%.1f min" % (seconds / 60)


def page(demos, took):
    lines = [HEAD]
    for demo in demos:
        lines += ["## %s" % demo.name, "", "%s, at %g s." % (demo.what, demo.at), "", "![%s](images/gallery/%s.jpg)" % (demo.what, demo.name), "", "```sh"]
        lines += [demo.live] if demo.live else []
        lines += [told(demo), "```", "", "Took %s." % seconds_text(took[demo.name]), ""]
    return "\n".join(lines)


def main(program, render, output, docs, *names):
    root = os.path.dirname(os.path.abspath(docs))
    known = [demo.name for demo in DEMOS]
    for name in names:
        if name not in known:
            raise SystemExit("gallery: there is no demo '%s': %s" % (name, ", ".join(known)))
    pictures = os.path.join(docs, "images", "gallery")
    os.makedirs(pictures, exist_ok=True)
    for demo in DEMOS:
        if names and demo.name not in names:
            continue
        folder = os.path.join(output, demo.name)
        seconds = run(demo, program, root, folder)["processor_seconds"]
        draw(demo, render, folder, os.path.join(pictures, demo.name + ".jpg"))
        print("%-20s %s" % (demo.name, seconds_text(seconds)), flush=True)
    took = {}
    for demo in DEMOS:
        record = os.path.join(output, demo.name, "took.json")
        if os.path.exists(record):
            with open(record) as file:
                took[demo.name] = json.load(file)["processor_seconds"]
    with open(os.path.join(docs, "gallery.md"), "w", encoding="utf-8") as file:
        file.write(page([demo for demo in DEMOS if demo.name in took], took))


if __name__ == "__main__":
    if len(sys.argv) < 5:
        raise SystemExit(__doc__)
    main(*sys.argv[1:])
