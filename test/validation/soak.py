#!/usr/bin/env python3
"""A live node among clients that come, go, stall and lie: usage: soak.py WAVETANK_NODE FOLDER SECONDS [--behaviour]

A ROS master and a node of their own. While they run: a hundred calls of services a second, half of them nonsense; a thousand wrenches a second that are
not numbers; a subscriber of the point clouds and one of the probes that never read; others that come and go, some in the middle of a message; connections
that say nothing, half of a header, or what is no header. The clients rest every other ten seconds, so that steps with them and without are counted in the
same minutes. Afterwards: the node ends well; no sample is missing in its own bag; no stamp was before the one before; its memory has stayed within 2 %
after the first third; and it made as many steps a second with clients as without, within 5 %, which is judged only where other programs left it the
processor. --behaviour: neither memory nor steps are judged, as of a short run or of a node that a sanitizer watches."""

import multiprocessing
import os
import random
import shutil
import signal
import socket
import struct
import subprocess
import sys
import time
import xmlrpc.client

HERE = os.path.dirname(os.path.abspath(__file__))
CASE = os.path.join(os.path.dirname(HERE), "node", "floating_box.yaml")
NAME = "/soaked"
RATE = 100  # Hz of simulated time, of the samples
WINDOW = 10.0  # s that clients work, and that they rest
MOST_GROWTH, MOST_LOSS = 0.02, 0.05
MOST_OF_OTHERS = 0.05  # of the processor's time, that other programs may have had where steps are judged
SAMPLED = ["probes", "gauges", "bodies/box/wrench", "bodies/box/odom", "bodies/box/imu", "velocities/V1", "joint_states"]


def free_port():
    with socket.socket() as probe:
        probe.bind(("localhost", 0))
        return probe.getsockname()[1]


def field(text):
    return struct.pack("<I", len(text)) + text.encode()


def header(**fields):
    body = b"".join(field("%s=%s" % pair) for pair in fields.items())
    return struct.pack("<I", len(body)) + body


# ---------------------------------------------------------------- what the clients' process does


class Raw:
    """Connections without rospy, which would behave itself."""

    def __init__(self, node_uri):
        self.node = xmlrpc.client.ServerProxy(node_uri)
        self.held = []

    def connect(self, topic):
        code, _, protocol = self.node.requestTopic("/raw", NAME + "/" + topic, [["TCPROS"]])
        if code != 1:
            raise OSError("no %s" % topic)
        connection = socket.socket()
        connection.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)  # so that what is not read stays with the node
        connection.settimeout(5)
        connection.connect((protocol[1], protocol[2]))
        return connection

    def subscribe(self, topic):
        connection = self.connect(topic)
        connection.sendall(header(callerid="/raw", topic=NAME + "/" + topic, md5sum="*", type="*", tcp_nodelay="1"))
        return connection

    def hold(self, connection, most=40):
        self.held.append(connection)
        if len(self.held) > most:
            self.held.pop(0).close()

    def come_and_go(self, chance):
        connection = self.subscribe(chance.choice(["probes", "particles", "bodies/box/wrench"]))
        connection.settimeout(0.2)
        try:
            connection.recv(chance.randint(1, 20000))
        except socket.timeout:
            pass
        if chance.random() < 0.5:  # in the middle of a message, without a farewell
            connection.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))
        connection.close()

    def lie(self, chance):
        connection = self.connect("probes")
        connection.sendall(
            chance.choice(
                [
                    b"",
                    b"\xff\xff\xff\xff",
                    struct.pack("<I", 100) + b"callerid",
                    header(callerid="/raw", topic=NAME + "/probes", md5sum="0" * 32, type="std_msgs/String"),
                    header(callerid="/raw", topic="/none", md5sum="*", type="*"),
                    header(nothing="known"),
                    b"GET / HTTP/1.1\r\n\r\n",
                ]
            )
        )
        self.hold(connection)

    def stall_a_service(self, uri):
        host, port = uri[len("rosrpc://") :].rsplit(":", 1)
        connection = socket.create_connection((host, int(port)), 5)
        connection.sendall(header(callerid="/raw", service=NAME + "/pause", md5sum="*"))
        connection.sendall(struct.pack("<I", 1)[: random.randint(0, 4)])  # a request that never ends
        self.hold(connection)


