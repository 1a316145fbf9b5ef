#!/usr/bin/env python3
"""The page of a tank that runs: what clients get, what they may do to it, and the page itself in a browser."""

import asyncio
import json
import socket
import sys
import time
import unittest

import rospy
import rostest
from ear import Ear
from nav_msgs.msg import Odometry
from page_browser import MISSING, NO_SERVER, Browser, end, start_server
from wavetank.msg import ProbeArray, SolverStatus
from wavetank.web.packets import unpack

STATUS, PROBES, BOX = "/wavetank/status", "/wavetank/probes", "/wavetank/bodies/box/odom"
WAIT = 30  # s


class Client:
    """A page without a browser."""

    def __init__(self, connection):
        self._connection = connection
        self._last = {}  # of each kind

    @classmethod
    async def connect(cls, url):
        from tornado.httpclient import HTTPRequest
        from tornado.websocket import websocket_connect

        return cls(await websocket_connect(HTTPRequest(url.replace("http", "ws") + "socket", headers={"Origin": url[:-1]})))

    async def next_of(self, kind, is_wanted=lambda header: True):
        while True:
            packet = await asyncio.wait_for(self._connection.read_message(), WAIT)
            header, arrays = unpack(packet) if isinstance(packet, bytes) else (json.loads(packet), {})
            if header["kind"] not in ("answer", "series"):
                await self._connection.write_message('{"do": "seen"}')
            self._last[header["kind"]] = header, arrays
            if header["kind"] == kind and is_wanted(header):
                return header, arrays

    async def last_or_next_of(self, kind, is_wanted):
        """Of what is sent but once: it may have come before something else that was waited for."""
        if kind in self._last and is_wanted(self._last[kind][0]):
            return self._last[kind]
        return await self.next_of(kind, is_wanted)

    async def ask(self, **request):
        await self._connection.write_message(json.dumps(request))
        answer, _ = await self.next_of("answer")
        return answer

    def close(self):
        self._connection.close()


def stalled(url):
    """A client that asks for all particles and then never reads."""
    host, _, port = url[len("http://") : -1].rpartition(":")
    connection = socket.create_connection((host, int(port)))
    connection.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
    head = "GET /socket HTTP/1.1\r\nHost: %s:%s\r\nOrigin: %s\r\nUpgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n"
    connection.sendall((head % (host, port, url[:-1])).encode())
    text = b'{"do":"show","water":"particles"}'
    connection.sendall(bytes([0x81, 0x80 | len(text)]) + bytes(4) + text)  # masked by zeros
    return connection


