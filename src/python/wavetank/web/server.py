"""The server of the page: files, and a websocket for each client."""

import asyncio
import errno
import json
import logging
import os
import socket
import threading
import time

import tornado.httpserver
import tornado.iostream
import tornado.netutil
import tornado.web
import tornado.websocket

from wavetank import Failure
from wavetank.web.libraries import JAVASCRIPT, LIBRARIES, library_path
from wavetank.web.mailbox import Mailbox
from wavetank.web.requests import Refused, host_name, origin_is_ours, read_request

STATIC = os.path.join(os.path.dirname(os.path.abspath(__file__)), "static")
AHEAD = 4  # pictures that a client may have been sent and not yet drawn: what lies in buffers on the way is old when it comes
WAITING_REQUESTS = 4  # of a client; while there are more it is not read
LONGEST_MESSAGE = 65536  # bytes, of a client; a longer one ends its connection
SAMPLES_EVERY, POSES_EVERY, LOOK_EVERY = 0.1, 0.05, 1.0  # s of wall time
PATIENCE = 2.0  # s: a page that has had no room for a picture for so long is made none any more, until it has
FULL, GOING_AWAY = 1013, 1001  # of RFC 6455
KEPT = ("hello", "drawing", "lines", "status", "silence", "poses")  # kinds whose newest a new client gets, beside the water that it asks for
WATERS = ("particles", "free_surface", "surface", "spray")  # kinds of which a client wants one alone, and with the surface its spray


async def in_thread(function, *arguments):
    """Its result, while the loop goes on. The thread holds nothing up at the end: a tank's answer may take as long as a step."""
    loop, done = asyncio.get_running_loop(), asyncio.get_running_loop().create_future()

    def settle(set_it, value):
        if not done.done():
            set_it(value)

    def run():
        try:
            result, set_it = function(*arguments), done.set_result
        except Exception as error:  # handed over to whoever waits
            result, set_it = error, done.set_exception
        try:
            loop.call_soon_threadsafe(settle, set_it, result)
        except RuntimeError:  # the loop has ended
            pass

    threading.Thread(target=run, daemon=True).start()
    return await done


def text_of(packet):
    """Raises ValueError of what is no number: a page could not read it."""
    return packet if isinstance(packet, bytes) else json.dumps(packet, separators=(",", ":"), allow_nan=False)


class Hub:
    """Who is connected, and the newest picture of each kind."""

    def __init__(self, most_clients):
        self.most_clients = most_clients
        self.clients, self.newest = set(), {}
        self.run = 0  # of the hello that came last
        self.wanted_changed, self.run_changed = lambda wanted: None, lambda: None

    def publish(self, kind, packet):
        """A picture, to all that want it. In the loop's thread."""
        if kind == "hello" and packet["run"] != self.run:
            self.run = packet["run"]
            self.forget()
        if kind == "drawing":  # the whole: what was drawn beside the one before is no more
            self.drop("lines")
        packet = text_of(packet)
        wanting = [client for client in self.clients if client.wants(kind)]
        if kind in KEPT or wanting:
            self.newest[kind] = packet
        for client in wanting:
            if kind == "hello":
                client.mailbox.answer(packet)  # before all that belongs to it
            else:
                client.mailbox.put(kind, packet)
            client.wake.set()

    def forget(self):
        """What is of the tank before: the drawing that comes of another takes the place of the one before by itself, and may have come already."""
        for kind in [*WATERS, "lines", "poses", "status"]:
            self.drop(kind)
        for client in self.clients:
            client.mailbox.drop_samples()
        self.run_changed()

    def drop(self, kind):
        self.newest.pop(kind, None)
        for client in self.clients:
            client.mailbox.drop(kind)

    def add(self, table, times, values, clear):
        for client in self.clients:
            client.mailbox.add(table, times, values, clear)
            client.wake.set()

    def tell_wanted(self):
        wanted = {client.water for client in self.clients if client.takes_pictures} - {None}
        for name in WATERS:
            if name not in wanted and not (name == "spray" and "surface" in wanted):
                self.newest.pop(name, None)
        self.wanted_changed(wanted)

    def look_who_reads(self):
        """The tank makes no clouds for pages that do not take what they were sent."""
        now = time.monotonic()
        changed = [client for client in self.clients if client.has_changed(now)]
        if changed:
            self.tell_wanted()


