"""Listens to topics of a live node for a test."""

import threading
import time

import rospy


class Ear:
    """Everything that was heard, by topic, and the wall time at which it came."""

    def __init__(self, topics, waited_for=("/wavetank/probes", "/wavetank/gauges")):
        self.topics = topics
        self.lock = threading.Lock()
        self.heard = {topic: [] for topic in topics}
        self.came = {topic: [] for topic in topics}
        # The node begins when its lists are listened to: they come last, once the topics of single instruments are connected.
        self.subscribers = [self.subscribe(topic) for topic in topics if topic not in waited_for]
        kinds = ("probes", "gauges", "velocities", "sections", "bodies", "joint_states")
        single = [subscriber for subscriber in self.subscribers if any(kind in subscriber.name.split("/") for kind in kinds)]
        if waited_for:
            self.wait(lambda: all(subscriber.get_num_connections() > 0 for subscriber in single), "a connection to each instrument")
        self.subscribers += [self.subscribe(topic) for topic in waited_for]

    def subscribe(self, topic):
        return rospy.Subscriber(topic, self.topics[topic], self.hear, topic, queue_size=10000, tcp_nodelay=True)

    def subscribe_again(self, topic):
        """With a connection of its own: subscribers of one process share theirs."""
        subscriber = next(s for s in self.subscribers if s.name == topic)
        self.subscribers.remove(subscriber)
        subscriber.unregister()
        self.subscribers.append(self.subscribe(topic))

    def hear(self, message, topic):
        with self.lock:
            self.came[topic].append(time.time())
            self.heard[topic].append(message)

    def all(self, topic):
        with self.lock:
            return list(self.heard[topic])

    def last(self, topic):
        with self.lock:
            return self.heard[topic][-1]

    def times(self, topic):
        with self.lock:
            return list(self.came[topic])

    def stamps(self, topic):
        return [message.header.stamp.to_nsec() for message in self.all(topic)]

    @staticmethod
    def wait(condition, what, seconds=60):
        end = time.time() + seconds  # of wall time: the simulated may stand still
        while time.time() < end:
            if condition():
                return
            time.sleep(0.02)
        raise AssertionError("never happened: " + what)
