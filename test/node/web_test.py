#!/usr/bin/env python3
"""The page in the browser: its server, and a bag as a user sees it."""

import asyncio
import io
import json
import math
import shutil
import socket
import subprocess
import sys
import threading
import time
import unittest
import urllib.error
import urllib.request
import numpy
import rosbag
import rospy
from page_browser import MISSING, NO_SERVER, Browser, end, start_server
from visualization_msgs.msg import Marker, MarkerArray
from wavetank.msg import ProbeArray
from wavetank import Failure
from wavetank.bag_file import BagFile
from wavetank.recording import Recording
from wavetank.web.packets import unpack
from wavetank.web.replay import Replay
from web_bags import MadeTank, PRESSURE, WithBag, write_bag


@unittest.skipIf(NO_SERVER, NO_SERVER)
class Server(WithBag):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.process, cls.url = start_server(cls.bag, "--clients", "2")
        cls.addClassCleanup(end, cls.process)
        cls.host = cls.url[len("http://") : -1]

    def connect(self, origin=None, url=None):
        from tornado.httpclient import HTTPRequest
        from tornado.websocket import websocket_connect

        url = url or self.url
        return websocket_connect(HTTPRequest(url.replace("http", "ws") + "socket", headers={"Origin": origin or url[:-1]}))

    @staticmethod
    async def next_of(connection, kind):
        while True:
            packet = await asyncio.wait_for(connection.read_message(), 10)
            if packet is None:
                raise AssertionError("closed before a %s came" % kind)
            header, arrays = unpack(packet) if isinstance(packet, bytes) else (json.loads(packet), {})
            if header["kind"] not in ("answer", "series"):
                await connection.write_message('{"do": "seen"}')
            if header["kind"] == kind:
                return header, arrays

    def test_pictures_of_a_time(self):
        async def talk():
            connection = await self.connect()
            hello, _ = await self.next_of(connection, "hello")
            self.assertEqual((hello["waters"], hello["spacing"], len(hello["times"])), (["free_surface", "surface"], 0.04, 7))
            series, arrays = await self.next_of(connection, "series")
            self.assertEqual((series["name"], series["units"], arrays["values"][-1], len(arrays["times"])), ("probes", ["Pa"], PRESSURE, 201))
            for time, expected in ((0, 0.0), (0.39, 0.2), (0.4, 0.4), (99, 1.0), (0.5, 0.4), (0.7, 0.6)):
                await connection.write_message(json.dumps({"do": "frame", "time": time, "water": "free_surface"}))
                cloud, arrays = await self.next_of(connection, "cloud")
                self.assertEqual((cloud["time"], len(arrays["points"])), (expected, 4 * 4875))
                numpy.testing.assert_allclose(cloud["poses"]["boat"], [1.5, 0, expected, 0, 0, 0, 1])
                lines, _ = await self.next_of(connection, "lines")
                self.assertEqual([part["group"] for part in lines["parts"]], ["moorings"] if time >= 0.5 else [])
            for time, expected, corners, drops in ((0.4, 0.0, 0, 0), (0.6, 0.5, 36, 2)):
                await connection.write_message(json.dumps({"do": "frame", "time": time, "water": "surface"}))
                surface, arrays = await self.next_of(connection, "surface")
                self.assertEqual((surface["time"], len(arrays["corners"]), len(arrays["points"])), (expected, corners, 4 * 8 if corners else 0))
                spray, arrays = await self.next_of(connection, "spray")
                self.assertEqual((len(arrays["points"]), surface["poses"].keys()), (3 * drops, {"boat"}))
            connection.close()

        asyncio.run(talk())

    def test_what_cannot_be_read_gets_an_answer_and_the_next_is_heard(self):
        bag = self.bag + ".damaged.bag"
        write_bag(bag, compression="bz2", chunk_threshold=100000, broken_at=40)
        process, url = start_server(bag)
        self.addCleanup(end, process)
        chunks = BagFile(bag)._all_chunks()
        place = Recording(bag).stream("free_surface", "sensor_msgs/PointCloud2")._found[3][1][0]
        with open(bag, "r+b") as file:  # of the cloud at 0.6 s
            file.seek(chunks[place][1])
            file.write(bytes(1000))

        async def talk():
            connection = await self.connect(url=url)
            for time, ok, word in ((0.4, True, ""), (0.6, False, "is not whole"), (0.2, False, "failed in the server"), (0.0, True, "")):
                await connection.write_message(json.dumps({"do": "frame", "time": time, "water": "free_surface"}))
                answer, _ = await self.next_of(connection, "answer")
                self.assertEqual(answer["ok"], ok, "%g: %s" % (time, answer))
                self.assertIn(word, answer["text"])
            connection.close()

        asyncio.run(talk())

    def test_a_pose_that_is_no_number_is_left_out(self):
        from wavetank.web.server import text_of

        bag = self.bag + ".lost.bag"
        write_bag(bag, lost_at=200)
        replay = Replay(bag)
        for time, bodies in ((0.2, ["boat"]), (1.0, [])):
            self.assertEqual(list(unpack(replay.pictures(time, "free_surface")["cloud"])[0]["poses"]), bodies)
        with self.assertRaises(ValueError):
            text_of({"kind": "poses", "poses": {"boat": [math.nan] * 7}})

    def test_what_is_not_allowed_gets_an_answer_and_the_next_is_heard(self):
        async def talk():
            connection = await self.connect()
            for bad in ("{", '{"do": "push"}', b"\x00", '{"do": "frame", "time": 0, "water": "particles"}', "x" * 5000):
                await connection.write_message(bad, binary=isinstance(bad, bytes))
                answer, _ = await self.next_of(connection, "answer")
                self.assertFalse(answer["ok"])
                self.assertGreater(len(answer["text"]), 10)
            await connection.write_message('{"do": "frame", "time": 0, "water": "free_surface"}')
            self.assertTrue((await self.next_of(connection, "answer"))[0]["ok"])
            connection.close()

        asyncio.run(talk())

    def test_a_foreign_page_is_not_let_in(self):
        from tornado.httpclient import HTTPClientError

        async def talk(origin):
            connection = await self.connect(origin)
            connection.close()

        for origin in ("http://elsewhere.org", "null", "http://localhost:1"):
            with self.assertRaises(HTTPClientError) as raised:
                asyncio.run(talk(origin))
            self.assertEqual(raised.exception.code, 403, origin)

    def test_no_more_pages_than_allowed(self):
        async def talk():
            first, second, third = [await self.connect() for _ in range(3)]
            await self.next_of(first, "hello")
            await self.next_of(second, "hello")
            self.assertIsNone(await asyncio.wait_for(third.read_message(), 10))
            self.assertEqual(third.close_code, 1013)
            self.assertIn("2 pages", third.close_reason)
            first.close()
            await asyncio.sleep(0.2)
            fourth = await self.connect()
            await self.next_of(fourth, "hello")
            second.close()
            fourth.close()
            await asyncio.sleep(0.2)

        asyncio.run(talk())

    def test_what_is_shown_follows_the_newest_wish_and_holds_nothing_up(self):
        from wavetank.web.server import Server

        class Slow(MadeTank):
            mode, shown, may_go_on = "live", [], threading.Event()
            samples = staticmethod(lambda: [])
            poses = look_around = forget = staticmethod(lambda: None)

            def show(self, wanted):
                self.shown.append(wanted)
                self.may_go_on.wait(10)

        async def talk():
            server, source, stopped = Server("127.0.0.1", 0, 1), Slow(), asyncio.Event()
            work = asyncio.ensure_future(server.serve(source, stopped))
            connection = await self.connect(url=server.url)
            for water in ("particles", "surface", "particles", "surface"):
                await connection.write_message(json.dumps({"do": "show", "water": water}))
                self.assertTrue((await self.next_of(connection, "answer"))[0]["ok"])
            self.assertEqual(source.shown, [{"particles"}], "the first is still waiting")
            source.may_go_on.set()
            await asyncio.sleep(0.1)
            self.assertEqual(source.shown, [{"particles"}, {"surface"}])
            connection.close()
            stopped.set()
            await work

        asyncio.run(talk())

    def test_a_page_that_does_not_take_its_pictures_is_made_none(self):
        from unittest import mock

        from wavetank.web import server as web
        from wavetank.web.server import Server

        class Noting(MadeTank):
            mode, shown = "live", []
            samples = staticmethod(lambda: [])
            poses = look_around = forget = staticmethod(lambda: None)

            def show(self, wanted):
                self.shown.append(wanted)

        async def talk():
            server, source, stopped = Server("127.0.0.1", 0, 1), Noting(), asyncio.Event()
            work = asyncio.ensure_future(server.serve(source, stopped))
            connection = await self.connect(url=server.url)
            await connection.write_message('{"do": "show", "water": "particles"}')
            await self.next_of(connection, "answer")
            for number in range(web.AHEAD + 1):
                server.hub.publish("particles", b"%d" % number)
                await asyncio.sleep(0.05)
            self.assertEqual(source.shown, [{"particles"}])
            await asyncio.sleep(0.6)
            self.assertEqual(source.shown, [{"particles"}, set()], "it was sent as many as may be ahead of what it has drawn")
            await connection.write_message('{"do": "seen"}')
            await asyncio.sleep(0.3)
            self.assertEqual(source.shown, [{"particles"}, set(), {"particles"}])
            connection.close()
            stopped.set()
            await work

        with mock.patch.multiple(web, PATIENCE=0.3, LOOK_EVERY=0.1):
            asyncio.run(talk())

    def test_ends_while_a_bag_is_being_read(self):
        code = "import os, signal, sys, time; import wavetank.web.replay as replay\nclass Slow:\n  def __init__(self, *more):\n    os.kill(os.getpid(), signal.SIGTERM); time.sleep(30)\nreplay.Replay = Slow\nfrom wavetank.web import command\nfrom wavetank import program\nsys.exit(program.run('web', command.main, ['any.bag', '--port', '0']))"
        done = subprocess.run([sys.executable, "-c", code], stdout=subprocess.PIPE, stderr=subprocess.PIPE, universal_newlines=True, timeout=20)
        self.assertEqual((done.returncode, done.stdout, done.stderr), (0, "", ""))

    def test_a_page_above_the_number_is_not_obeyed(self):
        from wavetank.web.server import Server

        async def talk():
            server, source, stopped = Server("127.0.0.1", 0, 1), MadeTank(), asyncio.Event()
            work = asyncio.ensure_future(server.serve(source, stopped))
            connection = await self.connect(url=server.url)
            await self.next_of(connection, "hello")
            push = {"do": "push", "body": "boat", "force": [1.0, 0.0, 0.0], "torque": [0.0, 0.0, 0.0]}
            reader, writer = await asyncio.open_connection("127.0.0.1", server.port)
            head = "GET /socket HTTP/1.1\r\nHost: %s\r\nOrigin: %s\r\nUpgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n"
            text = json.dumps(dict(push, force=[2, 0, 0])).encode()
            writer.write(
                (head % (server.url[len("http://") : -1], server.url[:-1])).encode() + bytes([0x81, 0x80 | len(text)]) + bytes(4) + text
            )  # masked by zeros
            self.assertIn(b"1 pages are open", await asyncio.wait_for(reader.readuntil(b"may be"), 10))
            await asyncio.sleep(0.1)
            await connection.write_message(json.dumps(push))
            self.assertTrue((await self.next_of(connection, "answer"))[0]["ok"])
            self.assertEqual(source.calls, [push])
            writer.close()
            connection.close()
            stopped.set()
            await work

        asyncio.run(talk())

    def test_by_any_address_of_this_machine_but_by_no_foreign_name(self):
        process, url = start_server(self.bag, "--address", "0.0.0.0")
        self.addCleanup(end, process)
        port = int(url[:-1].rpartition(":")[2])

        async def talk(url):
            connection = await self.connect(url=url)
            await self.next_of(connection, "hello")
            connection.close()

        own = "http://127.0.0.2:%d/" % port
        with urllib.request.urlopen(own) as page:
            self.assertEqual(page.status, 200)
        asyncio.run(talk(own))
        for host in ("elsewhere.org:%d" % port, "127.0.0.3"):
            with self.assertRaises(urllib.error.HTTPError, msg=host) as raised:
                urllib.request.urlopen(urllib.request.Request(own, headers={"Host": host}))
            self.assertEqual(raised.exception.code, 403, host)
            self.assertIn("--name", raised.exception.read().decode())

    def test_files(self):
        for name in ("", "page.js", "style.css", "library/three.js", "library/orbit.js", "library/dygraph.js", "library/dygraph.css"):
            with urllib.request.urlopen(self.url + name) as answer:
                self.assertGreater(len(answer.read()), 500)
                self.assertIn("default-src 'self'", answer.headers["Content-Security-Policy"])
        for name in ("../server.py", "%2e%2e/server.py", "library/..%2f..%2fpasswd", "library/jquery.js", "/etc/passwd"):
            with self.assertRaises(urllib.error.HTTPError, msg=name) as raised:
                urllib.request.urlopen(self.url + name)
            self.assertIn(raised.exception.code, (403, 404), name)

    def test_only_this_machine_is_listened_to(self):
        with socket.socket() as outside:
            outside.settimeout(2)
            own = socket.gethostbyname(socket.gethostname())
            if own.startswith("127."):
                self.skipTest("this machine has no other address by its name")
            self.assertNotEqual(outside.connect_ex((own, int(self.host.rpartition(":")[2]))), 0)

    def test_what_is_wrong_is_one_sentence(self):
        self.assertIn("is taken", self.refused(self.bag, "--port", self.host.rpartition(":")[2]))
        self.assertIn("no address of this machine", self.refused(self.bag, "--port", "0", "--address", "203.0.113.1"))
        self.assertIn("is empty", self.refused(self.bag, "--port", "0", "--address", ""))
        self.assertIn("0 to 65535", self.refused(self.bag, "--port", "99999"))
        self.assertIn("there is no bag", self.refused(self.bag + ".not", "--port", "0"))
        dry = self.bag + ".dry.bag"
        write_bag(dry, clouds=False)
        self.assertIn("no water to show: write it with wavetank_run --clouds", self.refused(dry, "--port", "0"))
        short = self.bag + ".short.bag"
        for topic, message in (("markers", MarkerArray([Marker()])), ("surface_mesh", Marker()), ("probes", ProbeArray(names=["P1"]))):
            shutil.copy(self.bag, short)
            with rosbag.Bag(short, "a") as bag:
                buffer = io.BytesIO()
                message.serialize(buffer)
                bag.write("/wavetank/" + topic, (message._type, buffer.getvalue()[:6], message._md5sum, type(message)), rospy.Time(0, 1), raw=True)
            with self.assertRaises(Failure, msg=topic) as raised:
                Replay(short)
            self.assertIn("cannot be read", str(raised.exception))

    def test_ends_cleanly_with_a_page_open(self):
        process, url = start_server(self.bag)
        self.addCleanup(end, process)

        async def talk():
            connection = await self.connect(url=url)
            await self.next_of(connection, "hello")
            process.terminate()
            while await asyncio.wait_for(connection.read_message(), 10) is not None:
                pass
            return connection.close_code

        self.assertEqual(asyncio.run(talk()), 1001)
        process.communicate(timeout=10)
        self.assertEqual(process.returncode, 0)