def clients(working, ending, counts, seed):
    """counts: of calls, of calls that failed, of wrenches, of connections."""
    working.wait()
    os.nice(19)  # they are to disturb the node by what they ask of it, not by taking its processor
    import rosgraph
    import rospy
    from geometry_msgs.msg import WrenchStamped
    from std_srvs.srv import SetBool, Trigger
    from wavetank.srv import Advance

    rospy.init_node("clients", disable_signals=True)
    chance = random.Random(seed)
    raw = Raw(rosgraph.Master("/clients").lookupNode(NAME))
    never_read = [raw.subscribe("particles"), raw.subscribe("probes")]
    pause_uri = rosgraph.Master("/clients").lookupService(NAME + "/pause")
    wrenches = rospy.Publisher(NAME + "/bodies/box/external_wrench", WrenchStamped, queue_size=10)
    nonsense = WrenchStamped()
    nonsense.wrench.force.z = float("nan")
    types = {"pause": SetBool, "advance": Advance, "step": Trigger, "save": Trigger}
    services = {name: rospy.ServiceProxy(NAME + "/" + name, kind, persistent=True) for name, kind in types.items()}
    calls = [("pause", False), ("advance", float("nan")), ("pause", False), ("advance", -1.0), ("pause", False), ("step",)]
    call_due = wrench_due = visit_due = save_due = time.time()
    while not ending.is_set():
        now = time.time()
        if not working.is_set():
            time.sleep(0.05)
            call_due = wrench_due = visit_due = time.time()
            continue
        while wrench_due <= now:
            wrenches.publish(nonsense)
            counts[2] += 1
            wrench_due = max(wrench_due + 0.001, now - 0.05)
        if call_due <= now:
            call_due = max(call_due + 0.01, now - 0.1)
            name, *arguments = ("save",) if save_due <= now else calls[counts[0] % len(calls)]
            if name == "save":
                save_due = now + 30
            try:
                services[name](*arguments)
            except rospy.ServiceException:
                counts[1] += 1
                services[name] = rospy.ServiceProxy(NAME + "/" + name, types[name], persistent=True)
            counts[0] += 1
        if visit_due <= now:
            visit_due = now + 0.1
            try:
                chance.choice([lambda: raw.come_and_go(chance), lambda: raw.lie(chance), lambda: raw.stall_a_service(pause_uri)])()
                counts[3] += 1
            except OSError:
                pass
        time.sleep(max(0.0, min(wrench_due, call_due, visit_due) - time.time()))
    for connection in never_read:
        connection.close()


# ---------------------------------------------------------------- what looks on


def memory_of(process):
    """MiB of it that are in memory."""
    with open("/proc/%d/status" % process) as file:
        return next(int(line.split()[1]) for line in file if line.startswith("VmRSS")) / 1024.0


def processor_time():
    """Seconds that all processors have worked and rested, and that this process and those that it has seen end have worked."""
    with open("/proc/stat") as file:
        user, nice, system, idle, waiting, *rest = [int(word) / os.sysconf("SC_CLK_TCK") for word in file.readline().split()[1:]]
    return user + nice + system + sum(rest[:3]), idle + waiting, sum(os.times()[:4])


class Soak:
    def __init__(self, program, folder, seconds):
        self.program, self.folder, self.seconds = program, folder, seconds
        self.stamps, self.backwards, self.step = {}, [], None
        self.rates = {True: [], False: []}
        self.memory = []
        self.started = []

    def start(self, arguments, **options):
        process = subprocess.Popen(arguments, cwd=self.folder, stdout=subprocess.DEVNULL, **options)
        self.started.append(process)
        return process

    def hear(self, message, topic):
        stamp = message.header.stamp.to_nsec()
        if stamp < self.stamps.get(topic, 0):
            self.backwards.append("%s: %d after %d" % (topic, stamp, self.stamps[topic]))
        self.stamps[topic] = stamp

    def hear_status(self, message):
        self.hear(message, "status")
        self.step = (time.time(), message.step, message.failure)

    def run(self):
        # Before anything of ROS is here: rospy is one node a process, its threads are not to be forked, and importing wavetank changes where it is looked for.
        apart = multiprocessing.get_context("spawn")
        working, ending, counts = apart.Event(), apart.Event(), apart.Array("l", 4)
        others = apart.Process(target=clients, args=(working, ending, counts, 1), daemon=True)
        others.start()
        import rosgraph
        import rospy
        from nav_msgs.msg import Odometry
        from wavetank.msg import ProbeArray, SolverStatus

        self.start([sys.executable, shutil.which("rosmaster"), "--core", "-p", os.environ["ROS_MASTER_URI"].rsplit(":", 1)[1]])
        master = rosgraph.Master("/soak")
        self.wait(master.is_online, "the master")
        rates = {"rate": RATE, "pose_rate": RATE, "flow_rate": RATE, "imu_rate": RATE}
        for key, value in {"case_file": CASE, "duration": 1e9, "instruments": rates, "bag": os.path.join(self.folder, "own.bag")}.items():
            master.setParam(NAME + "/" + key, value)
        master.setParam(NAME + "/snapshot_directory", self.folder)
        with open(os.path.join(self.folder, "node.log"), "w") as log:
            node = self.start([self.program, "__name:=" + NAME[1:]], stderr=log)
        rospy.init_node("soak", disable_signals=True)
        rospy.Subscriber(NAME + "/probes", ProbeArray, self.hear, "probes")
        rospy.Subscriber(NAME + "/bodies/box/odom", Odometry, self.hear, "odom")
        rospy.Subscriber(NAME + "/status", SolverStatus, self.hear_status)
        self.wait(lambda: self.step and self.step[1] > 10, "the first steps", 240)
        begin = time.time()
        while time.time() < begin + self.seconds and node.poll() is None:
            for work in (True, False):
                (working.set if work else working.clear)()
                self.look(node, work)
        ending.set()
        others.join(10)
        if others.is_alive():
            others.terminate()
        node.poll() is None and node.send_signal(signal.SIGINT)
        code = node.wait(60)
        rospy.signal_shutdown("done")
        return code, list(counts)

    def look(self, node, work):
        time.sleep(1.0)
        first, begin = self.step, time.time()
        while time.time() < begin + min(WINDOW, self.seconds / 4) and node.poll() is None:
            time.sleep(0.5)
            if node.poll() is None:
                self.memory.append(memory_of(node.pid))
        if self.step[0] > first[0]:
            self.rates[work].append((self.step[1] - first[1]) / (self.step[0] - first[0]))

    def wait(self, what, name, seconds=30):
        end = time.time() + seconds
        while not what():
            if time.time() > end:
                raise SystemExit("soak: %s did not come in %g s" % (name, seconds))
            time.sleep(0.1)

    def end(self):
        for process in self.started:
            if process.poll() is None:
                process.kill()
            process.wait()


