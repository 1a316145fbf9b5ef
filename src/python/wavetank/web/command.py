"""The program: rosrun wavetank web [BAG]."""

import argparse
import asyncio
import importlib.util
import signal

from wavetank import Failure
from wavetank.web.libraries import missing_packages

PORT, CLIENTS = 8780, 8


def read_arguments(arguments):
    parser = argparse.ArgumentParser(prog="web", description="Shows a wave tank in the browser: one that runs, or a bag. Ctrl-C ends it.")
    parser.add_argument("bag", nargs="?", help="written by wavetank_run with --clouds, --particles or --surface; without, the tank that runs")
    parser.add_argument("--tank", default="/wavetank", help="name of the tank's node (default /wavetank)")
    parser.add_argument("-n", "--namespace", help="of the tank, if the bag holds several (/wavetank)")
    parser.add_argument("--port", type=int, default=PORT, help="(default %d; 0: any that is free)" % PORT)
    parser.add_argument(
        "--address", default="127.0.0.1", help="that it listens to (default 127.0.0.1, this machine alone; 0.0.0.0: all; whoever reaches it may pause and push)"
    )
    parser.add_argument(
        "--name", action="append", default=[], help="by which browsers elsewhere call this machine, beside its own name and addresses; may be repeated"
    )
    parser.add_argument("--clients", type=int, default=CLIENTS, help="how many pages may be open at once (default %d)" % CLIENTS)
    options = parser.parse_args(arguments)
    if options.clients < 1:
        parser.error("--clients is at least 1")
    return options


def check_packages():
    missing = missing_packages() + ([] if importlib.util.find_spec("tornado") else ["python3-tornado"])
    if missing:
        raise Failure("the page needs what is not installed: apt-get install %s, or scripts/install --web" % " ".join(missing))


def make_live(options, publish):
    import rosgraph
    import rospy

    if not rosgraph.is_master_online():
        raise Failure("there is no ROS master: start a tank first, as in roslaunch wavetank dam_break_2d.launch, or name a bag")
    rospy.init_node("wavetank_web", anonymous=True, disable_signals=True)
    from wavetank.web.live import Live

    return Live(options.tank, publish)


async def serve(options):
    from wavetank.web.replay import Replay
    from wavetank.web.server import Server, in_thread

    loop, stopped = asyncio.get_running_loop(), asyncio.Event()
    for number in (signal.SIGINT, signal.SIGTERM):
        loop.add_signal_handler(number, stopped.set)
    server = Server(options.address, options.port, options.clients, options.name)

    def publish(kind, packet):
        try:
            loop.call_soon_threadsafe(server.hub.publish, kind, packet)
        except RuntimeError:  # the loop has ended
            pass

    # in a thread, so that it can be ended meanwhile: a large bag takes a while, and a ROS master may not answer
    make = (Replay, options.bag, options.namespace) if options.bag else (make_live, options, publish)
    made, ended = asyncio.ensure_future(in_thread(*make)), asyncio.ensure_future(stopped.wait())
    await asyncio.wait({made, ended}, return_when=asyncio.FIRST_COMPLETED)
    if not made.done():
        return
    source = made.result()
    print("%s shows %s" % (server.url, options.bag or options.tank), flush=True)
    try:
        await server.serve(source, stopped)
    finally:
        if not options.bag:
            import rospy

            source.stop()
            rospy.signal_shutdown("ended")


def main(arguments):
    options = read_arguments(arguments)
    check_packages()
    asyncio.run(serve(options))