@unittest.skipIf(NO_SERVER, NO_SERVER)
class Web(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node("web_test")
        cls.ear = Ear({STATUS: SolverStatus, PROBES: ProbeArray, BOX: Odometry}, waited_for=())
        cls.process, cls.url = start_server()
        cls.addClassCleanup(end, cls.process)
        cls.ear.wait(
            lambda: cls.ear.all(BOX) and cls.ear.all(STATUS) and cls.ear.last(STATUS).phase == SolverStatus.RUNNING, "a pose, and the number of particles"
        )

    def phase(self, phase):
        self.ear.wait(lambda: self.ear.last(STATUS).phase == phase, "phase %d" % phase)

    def paused(self):
        """The state in which it stands, once all that was sent before has been heard."""
        self.phase(SolverStatus.PAUSED)
        time.sleep(0.5)
        return self.ear.last(STATUS)

    def test_1_clients(self):
        async def talk():
            self.assertGreater(self.ear.last(STATUS).particles, 500)
            client = await Client.connect(self.url)
            await client.next_of("hello", lambda hello: [body["name"] for body in hello["bodies"]] == ["box", "paddle"])
            lazy = stalled(self.url)
            self.addCleanup(lazy.close)
            drawing, _ = await client.last_or_next_of("drawing", lambda drawing: any(part["body"] == "box" for part in drawing["parts"]))
            self.assertIn("tank", [part["group"] for part in drawing["parts"]])
            self.assertTrue((await client.ask(do="show", water="particles"))["ok"])
            times = []
            for _ in range(10):
                cloud, arrays = await client.next_of("cloud")
                times.append(cloud["time"])
                self.assertEqual(len(arrays["points"]), 4 * self.ear.last(STATUS).particles)
            self.assertEqual(times, sorted(set(times)))
            poses, _ = await client.next_of("poses")
            self.assertEqual(set(poses["poses"]), {"box", "paddle", "trolley"})

            self.assertFalse((await client.ask(do="push", body="step", force=[1, 0, 0], torque=[0, 0, 0]))["ok"])
            self.assertFalse((await client.ask(do="step"))["ok"], "a step while it runs")
            self.assertTrue((await client.ask(do="pause", value=True))["ok"])
            await client.next_of("status", lambda status: status["phase"] == SolverStatus.PAUSED)
            steps = self.paused().step
            for bad in ({"do": "step", "much": 1}, {"do": "pause", "value": 0}, {"do": "shutdown"}):
                self.assertFalse((await client.ask(**bad))["ok"])
            self.assertTrue((await client.ask(do="step"))["ok"])
            await client.next_of("status", lambda status: status["step"] > steps)
            self.assertEqual(self.paused().step, steps + 1, "one step, and nothing of what was refused")

            speed = self.ear.last(BOX).twist.twist.linear.x
            self.assertTrue((await client.ask(do="push", body="box", force=[200, 0, 0], torque=[0, 0, 0]))["ok"])
            await asyncio.sleep(0.2)
            self.assertTrue((await client.ask(do="pause", value=False))["ok"])
            self.ear.wait(lambda: self.ear.last(BOX).twist.twist.linear.x > speed + 0.05, "the box is pushed")

            await client.ask(do="pause", value=True)
            self.assertTrue((await client.ask(do="reset"))["ok"])
            await client.next_of("status", lambda status: status["step"] == 0)
            await client.ask(do="pause", value=False)
            client.close()

        asyncio.run(talk())

    @unittest.skipIf(MISSING, MISSING)
    def test_2_in_the_browser(self):
        browser = Browser()
        self.addCleanup(browser.quit)
        browser.driver.get(self.url)
        browser.wait("window.wavetank && wavetank.received > 2 && wavetank.status && wavetank.status.phase === 1", WAIT)
        self.assertGreater(browser.water_share(), 0.05)
        browser.press("pause")
        status = self.paused()
        browser.wait("wavetank.status.phase === 2 && document.getElementById('state').textContent === 'paused'")
        last = self.ear.last(PROBES)
        start = round(status.header.stamp.to_sec() - status.time)
        self.assertGreaterEqual(start, 1, "the reset before has set stamps on")
        rows = "[...wavetank.plots.all.values()].find((plot) => plot.name === 'probes').rows"
        plot = rows + ".slice(-1)[0]"
        browser.wait("%s[0] >= %.9f" % (plot, last.header.stamp.to_sec() - start - 1e-9))
        self.assertLess(browser.get(rows + "[0][0]"), 0.5, "of this run alone, from its beginning")
        browser.wait("document.getElementById('clock').textContent === 't = %.3f s'" % status.time)
        self.assertEqual(self.ear.last(PROBES).header.stamp, last.header.stamp, "paused is paused")
        instant, pressure = browser.get(plot)
        self.assertAlmostEqual(instant, last.header.stamp.to_sec() - start, delta=1e-9)
        self.assertEqual(pressure, last.pressures[0])
        browser.press("reset")
        browser.wait("document.getElementById('clock').textContent === 't = 0.000 s' && %s.every((row) => row[0] === 0)" % rows)
        self.assertEqual(browser.errors(), [])
        browser.press("pause")
        self.phase(SolverStatus.RUNNING)
        browser.quit()

    def test_3_ends(self):
        self.assertEqual(end(self.process), 0)


if __name__ == "__main__":
    rostest.rosrun("wavetank", "web", Web, sys.argv)