class Client(tornado.websocket.WebSocketHandler):
    """One page. It is sent to only as fast as it reads."""

    def initialize(self, server):
        self.server, self.hub, self.source = server, server.hub, server.source
        self.mailbox, self.wake, self.water, self.sender = Mailbox(), asyncio.Event(), None, None
        self.busy, self.requests, self.ahead = asyncio.Lock(), 0, 0
        self.is_writing, self.takes_pictures, self.had_room = False, True, time.monotonic()

    def check_origin(self, origin):
        return origin_is_ours(origin, self.request.host, names_for(self.request, self.server.names))

    async def get(self, *arguments, **named):
        # tornado lets a client without an Origin pass: browsers send one always
        if not self.check_origin(self.request.headers.get("Origin")):
            self.set_status(403)
            self.finish("this page is not of this server")
            return
        await super().get(*arguments, **named)

    def open(self):
        self.set_nodelay(True)
        if len(self.hub.clients) >= self.hub.most_clients:
            self.close(FULL, "%d pages are open, and no more may be" % self.hub.most_clients)
            return
        self.mailbox.answer(text_of(self.source.hello()))  # before all else
        for kind in KEPT:
            if kind in self.hub.newest and kind != "hello":
                self.mailbox.put(kind, self.hub.newest[kind])
        self.source.greet(self.mailbox)
        self.hub.clients.add(self)  # last: what fails before is closed, and must not count
        self.sender = asyncio.ensure_future(self.send())
        self.wake.set()

    def is_let_in(self):
        """Not one above the number of pages that may be open, nor one that has gone: neither is obeyed, whatever it has sent."""
        return self in self.hub.clients

    def wants(self, kind):
        return kind in KEPT or kind == self.water or (kind == "spray" and self.water == "surface")

    def has_changed(self, now):
        """Whether it takes pictures, which it did not, or the other way round. To be asked about once a second."""
        if self.ahead < AHEAD and not self.is_writing:
            self.had_room = now
        before, self.takes_pictures = self.takes_pictures, now - self.had_room <= PATIENCE
        return self.takes_pictures != before

    async def send(self):
        """All that waits; a picture is chosen when the one before has left, and few are ahead of what is drawn."""
        try:
            while True:
                await self.wake.wait()
                self.wake.clear()
                while True:
                    packet, is_picture = self.mailbox.take(pictures=self.ahead < AHEAD)
                    if packet is None:
                        break
                    self.ahead += is_picture
                    self.is_writing = True
                    await self.write_message(packet, binary=isinstance(packet, bytes))
                    self.is_writing = False
        except (tornado.websocket.WebSocketClosedError, tornado.iostream.StreamClosedError):
            pass

    async def on_message(self, text):
        # tornado reads the next message when this is done: who asks faster than it is answered, or does not read answers, is not read either
        while self.is_let_in() and self.requests + self.mailbox.answers() >= WAITING_REQUESTS:
            await asyncio.sleep(0.01)
        if not self.is_let_in():
            return
        try:
            request = read_request(text, self.source.requests, self.source.known())
        except Refused as refused:
            self.answer({"kind": "answer", "ok": False, "text": str(refused)})
            return
        if request["do"] == "seen":
            self.ahead = max(self.ahead - 1, 0)
            if not self.takes_pictures:
                self.hub.look_who_reads()
            self.wake.set()
            return
        self.requests += 1
        asyncio.ensure_future(self.answer_to(request))

    async def answer_to(self, request):
        """One after the other, in their order. Whatever goes wrong is an answer: the page waits for one."""
        try:
            async with self.busy:
                if not self.is_let_in():
                    return
                text, ok = await self.do(request) or "", True
        except (Refused, Failure) as failure:
            text, ok = str(failure), False
        except Exception:
            logging.getLogger("wavetank.web").exception("'%s' of a page failed", request["do"])
            text, ok = "'%s' failed in the server, which tells more where it was started" % request["do"], False
        finally:
            self.requests -= 1
        self.answer({"kind": "answer", "do": request["do"], "ok": ok, "text": text})

    def answer(self, packet):
        self.mailbox.answer(text_of(packet))
        self.wake.set()

    async def do(self, request):
        if request["do"] == "show":
            self.show(request["water"])
        elif request["do"] == "frame":
            pictures = await self.server.in_turn(self.source.pictures, request["time"], request["water"])
            for kind in ("cloud", "surface", "spray", "lines"):
                self.mailbox.drop(kind)
            for kind, packet in pictures.items():
                self.mailbox.put(kind, packet)
        else:
            return await in_thread(self.source.call, request)
        return ""

    def show(self, water):
        for kind in WATERS:
            self.mailbox.drop(kind)
        self.water = water
        self.hub.tell_wanted()
        for kind in (water, "spray"):
            if self.wants(kind) and kind in self.hub.newest:
                self.mailbox.put(kind, self.hub.newest[kind])

    def on_close(self):
        if self.sender:
            self.sender.cancel()
        if self in self.hub.clients:
            self.hub.clients.discard(self)
            self.hub.tell_wanted()