def missing_samples(path):
    """What is wrong with the node's own bag, in sentences; and the seconds and messages that it holds."""
    import rosbag

    wrong, last, count = [], 0, 0
    if not os.path.exists(path):
        return ["the node left no bag"], 0, 0
    topics = {NAME + "/" + topic: [] for topic in SAMPLED}
    with rosbag.Bag(path) as bag:
        for topic, message, _ in bag.read_messages(topics=list(topics)):
            topics[topic].append(message.header.stamp.to_nsec())
    for topic, stamps in topics.items():
        count += len(stamps)
        last = max(last, stamps[-1] if stamps else 0)
        if stamps != [k * (10**9 // RATE) for k in range(len(stamps))]:
            wrong.append("%s in the bag has gaps, or is out of order" % topic)
    if len({len(stamps) for stamps in topics.values()}) != 1:
        wrong.append("topics of the bag differ in length: %s" % {topic: len(stamps) for topic, stamps in topics.items()})
    return wrong, 1e-9 * last, count


def median(values):
    return sorted(values)[len(values) // 2] if values else float("nan")


def main():
    judged = "--behaviour" not in sys.argv
    program, folder, seconds = [word for word in sys.argv[1:] if word != "--behaviour"]
    shutil.rmtree(folder, ignore_errors=True)
    os.makedirs(folder)
    program, folder = os.path.abspath(program), os.path.abspath(folder)
    os.environ.update(ROS_MASTER_URI="http://localhost:%d" % free_port(), ROS_HOSTNAME="localhost", ROS_LOG_DIR=folder)
    soak = Soak(program, folder, float(seconds))
    before = processor_time()
    try:
        code, (calls, failed_calls, wrenches, visits) = soak.run()
    finally:
        soak.end()
    worked, rested, own = [now - then for now, then in zip(processor_time(), before)]
    by_others = max(0.0, worked - own) / (worked + rested)
    wrong, simulated, samples = missing_samples(os.path.join(folder, "own.bag"))
    if code != 0:
        wrong.append("the node ended with code %d: see node.log" % code)
    if soak.step[2]:
        wrong.append("the solver has failed: " + soak.step[2])
    if not (calls and wrenches and visits):
        wrong.append("clients did nothing of a kind: see below")
    if failed_calls:
        wrong.append("%d calls of services had no answer" % failed_calls)
    wrong += soak.backwards[:5]
    warm = max(1, len(soak.memory) // 3)
    growth = max(soak.memory[warm:]) / soak.memory[warm] - 1
    with_clients, without = median(soak.rates[True]), median(soak.rates[False])
    loss = 1 - with_clients / without
    if judged and growth > MOST_GROWTH:
        wrong.append("memory grew by %.1f %%" % (100 * growth))
    if judged and by_others <= MOST_OF_OTHERS and loss > MOST_LOSS:
        wrong.append("clients cost %.1f %% of the steps" % (100 * loss))
    active = soak.seconds / 2  # s, about, that clients worked
    print("wall time           %.0f s, simulated %.1f s" % (soak.seconds, simulated))
    print("calls of services   %d, %.0f a second, %d of them without an answer" % (calls, calls / active, failed_calls))
    print("wrenches            %d that are not numbers, %.0f a second" % (wrenches, wrenches / active))
    print("connections         %d that stalled, lied or went" % visits)
    print("memory              %.1f MiB after a third, at most %.1f MiB later: %+.2f %%" % (soak.memory[warm], max(soak.memory[warm:]), 100 * growth))
    print("steps a second      %.1f with clients, %.1f without: %+.2f %%" % (with_clients, without, -100 * loss))
    print("other programs      took %.0f %% of the processors%s" % (100 * by_others, "" if by_others <= MOST_OF_OTHERS else ": steps are not judged"))
    print("samples in the bag  %d of %d topics" % (samples, len(SAMPLED)))
    print("stamps              %s" % ("in order" if not soak.backwards else "%d backwards" % len(soak.backwards)))
    for sentence in wrong:
        print("WRONG: " + sentence)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
