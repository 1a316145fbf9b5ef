#!/usr/bin/env python3
"""Kills runs by SIGKILL at random moments, and looks at what each leaves: usage: kills.py WAVETANK_RUN FOLDER [COUNT [SEED]]

Of every killed run: what is whole of its bag (after rosbag reindex) has the same messages as the bag of a run that nobody kills, from the first on and
without a gap; it reaches to the last snapshot at least; that snapshot of --save-every is not older than it may be, and the run that goes on from it has
the same messages to the bit; and that run, which is given the same bag, tells what was left and how it is mended. Prints a row for each, and the seed."""

import os
import random
import re
import shutil
import struct
import subprocess
import sys
import time

import rosbag
import yaml

HERE = os.path.dirname(os.path.abspath(__file__))
SAVED_EVERY = 0.1  # s of simulated time
OWN_TIMES = ("/wavetank/status",)  # topics that hold wall time


class Wrong(Exception):
    """What a killed run has left is not what is promised."""


def write_case(folder, duration):
    """The small tank of the tests with its water on one side, so that it moves, and a box that floats."""
    with open(os.path.join(os.path.dirname(HERE), "node", "still_tank.yaml")) as file:
        case = yaml.safe_load(file)
    case["duration"] = duration
    case["fluid"]["fill"] = [{"box": {"min": [0, 0, 0], "max": [0.14, 0, 0.24]}}]
    case["bodies"] = [{"name": "box", "box": {"min": [0.04, -0.1, 0.22], "max": [0.1, 0.1, 0.28]}, "motion": "free", "density": 400.0}]
    path = os.path.join(folder, "case.yaml")
    with open(path, "w") as file:
        yaml.safe_dump(case, file)
    return path


def messages(path):
    """The bytes of each sample by topic and stamp, in the bag's order."""
    found = {}
    with rosbag.Bag(path) as bag:
        for topic, message, stamp in bag.read_messages(raw=True):
            if topic not in OWN_TIMES:
                found.setdefault(topic, {})[stamp.to_nsec()] = message[1]
    return found


def mend(path):
    subprocess.run(["rosbag", "reindex", "--quiet", path], check=True, stdout=subprocess.DEVNULL)
    shutil.rmtree(path + ".orig", ignore_errors=True)


def last_stamp_in(path):
    """s, of the last message that reached the file, whole or not: what was simulated at the least when the run died."""
    with open(path, "rb") as file:
        file.seek(max(0, os.path.getsize(path) - (1 << 21)))
        tail = file.read()
    stamps = [struct.unpack("<II", found) for found in re.findall(rb"time=(.{8})", tail, re.DOTALL)]
    return max([second + 1e-9 * nanosecond for second, nanosecond in stamps if nanosecond < 10**9], default=0.0)


def compare(found, whole, topic, begin, end=None):
    """The stamps of a topic from begin to end (none: wherever it ends) are those of the whole run, and their messages too."""
    mine, wanted = found.get(topic, {}), [stamp for stamp in whole[topic] if stamp > begin]
    if end is None:
        wanted = wanted[: len(mine)]
    if list(mine) != wanted:
        raise Wrong("%s has %d messages, and not those that %d of the whole run are" % (topic, len(mine), len(wanted)))
    for stamp in wanted:
        if mine[stamp] != whole[topic][stamp]:
            raise Wrong("%s differs at %g s" % (topic, 1e-9 * stamp))


