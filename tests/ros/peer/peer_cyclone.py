"""Eclipse Cyclone DDS on ROS 2's topics, controlled by control.py: a peer without ROS and Fast DDS.

    python peer_cyclone.py MESSAGE_TYPES

MESSAGE_TYPES is a file with what crates/messages/examples/message_types.rs prints: the types are made of it.
"""

import dataclasses
import json
import os
import re
import sys
import threading
import time
from types import new_class

from control import Control, repeat, wait_until
from cyclonedds.core import Policy, Qos
from cyclonedds.domain import DomainParticipant
from cyclonedds.idl import IdlStruct, types
from cyclonedds.idl._support import Endianness
from cyclonedds.idl.annotations import final
from cyclonedds.pub import DataWriter
from cyclonedds.sub import DataReader
from cyclonedds.topic import Topic
from cyclonedds.util import duration
from random_values import INTEGERS, RandomValues

FIELD = re.compile(r"^(?P<kind>[\w/]+)(<=\d+)?(\[(?P<count>(<=)?\d*)\])?\s+(?P<name>\w+)(?!\s*=)\s*(\S.*)?$")
FLOATS = {"float32": types.float32, "float64": types.float64}
KINDS = {"bool": bool, "string": str, "byte": types.uint8, "char": types.uint8, **FLOATS}
KINDS.update({name: getattr(types, name) for name in INTEGERS})


class MessageTypes:
    """Cyclone's types by ROS 2's names."""

    def __init__(self, file):
        with open(file) as lines:
            entries = [json.loads(line) for line in lines]
        # Header of an included definition.
        self.texts = {
            entry["message"].replace("/msg/", "/"): entry["definition"].split("=" * 80)[0]
            for entry in entries
            if "message" in entry
        }
        self.made = {}

    def fields(self, name):
        """(name, type of an element, None or the count, which is "" where it is free)."""
        for line in self.texts[name].splitlines():
            match = FIELD.match(line)
            if match and "=" not in line.split(match["name"], 1)[1][:2]:
                yield match["name"], match["kind"], match["count"]

    def __getitem__(self, name):
        name = name.replace("/msg/", "/")
        if name not in self.made:
            self.made[name] = self.make(name)
        return self.made[name]

    def make(self, name):
        fields = {}
        for field, kind, count in self.fields(name):
            item = KINDS[kind] if kind in KINDS else self[kind]
            if count is None:
                fields[field] = item
            elif count.isdigit():
                fields[field] = types.array[item, int(count)]
            else:
                fields[field] = types.sequence[item]
        if not fields:
            fields["structure_needs_at_least_one_member"] = types.uint8
        package, short = name.split("/")
        named = {"typename": f"{package}::msg::dds_::{short}_"}
        body = {"__annotations__": fields, "__module__": __name__}
        return dataclasses.dataclass(final(new_class(short, (IdlStruct,), named, lambda space: space.update(body))))

    def random(self, name, values, depth=0):
        name = name.replace("/msg/", "/")
        content = {}
        for field, kind, count in self.fields(name):
            if count is None:
                content[field] = self.random_item(kind, values, depth)
            else:
                length = int(count) if count.isdigit() else values.length(depth, kind in KINDS and kind != "string")
                content[field] = [self.random_item(kind, values, depth + 1) for _ in range(length)]
        return self[name](**content) if content else self[name](values.integer("uint8"))

    def random_item(self, kind, values, depth):
        if kind in INTEGERS:
            return values.integer(kind)
        if kind not in KINDS:
            return self.random(kind, values, depth + 1)
        return {
            "bool": values.boolean,
            "string": values.text,
            "float32": values.single,
            "float64": values.double,
            "byte": lambda: values.integer("uint8"),
            "char": lambda: values.integer("uint8"),
        }[kind]()


def quality(names, depth):
    words = set(names.split())
    unknown = words - {"reliable", "best_effort", "volatile", "transient_local"}
    if unknown:
        raise ValueError(f"unknown QoS {unknown}")
    reliable = Policy.Reliability.Reliable(duration(seconds=10))
    return Qos(
        Policy.Reliability.BestEffort if "best_effort" in words else reliable,
        Policy.History.KeepLast(depth) if depth else Policy.History.KeepAll,
        Policy.Durability.TransientLocal if "transient_local" in words else Policy.Durability.Volatile,
    )


class Peer:
    def __init__(self, message_types, control):
        self.types = message_types
        self.control = control
        self.lock = threading.Lock()
        self.domain = None
        self.writers = {}
        self.readers = {}

    def topic(self, topic, type):
        if self.domain is None:
            self.domain = DomainParticipant(int(os.environ.get("ROS_DOMAIN_ID", "0")))
        return Topic(self.domain, f"rt{topic}", self.types[type])

    def do_random(self, type, seed, big_endian=False):
        """A message whose fields the seed determines."""
        order = Endianness.Big if big_endian else Endianness.Little
        return self.types.random(type, RandomValues(seed)).serialize(endianness=order).hex()

    def do_again(self, type, hex):
        """Reads a message and writes it again."""
        return self.types[type].deserialize(bytes.fromhex(hex)).serialize().hex()

    def do_advertise(self, topic, type, qos="reliable", depth=10):
        with self.lock:
            if topic not in self.writers:
                known = self.topic(topic, type)
                self.writers[topic] = DataWriter(self.domain, known, qos=quality(qos, depth))

    def do_publish(
        self, topic, type, messages, rate=None, count=None, qos="reliable", depth=10, subscribers=1, timeout=10
    ):
        """Waits for subscribers and publishes; when each message was sent, in nanoseconds."""
        self.do_advertise(topic, type, qos, depth)
        writer = self.writers[topic]
        there = lambda: len(writer.get_matched_subscriptions()) >= subscribers  # noqa: E731
        wait_until(there, timeout, f"{subscribers} subscribers")
        payloads = [self.types[type].deserialize(bytes.fromhex(message)) for message in messages]
        return repeat(writer.write, payloads, rate, len(payloads) if count is None else count)

    def do_subscribe(self, subscription, topic, type, qos="reliable", depth=10):
        with self.lock:
            known = self.topic(topic, type)
            reader = self.readers[subscription] = DataReader(self.domain, known, qos=quality(qos, depth))

        def read():
            while subscription in self.readers:
                for message in reader.take(10):
                    if isinstance(message, self.types[type]):
                        header = getattr(message, "header", None)
                        stamp = header and (header.stamp.sec, header.stamp.nanosec)
                        self.control.message(subscription, message.serialize(), stamp)
                time.sleep(0.001)

        threading.Thread(target=read, daemon=True).start()

    def do_unsubscribe(self, subscription):
        del self.readers[subscription]

    def do_wait_for_publishers(self, subscription, count=1, timeout=10):
        reader = self.readers[subscription]
        wait_until(lambda: len(reader.get_matched_publications()) >= count, timeout, f"{count} publishers")


def main():
    control = Control()
    peer = Peer(MessageTypes(sys.argv[1]), control)
    control.say({"event": "ready"})
    control.serve(peer)


if __name__ == "__main__":
    main()
