"""Real ROS nodes in processes of their own, for tests: `Ros2Peer`, `Ros1Peer`, `CyclonePeer` and `Roscore`.

Each runs peer/peer_*.py with the Python interpreter of its ROS and sends it commands over pipes:

    with Ros2Peer("jazzy") as peer:
        subscription = peer.subscribe("/out", "vision_msgs/msg/Detection2DArray")
        image = peer.encode("sensor_msgs/msg/Image", {"height": 1, "width": 1, "data": [7]})
        peer.publish("/in", "sensor_msgs/msg/Image", [image])
        [message] = subscription.wait(1)
        detections = peer.decode("vision_msgs/msg/Detection2DArray", message.data)

`to=subscription` makes `publish` wait until a Subscription of another peer is connected. Messages are bytes: CDR with its header
for ROS 2, ROS 1's format for ROS 1.
"""

import itertools
import json
import os
import queue
import subprocess
import sys
import threading
from concurrent.futures import Future
from pathlib import Path

from patience import PATIENCE, wait_until
from roscore import Roscore  # noqa: F401
from subscription import Subscription

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[1]
TARGET = Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target"))
DEBIAN_PYTHON = "/usr/bin/python3"
ROS1_MESSAGES = Path(os.environ.get("OPENDR_ROS1_MESSAGES", TARGET / "ros1-messages"))
DISTRIBUTIONS = ["jazzy", "kilted"]

domains = itertools.count(1 + os.getpid() % 50)


def interpreter(distribution):
    """The Python that has rclpy of a distribution."""
    named = os.environ.get(f"OPENDR_ROS_{distribution.upper()}")
    return named or str(TARGET / f"ros-{distribution}-venv/bin/python")


def new_domain():
    """A ROS_DOMAIN_ID that no other test of this run has."""
    return next(domains) % 100


class PeerError(Exception):
    """An error of a peer."""


class Peer:
    """A node in a process of its own. `start(NAME, ...)` begins a command and gives a Future; `request` waits."""

    def __init__(self, program, environment):
        # What the wheels' start-up leaves in the environment is for one distribution.
        unwanted = ("_ROS_WHEELS_BOOTSTRAP_COMPLETE", "LD_LIBRARY_PATH", "PYTHONPATH")
        inherited = {name: value for name, value in os.environ.items() if name not in unwanted}
        self.process = subprocess.Popen(
            list(map(str, program)),
            env={**inherited, **environment},
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
        )
        self.numbers = itertools.count(1)
        self.lock = threading.Lock()
        self.pending = {}
        self.subscriptions = {}
        self.requests = queue.Queue()
        self.ready = threading.Event()
        threading.Thread(target=self._listen, daemon=True).start()
        if not self.ready.wait(PATIENCE) or self.process.poll() is not None:
            self.close()
            raise PeerError(f"{program} does not start")

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def _listen(self):
        for line in self.process.stdout:
            said = json.loads(line)
            event = said.get("event")
            if event == "ready":
                self.ready.set()
            elif event == "message":
                self.subscriptions[said["subscription"]].take(said)
            elif event == "request":
                self.requests.put((said["service"], bytes.fromhex(said["hex"])))
            else:
                future = self.pending.pop(said["id"])
                if "error" in said:
                    future.set_exception(PeerError(said["error"]))
                else:
                    future.set_result(said["result"])
        self.ready.set()
        for future in list(self.pending.values()):
            future.set_exception(PeerError("the peer has ended"))

    def start(self, do, **arguments):
        future = Future()
        number = next(self.numbers)
        self.pending[number] = future
        line = json.dumps({"id": number, "do": do, **arguments}) + "\n"
        with self.lock:
            self.process.stdin.write(line)
            self.process.stdin.flush()
        return future

    def request(self, do, timeout=PATIENCE, **arguments):
        if do in WAITING:
            arguments["timeout"] = timeout
        return self.start(do, **arguments).result(timeout + 10)

    def close(self):
        """Ends the process, by force when it does not."""
        try:
            self.request("exit", 5)
            self.process.wait(10)
        except Exception:
            self.process.kill()
            self.process.wait()
        for pipe in (self.process.stdin, self.process.stdout):
            try:
                pipe.close()
            except OSError:
                pass

    def random(self, type, seed):
        """A message with random values; the same seed, the same message."""
        return bytes.fromhex(self.request("random", type=type, seed=seed))

    def again(self, type, data):
        """The message, read and written by the peer."""
        return bytes.fromhex(self.request("again", type=type, hex=data.hex()))

    def decode(self, type, data):
        """A message as plain values: dicts, lists, numbers, texts; a stamp is {"sec", "nanosec"} in ROS 1 too."""
        return self.request("decode", type=type, hex=data.hex())

    def encode(self, type, fields):
        """Returns the bytes of a message with plain values; missing fields have their defaults."""
        return bytes.fromhex(self.request("encode", type=type, fields=fields))

    def advertise(self, topic, type, **options):
        """Makes the publisher; options as of `publish`."""
        self.request("advertise", topic=topic, type=type, **options)

    def publish(self, topic, type, messages, to=None, background=False, timeout=PATIENCE, **options):
        """Publishes messages in turn once `subscribers` (1) are there; when each was sent, in nanoseconds.

        That a subscriber is known here does not mean that it knows of this publisher and will have the first message:
        with `to`, a Subscription of another peer, both do.
        `rate` is messages a second (as fast as they go), `count` how many in all (each once); ROS 2: `qos` of words out
        of reliable, best_effort, transient_local, and `depth`; ROS 1: `latch`, `depth`. With `background`, a Future.
        """
        if to is not None:
            quality = {name: value for name, value in options.items() if name in ("qos", "depth", "latch")}
            self.advertise(topic, type, **quality)
            to.wait_for_publishers(timeout=timeout)
        payloads = [message.hex() for message in messages]
        arguments = dict(topic=topic, type=type, messages=payloads, timeout=timeout, **options)
        future = self.start("publish", **arguments)
        if background:
            return future
        duration = options.get("count", len(messages)) / (options.get("rate") or 1e9)
        return future.result(timeout + duration + 10)

    def subscribe(self, topic, type, **options):
        """A Subscription; options `qos` (ROS 2) and `depth`."""
        number = next(self.numbers)
        subscription = self.subscriptions[number] = Subscription(self, number)
        self.request("subscribe", subscription=number, topic=topic, type=type, **options)
        return subscription

    def call(self, service, type, data, timeout=PATIENCE):
        """The response's bytes to a request's."""
        return bytes.fromhex(self.request("call", timeout, service=service, type=type, hex=data.hex()))

    def serve(self, service, type, response):
        """Responds to every call with `response`; the requests are put into the queue `requests` as (service, bytes)."""
        self.request("serve", service=service, type=type, hex=response.hex())

    def set_parameters(self, node, values):
        """ROS 2: a list of {"successful", "reason"}. ROS 1: on the parameter server."""
        return self.request("set_parameters", node=node, values=values)

    def get_parameters(self, node, names):
        return self.request("get_parameters", node=node, names=names)

    def list_parameters(self, node):
        return self.request("list_parameters", node=node)

    def nodes(self):
        """Full names."""
        return self.request("nodes")

    def topics(self):
        """Types by topic."""
        return self.request("topics")

    def services(self):
        return self.request("services")

    def publishers(self, topic):
        """ROS 2: dicts of node, type, hash (RIHS01), reliability, durability. ROS 1: names of nodes."""
        return self.request("publishers", topic=topic)

    def subscribers(self, topic):
        return self.request("subscribers", topic=topic)

    def wait_for_node(self, name, timeout=PATIENCE):
        """Until the peer knows of a node by its full name."""
        wait_until(lambda: name in self.nodes(), timeout, f"node {name}")