class MissingPackages(WithBag):
    def test_the_package_is_named(self):
        code = "import sys; sys.modules['tornado'] = None; import wavetank.web.libraries as l; l.JAVASCRIPT = '/no'\nfrom wavetank.web import command\nfrom wavetank import program\nsys.exit(program.run('web', command.main, sys.argv[1:]))"
        done = subprocess.run([sys.executable, "-c", code, self.bag], stdout=subprocess.PIPE, stderr=subprocess.PIPE, universal_newlines=True, timeout=30)
        self.assertEqual(done.returncode, 2, done.stderr)
        self.assertIn("apt-get install libjs-dygraphs libjs-three python3-tornado", done.stderr)
        self.assertEqual(len(done.stderr.splitlines()), 1, done.stderr)


# A block of water with spray over it, as all its particles are drawn and as those in sight alone are: whether the pictures are the same, and how many were drawn.
CLOUD_WITH_AND_WITHOUT_HIDDEN = """
    const view = wavetank.view, points = new Uint16Array(4 * 30000);
    let state = 7;
    const next = () => (state = (state * 48271) % 2147483647) / 2147483647;
    for (let i = 0; i < points.length; i += 4) {
      points[i] = 65535 * next();
      points[i + 1] = 65535 * next();
      points[i + 2] = 65535 * next() * (next() < 0.01 ? 1 : 0.4);
      points[i + 3] = 65535 * next();
    }
    view.showCloud({ points, low: [0.2, 0.1, 0.1], size: [1.6, 0.8, 0.8], top_speed: 2, typical_speed: 1, poses: null });
    view.diameter = view.water.material.uniforms.diameter.value = 0.03;
    const drawn = [true, false].map((slow) => {
      view.slow = slow;
      view._fillWater();
      view.renderer.render(view.scene, view.camera);
      return [view.canvas.toDataURL(), view.water.geometry.drawRange.count];
    });
    view.slow = true;
    return [drawn[0][0] === drawn[1][0], drawn[1][1], drawn[0][1], points.length / 4];"""