class Kills:
    def __init__(self, program, folder, duration=1.0):
        self.program, self.folder, self.duration = program, folder, duration
        os.makedirs(folder, exist_ok=True)
        self.case = write_case(folder, duration)
        begin = time.time()
        self.run("whole.bag")  # which compiles the kernels
        begin = time.time()
        self.run("whole.bag", *self.saving())
        self.seconds = time.time() - begin
        self.whole = messages(self.path("whole.bag"))
        os.remove(self.path("a.snapshot"))

    def path(self, name):
        return os.path.join(self.folder, name)

    def arguments(self, bag, *more):
        return [self.program, self.case, "--bag", self.path(bag), *more]

    def saving(self):
        return ["--save", self.path("a.snapshot"), "--save-every", "%g" % SAVED_EVERY]

    def run(self, bag, *more):
        done = subprocess.run(self.arguments(bag, *more), stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, universal_newlines=True)
        if done.returncode != 0:
            raise Wrong("a run ended with code %d: %s" % (done.returncode, done.stderr))
        return done.stderr

    def kill_at(self, moment):
        """What became of a run that is killed so many seconds after its start, in a few words."""
        for name in os.listdir(self.folder):
            if name not in ("case.yaml", "whole.bag"):
                os.remove(self.path(name))
        process = subprocess.Popen(self.arguments("out.bag", *self.saving()), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        try:
            code = process.wait(moment)
        except subprocess.TimeoutExpired:
            process.kill()
            code = process.wait()
        left = sorted(set(os.listdir(self.folder)) - {"case.yaml", "whole.bag"})
        unknown = [name for name in left if not re.fullmatch(r"out\.bag(\.active)?|a\.snapshot(\.part)?", name)]
        if unknown:
            raise Wrong("it left %s" % ", ".join(unknown))
        if code == 0 or "out.bag" in left:
            if messages(self.path("out.bag")) != self.whole:
                raise Wrong("the whole bag is not that of a run that nobody killed")
            return "done before"
        if "out.bag.active" not in left or os.path.getsize(self.path("out.bag.active")) == 0:  # made, but nothing was written yet
            self.run("out.bag")
            return "nothing was begun"
        return self.look_at_what_died("a.snapshot" in left)

    def look_at_what_died(self, has_snapshot):
        reached = last_stamp_in(self.path("out.bag.active"))
        said = self.run("out.bag", *(["--restore", self.path("a.snapshot")] if has_snapshot else []))
        if "out.bag.1.active" not in said or "rosbag reindex" not in said:
            raise Wrong("the next run does not tell how to mend what was left: '%s'" % said.strip())
        rest = messages(self.path("out.bag"))
        begin = min(min(stamps) for topic, stamps in rest.items() if topic == "/wavetank/probes") if has_snapshot else 0
        saved = 1e-9 * begin if has_snapshot else 0.0
        if reached - saved > SAVED_EVERY + 0.005:  # samples are every 1 ms, a step less than 2 ms
            raise Wrong("it reached %g s, but its snapshot is of %g s" % (reached, saved))
        for topic in ("/wavetank/probes", "/wavetank/gauges", "/wavetank/bodies/box/odom", "/wavetank/bodies/box/wrench"):
            compare(rest, self.whole, topic, begin - 1 if has_snapshot else -1, self.duration)
        mend(self.path("out.bag.1.active"))
        kept = messages(self.path("out.bag.1.active"))
        for topic in kept:
            if topic.startswith("/wavetank/") and topic in rest and len(rest[topic]) > 1:
                compare(kept, self.whole, topic, -1)
        last = max(kept.get("/wavetank/probes", {0: b""}))
        if has_snapshot and last + 1000001 < begin:
            raise Wrong("its bag is readable to %g s, but its snapshot is of %g s" % (1e-9 * last, saved))
        return "at %.3f s, bag readable to %.3f s, snapshot of %.3f s" % (reached, 1e-9 * last, saved)


def main():
    program, folder = sys.argv[1:3]
    count = int(sys.argv[3]) if len(sys.argv) > 3 else 50
    seed = int(sys.argv[4]) if len(sys.argv) > 4 else int(time.time())
    moments = random.Random(seed)
    kills = Kills(program, folder)
    print("kills: seed %d, runs of %.2f s" % (seed, kills.seconds))
    failed = 0
    for k in range(count):
        moment = moments.uniform(0, kills.seconds)
        try:
            what = kills.kill_at(moment)
        except Wrong as wrong:
            what, failed = "WRONG: %s" % wrong, failed + 1
        print("%3d  killed after %.3f s: %s" % (k + 1, moment, what), flush=True)
    print("%d of %d left all that is promised" % (count - failed, count))
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