class Files(tornado.web.StaticFileHandler):
    """The page's own files, and those of the libraries that it has."""

    def prepare(self):
        """A page that was asked for by a name that is not ours could do nothing."""
        host = self.request.host
        if host_name(host) not in names_for(self.request, self.application.settings["names"]):
            self.set_status(403)
            self.set_header("Content-Type", "text/plain; charset=utf-8")
            self.finish(
                "This server does not go by the name '%s': open the page by its address, or start the server with --name of that name." % host_name(host)
            )

    def set_extra_headers(self, path):
        csp = "default-src 'self'; connect-src 'self' ws://%s; img-src 'self' data:; style-src 'self' 'unsafe-inline'"
        self.set_header("Content-Security-Policy", csp % self.request.host)
        self.set_header("X-Content-Type-Options", "nosniff")
        self.set_header("X-Frame-Options", "DENY")
        self.set_header("Cache-Control", "no-cache")


class Library(Files):
    @classmethod
    def get_absolute_path(cls, root, path):
        return os.path.realpath(library_path(path))

    def validate_absolute_path(self, root, absolute_path):
        return absolute_path


def own_names(address):
    """By which a page may ask for this server: the address that it listens to, this machine's names, and addresses, which no foreign name server tells."""
    names = {"localhost", "127.0.0.1", "::1", address.lower()}
    if address not in ("localhost", "127.0.0.1", "::1"):
        host = socket.gethostname().lower()
        names |= {host, socket.getfqdn().lower(), host.split(".")[0]}
        try:
            names |= {each[4][0] for each in socket.getaddrinfo(host, None)}
        except OSError:
            pass
    return names


def names_for(request, names):
    """And the address of this machine that it was reached by, of which it may have more than its own name tells."""
    try:
        reached = request.connection.stream.socket.getsockname()[0].lower().partition("%")[0]
    except (AttributeError, OSError):  # it has gone
        return names
    return names | {reached, reached[len("::ffff:") :] if reached.startswith("::ffff:") else reached}


