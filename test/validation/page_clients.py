#!/usr/bin/env python3
"""What pages cost a tank that runs: usage: page_clients.py WAVETANK_NODE FOLDER [SPACING [SECONDS [ROUNDS]]]  (0.0183333 m, 15 s, 3)

A node with config/dam_break_3d.yaml that goes as fast as it can, the server of the page, and windows of so many seconds by turns: without a page; with two
that show all particles and read whatever comes; with one that asks for them and never reads. Prints steps a second of each, and what they lose."""

import json
import os
import shutil
import subprocess
import sys
import threading
import time

HERE = os.path.dirname(os.path.abspath(__file__))
PACKAGE = os.path.dirname(os.path.dirname(HERE))
NAME = "/paged"
KINDS = ["nobody", "two pages", "one that never reads"]

from soak import free_port, median  # noqa: E402


class Client(threading.Thread):
    """A page without a browser."""

    def __init__(self, url, reads):
        super().__init__(daemon=True)
        self.url, self.reads, self.clouds, self.ends = url, reads, 0, threading.Event()

    def run(self):
        import asyncio

        asyncio.run(self.talk())

    async def talk(self):
        import asyncio

        from tornado.httpclient import HTTPRequest
        from tornado.websocket import websocket_connect
        from wavetank.web.packets import unpack

        request = HTTPRequest(self.url.replace("http", "ws") + "socket", headers={"Origin": self.url[:-1]})
        connection = await websocket_connect(request, max_message_size=1 << 26)
        await connection.write_message('{"do": "show", "water": "particles"}')
        while not self.ends.is_set():
            if not self.reads:
                await asyncio.sleep(0.2)
                continue
            try:
                packet = await asyncio.wait_for(connection.read_message(), 0.5)
            except asyncio.TimeoutError:
                continue
            kind = json.loads(packet)["kind"] if isinstance(packet, str) else unpack(packet)[0]["kind"]
            self.clouds += kind == "cloud"
            if kind not in ("answer", "series"):
                await connection.write_message('{"do": "seen"}')
        connection.close()


def main():
    if len(sys.argv) < 3:
        print(__doc__, file=sys.stderr)
        return 2
    program, folder = [os.path.abspath(word) for word in sys.argv[1:3]]
    spacing = float(sys.argv[3]) if len(sys.argv) > 3 else 0.0183333
    seconds = float(sys.argv[4]) if len(sys.argv) > 4 else 15.0
    rounds = int(sys.argv[5]) if len(sys.argv) > 5 else 3
    shutil.rmtree(folder, ignore_errors=True)
    os.makedirs(folder)
    os.environ.update(ROS_MASTER_URI="http://localhost:%d" % free_port(), ROS_HOSTNAME="localhost", ROS_LOG_DIR=folder)
    started = []
    try:
        return measure(program, folder, spacing, seconds, rounds, started)
    finally:
        for process in reversed(started):
            process.kill()
            process.wait()


def measure(program, folder, spacing, seconds, rounds, started):
    import rosgraph
    import rospy
    from wavetank.msg import SolverStatus

    port = os.environ["ROS_MASTER_URI"].rsplit(":", 1)[1]
    started.append(subprocess.Popen([sys.executable, shutil.which("rosmaster"), "--core", "-p", port], stdout=subprocess.DEVNULL))
    master = rosgraph.Master("/page_clients")
    while not master.is_online():
        time.sleep(0.1)
    parameters = {"case_file": os.path.join(PACKAGE, "config", "dam_break_3d.yaml"), "fluid": {"spacing": spacing}, "duration": 1e9, "max_points": 1000000}
    for key, value in parameters.items():
        master.setParam(NAME + "/" + key, value)
    with open(os.path.join(folder, "node.log"), "w") as log:
        started.append(subprocess.Popen([program, "__name:=" + NAME[1:]], stdout=log, stderr=log))
    newest = []
    rospy.init_node("page_clients", disable_signals=True)
    rospy.Subscriber(NAME + "/status", SolverStatus, lambda message: newest.append((time.time(), message.step, message.particles)))
    while not (newest and newest[-1][1] > 20):
        time.sleep(0.2)
    server = [sys.executable, os.path.join(PACKAGE, "scripts", "web"), "--port", "0", "--tank", NAME]
    started.append(subprocess.Popen(server, stdout=subprocess.PIPE, universal_newlines=True))
    url = started[-1].stdout.readline().split()[0]
    rates, clouds, watched = {kind: [] for kind in KINDS}, 0, 0.0
    for _ in range(rounds):
        for kind in KINDS:
            clients = [Client(url, True) for _ in range(2)] if kind == "two pages" else [Client(url, False)] if kind != "nobody" else []
            for client in clients:
                client.start()
            time.sleep(3.0)
            first = newest[-1]
            time.sleep(seconds)
            last = newest[-1]
            rates[kind].append((last[1] - first[1]) / (last[0] - first[0]))
            for client in clients:
                client.ends.set()
                client.join(5)
                clouds += client.clouds
                watched += (3.0 + seconds) * client.reads
    print("%d particles; a page that reads got %.2f clouds a second" % (newest[-1][2], clouds / watched))
    without = median(rates["nobody"])
    for kind in KINDS:
        print("%-22s %s steps/s: %+.1f %%" % (kind, ", ".join("%.2f" % rate for rate in rates[kind]), 100 * (median(rates[kind]) / without - 1)))
    return 0


if __name__ == "__main__":
    sys.exit(main())