# Commands that wait for others.
WAITING = {"call", "wait_for_publishers"}


class Ros2Peer(Peer):
    """rclpy of a distribution; `domain` is the ROS_DOMAIN_ID, `environment` what else it shall have."""

    def __init__(self, distribution, domain=0, name="peer", environment=None):
        self.domain = domain
        program = [interpreter(distribution), HERE / "peer/peer_ros2.py", name]
        super().__init__(program, {"ROS_DOMAIN_ID": str(domain), **(environment or {})})

    def fields_alone(self, type, data):
        """Returns rclpy's bytes of a message, with zeros between the fields and nothing after them (peer/ros2_messages.py).

        PeerError when that is not as long as rclpy's messages are.
        """
        return bytes.fromhex(self.request("fields_alone", type=type, hex=data.hex()))

    def declare_parameters(self, values):
        """Of the peer's own node."""
        self.request("declare_parameters", values=values)

    def describe_parameters(self, node, names):
        """Dicts with the fields of rcl_interfaces/msg/ParameterDescriptor."""
        return self.request("describe_parameters", node=node, names=names)


class Ros1Peer(Peer):
    """rospy; `master` is a Roscore, None for a peer that only reads and writes messages."""

    def __init__(self, master=None, name="peer", environment=None):
        known = {"PYTHONPATH": str(ROS1_MESSAGES)}
        known.update(master.environment if master else {})
        program = [DEBIAN_PYTHON, HERE / "peer/peer_ros1.py", name]
        super().__init__(program, {**known, **(environment or {})})

    def md5sum(self, type):
        return self.request("md5sum", type=type)

    def md5sum_of_text(self, type, text):
        """Returns the results of ROS 1's own tools for a whole definition."""
        return self.request("md5sum_of_text", type=type, text=text)


class CyclonePeer(Peer):
    """Eclipse Cyclone DDS with ROS 2's topics; publishes and subscribes and nothing else."""

    def __init__(self, definitions, domain=0):
        """`definitions` is a file with what the example message_types prints."""
        self.domain = domain
        program = [sys.executable, HERE / "peer/peer_cyclone.py", definitions]
        super().__init__(program, {"ROS_DOMAIN_ID": str(domain)})

    def random_big_endian(self, type, seed):
        """`random`'s message with the most significant bytes first."""
        return bytes.fromhex(self.request("random", type=type, seed=seed, big_endian=True))
