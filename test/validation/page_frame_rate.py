#!/usr/bin/env python3
"""How many pictures a second the page draws of a cloud of so many particles, in a headless Chromium that draws on the processor; and what the server takes for one.

    test/validation/page_frame_rate.py [PARTICLES [SECONDS [all]]]  (111000, 10; all: the page leaves none out, however slow it is)"""

import collections
import os
import sys
import tempfile
import time

import numpy
import rosbag
import rospy
from sensor_msgs.msg import PointCloud2, PointField
from std_msgs.msg import String

sys.path.insert(0, os.path.join(os.path.dirname(os.path.dirname(os.path.abspath(__file__))), "node"))
from page_browser import MISSING, NO_SERVER, Browser, end, start_server  # noqa: E402
from wavetank.web.packets import cloud_packet  # noqa: E402

NAMES = ("x", "y", "z", "vx", "vy", "vz", "pressure", "density", "shepard", "surface")
CLOUDS = 40


def cloud_of(lattice, n):
    points = numpy.zeros((len(lattice), len(NAMES)), "<f4")
    points[:, :3] = lattice
    points[:, 2] += 0.05 * numpy.sin(4 * lattice[:, 0] + 0.3 * n)
    points[:, 3] = 1 + numpy.sin(3 * lattice[:, 0] - 0.3 * n)
    return points


def processor_times(root):
    """s, that a process and all that it started have taken, by what they are to the browser."""
    parents, times, kinds = {}, {}, {}
    for name in os.listdir("/proc"):
        try:
            with open("/proc/%s/stat" % int(name)) as file:
                fields = file.read().rpartition(")")[2].split()
            with open("/proc/%s/cmdline" % int(name)) as file:
                words = file.read().replace("\0", " ").split()
        except (OSError, ValueError):
            continue
        parents[int(name)], times[int(name)] = int(fields[1]), int(fields[11]) + int(fields[12])
        kinds[int(name)] = next((word[7:] for word in words if word.startswith("--type=")), "browser")

    def is_of(process):
        while process and process != root:
            process = parents.get(process)
        return process == root

    taken = collections.Counter()
    for process, ticks in times.items():
        if is_of(process):
            taken[kinds[process]] += ticks / os.sysconf("SC_CLK_TCK")
    return taken


def main():
    count = int(sys.argv[1]) if len(sys.argv) > 1 else 111000
    seconds = float(sys.argv[2]) if len(sys.argv) > 2 else 10.0
    if MISSING or NO_SERVER:
        sys.exit(MISSING or NO_SERVER)
    spacing = (1.2 / count) ** (1 / 3)
    axes = [numpy.arange(0, length, spacing) for length in (2.0, 1.0, 0.6)]
    lattice = numpy.stack(numpy.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 3)[:count]
    fields = [PointField(name, 4 * place, PointField.FLOAT32, 1) for place, name in enumerate(NAMES)]

    points = cloud_of(lattice, 0)
    by_name = {name: points[:, place] for place, name in enumerate(NAMES)}
    begin = time.process_time()
    for _ in range(10):
        packet = cloud_packet("particles", 0, by_name)
    print("%d particles: a packet of %.2f MB in %.1f ms of the server" % (len(lattice), len(packet) / 1e6, 100 * (time.process_time() - begin)))

    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "cloud.bag")
        with rosbag.Bag(path, "w") as bag:
            bag.write("/wavetank/case", String("title: Frame rate\ndimensions: 3\nfluid:\n  spacing: %g\n" % spacing), rospy.Time(1))
            # so that the reader sees a tank
            bag.write("/wavetank/bodies/tank/wrench", wrench(), rospy.Time(1))
            for n in range(CLOUDS):
                data = cloud_of(lattice, n).tobytes()
                cloud = PointCloud2(height=1, width=len(lattice), fields=fields, point_step=4 * len(NAMES), row_step=len(data), data=data)
                cloud.header.stamp = rospy.Time.from_sec(1 + n / 20)
                bag.write("/wavetank/particles", cloud, cloud.header.stamp)
        process, url = start_server(path)
        browser = Browser(1280, 800)
        try:
            browser.driver.get(url)
            browser.wait("window.wavetank && wavetank.received > 2", 60)
            if sys.argv[3:] == ["all"]:
                browser.driver.execute_script("wavetank.view._pace = () => {}")
            # round and round, as fast as pictures come
            browser.driver.execute_script(
                "document.getElementById('speed').value = '4'; setInterval(() => { if (!wavetank.player.playing) wavetank._goTo(wavetank.hello.times[0], true) }, 10)"
            )
            taken = processor_times(browser.driver.service.process.pid)
            before, since = browser.get("[wavetank.view.frames, wavetank.received]"), time.time()
            time.sleep(seconds)
            after, wall = browser.get("[wavetank.view.frames, wavetank.received]"), time.time() - since
            taken = processor_times(browser.driver.service.process.pid) - taken
            print("the page says: %s" % browser.get("wavetank.what"))
            print("of them in sight: %d" % browser.get("wavetank.view.water.geometry.drawRange.count"))
            size = browser.get("[wavetank.view.canvas.width, wavetank.view.canvas.height]")
            frames = after[0] - before[0]
            print("drawn %.1f times a second on %d × %d pixels, %.1f clouds a second" % (frames / wall, *size, (after[1] - before[1]) / wall))
            parts = ", ".join("%s %.0f" % (kind, 1000 * each / max(frames, 1)) for kind, each in taken.most_common())
            print("the browser took %.0f ms of processor time a picture: %s" % (1000 * sum(taken.values()) / max(frames, 1), parts))
        finally:
            browser.quit()
            end(process)


def wrench():
    from geometry_msgs.msg import WrenchStamped

    message = WrenchStamped()
    message.header.stamp = rospy.Time(1)
    return message


if __name__ == "__main__":
    main()