@unittest.skipIf(NO_SERVER or MISSING, NO_SERVER or MISSING)
class InTheBrowser(WithBag):
    def test_a_bag(self):
        process, url = start_server(self.bag)
        self.addCleanup(end, process)
        browser = Browser()
        self.addCleanup(browser.quit)
        browser.driver.get(url)
        browser.wait("window.wavetank && wavetank.received > 0 && !wavetank.player.playing && wavetank.time === 1", 30)
        self.assertEqual(browser.get("document.getElementById('title').textContent"), "A <b>made</b> bag")
        self.assertEqual(browser.get("[...wavetank.plots.all.values()][0].rows.slice(-1)[0]"), [1.0, PRESSURE])
        browser.wait("document.querySelector('.plot .values').textContent.includes('1235')")
        self.assertGreater(browser.water_share(), 0.05)
        self.assertEqual(browser.get("wavetank.view.drawn.get('boat').position.toArray()"), [1.5, 0, 1])
        browser.driver.execute_script("const water = document.getElementById('water'); water.value = 'surface'; water.dispatchEvent(new Event('change'))")
        browser.wait("wavetank.what === '12 triangles' && wavetank.view.surface.visible")
        self.assertGreater(browser.water_share(), 0.05)
        browser.driver.execute_script("wavetank.view.hideWater()")
        self.assertLess(browser.water_share(), 0.02)
        browser.press("reset")
        browser.wait("wavetank.time < 1e-8 && wavetank.view.drawn.get('boat').position.z === 0")
        browser.driver.execute_script("const water = document.getElementById('water'); water.value = 'free_surface'; water.dispatchEvent(new Event('change'))")
        browser.press("step")
        browser.wait("wavetank.time === 0.2")
        self.assertEqual(browser.get("document.querySelector('.plot .values').textContent.trim()").split()[0], "P1")
        self.assertTrue(math.isclose(browser.get("[...wavetank.plots.all.values()][0].row()[1]"), 400.0))
        same, all_drawn, drawn, given = browser.driver.execute_script(CLOUD_WITH_AND_WITHOUT_HIDDEN)
        self.assertTrue(same)
        self.assertEqual(all_drawn, given)
        self.assertTrue(1000 < drawn < given / 2, drawn)
        self.assertEqual(browser.errors(), [])
        bad = ("wavetank._hear('{')", """wavetank._hear('{"kind": "poses", "poses": {"boat": null}}')""", "wavetank._hear(new ArrayBuffer(2))")
        self.assertEqual(browser.driver.execute_script("const before = wavetank.unseen; %s; return wavetank.unseen - before" % "; ".join(bad)), 3)
        self.assertIn("cannot be shown", browser.get("document.getElementById('answer').textContent"))
        self.assertEqual(len(browser.errors()), 3)
        browser.press("step")
        browser.wait("wavetank.time === 0.4")
        browser.quit()
        self.assertEqual(end(process), 0)

    def test_a_tank_that_is_reset_falls_silent_and_is_another(self):
        from selenium.webdriver import ActionChains
        from wavetank.web.server import Server

        source, ready, running = MadeTank(), threading.Event(), {}

        async def serve():
            running.update(server=Server("127.0.0.1", 0, 1), stopped=asyncio.Event(), loop=asyncio.get_running_loop())
            ready.set()
            await running["server"].serve(source, running["stopped"])

        thread = threading.Thread(target=asyncio.run, args=(serve(),))
        thread.start()
        ready.wait()
        hub = running["server"].hub

        def do(function, *arguments):
            running["loop"].call_soon_threadsafe(function, *arguments)

        def status(stamp, time):
            do(hub.publish, "status", {"kind": "status", "stamp": stamp, "time": time, "step": 1, "phase": 1, "paused": False, "real_time_factor": None})

        def silent(is_so):
            do(hub.publish, "silence", {"kind": "silence", "silent": is_so, "master": True})

        def sample(times, clear):
            do(hub.add, {"name": "probes", "columns": ["P"], "units": ["Pa"]}, numpy.array(times), numpy.array([times]).T, clear)

        self.addCleanup(thread.join)
        self.addCleanup(do, running["stopped"].set)
        browser = Browser()
        self.addCleanup(browser.quit)
        browser.driver.get(running["server"].url)
        browser.wait("window.wavetank && wavetank.hello")
        clock, values = "document.getElementById('clock').textContent", "document.querySelector('.plot .values').textContent"
        status(5.5, 5.5)
        sample([1.0, 2.0], True)
        browser.wait("wavetank.plots.all.size && %s === 't = 5.500 s' && %s === 'P 2'" % (clock, values))
        status(6.0, 0.0)
        sample([], True)
        browser.wait("%s === 't = 0.000 s' && %s === 'P –'" % (clock, values))
        sample([0.5], False)
        browser.wait(values + " === 'P 0.5'")

        silent(False)
        button = browser.driver.find_element("css selector", "#pushes button")
        browser.wait("!document.querySelector('#pushes button').disabled")
        ActionChains(browser.driver).click_and_hold(button).perform()
        while len(source.calls) < 3:
            time.sleep(0.01)
        silent(True)  # so that the button is disabled while it is held
        browser.wait("document.querySelector('#pushes button').disabled")
        time.sleep(0.3)
        self.assertEqual(source.calls[-1]["force"], [0, 0, 0])
        pushes = len(source.calls)
        ActionChains(browser.driver).release().perform()
        silent(False)
        time.sleep(0.3)
        self.assertEqual(len(source.calls), pushes, "it is not held any more")

        source.run = 1
        do(hub.publish, "hello", source.hello())
        browser.wait("document.title.startsWith('run 1') && !wavetank.plots.all.size")
        self.assertEqual(browser.errors(), [])
        browser.quit()


if __name__ == "__main__":
    unittest.main()