def bind(address, port):
    if not address.strip():
        raise Failure("--address is empty: it is an address of this machine, or 0.0.0.0 for all that it has")
    if not 0 <= port <= 65535:
        raise Failure("--port is a number from 0 to 65535, not %d" % port)
    try:
        return tornado.netutil.bind_sockets(port, address)
    except socket.gaierror:
        raise Failure("--address '%s' is no address of this machine" % address)
    except OSError as error:
        if error.errno == errno.EADDRINUSE:
            raise Failure("port %d of %s is taken: choose another by --port, or end what has it" % (port, address))
        if error.errno == errno.EADDRNOTAVAIL:
            raise Failure("--address '%s' is no address of this machine" % address)
        raise Failure("cannot listen to port %d of %s: %s" % (port, address, error.strerror or error))


class Server:
    """Raises Failure where it cannot listen. source: a Live or a Replay."""

    def __init__(self, address, port, most_clients, names=()):
        self.sockets = bind(address, port)
        self.port = self.sockets[0].getsockname()[1]
        self.names = own_names(address) | {name.lower() for name in names}
        self.hub, self.source = Hub(most_clients), None
        self._turn = asyncio.Lock()
        self._wanted, self._wish = set(), asyncio.Event()
        shown = "localhost" if address in ("127.0.0.1", "::1") else socket.gethostname() if address in ("0.0.0.0", "::", "") else address
        self.url = "http://%s:%d/" % ("[%s]" % shown if ":" in shown else shown, self.port)

    async def in_turn(self, function, *arguments):
        """In a thread, one at a time: what reads a bag keeps the part that it read last."""
        async with self._turn:
            return await in_thread(function, *arguments)

    async def serve(self, source, stopped):
        """Until the event is set."""
        self.source = source
        application = tornado.web.Application(
            [
                (r"/socket", Client, {"server": self}),
                (r"/library/(%s)" % "|".join(name.replace(".", r"\.") for name in LIBRARIES), Library, {"path": JAVASCRIPT}),
                (r"/(.*)", Files, {"path": STATIC, "default_filename": "index.html"}),
            ],
            websocket_max_message_size=LONGEST_MESSAGE,
            websocket_ping_interval=20,
            names=self.names,
            log_function=lambda handler: None,
        )
        server = tornado.httpserver.HTTPServer(application, max_body_size=65536, idle_connection_timeout=60)
        server.add_sockets(self.sockets)
        works = [asyncio.ensure_future(work) for work in self._works()]
        try:
            ended = [asyncio.ensure_future(stopped.wait()), *works]
            done, _ = await asyncio.wait(ended, return_when=asyncio.FIRST_COMPLETED)
            for each in done:
                each.result()  # a work that failed is not to be missed
        finally:
            for work in works:
                work.cancel()
            server.stop()
            for client in list(self.hub.clients):
                client.close(GOING_AWAY, "the server ends")
            await asyncio.sleep(0.05)  # so that they hear of it
            await asyncio.wait({asyncio.ensure_future(server.close_all_connections())}, timeout=1.0)

    def _works(self):
        if self.source.mode != "live":
            return []
        self.hub.wanted_changed, self.hub.run_changed = self._want, self.source.forget
        return [self._every(SAMPLES_EVERY, self._send_samples), self._every(POSES_EVERY, self._send_poses), self._look(), self._show()]

    def _want(self, wanted):
        self._wanted = wanted
        self._wish.set()

    async def _show(self):
        """One wish after the other, the newest alone: a subscription waits for the ROS master, which may not answer."""
        while True:
            await self._wish.wait()
            self._wish.clear()
            try:
                await in_thread(self.source.show, self._wanted)
            except Exception:
                logging.getLogger("wavetank.web").exception("what is shown cannot be changed")

    async def _every(self, seconds, work):
        while True:
            work()
            await asyncio.sleep(seconds)

    async def _look(self):
        while True:
            self.hub.look_who_reads()
            await in_thread(self.source.look_around)
            await asyncio.sleep(LOOK_EVERY)

    def _send_samples(self):
        for sample in self.source.samples():
            self.hub.add(*sample)

    def _send_poses(self):
        poses = self.source.poses()
        if poses:
            self.hub.publish("poses", poses)
