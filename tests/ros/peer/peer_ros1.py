"""A ROS 1 node controlled by control.py; for Debian's Python, with a master.

    /usr/bin/python3 peer_ros1.py NAME
"""

import os
import struct
import sys
import threading
from functools import cached_property

import genpy.dynamic
import ros1_messages
import rosgraph
import rospy
from control import Control, repeat, wait_until
from random_values import RandomValues


def raw_type(message_type):
    """Bytes that are published and received as they are, under the type's name and sum."""
    known = {"_type": message_type._type, "_md5sum": message_type._md5sum, "_full_text": message_type._full_text}
    return type("Raw", (rospy.AnyMsg,), known)


class Peer:
    def __init__(self, name, control):
        self.name = name
        self.control = control
        self.lock = threading.Lock()
        self.publishers = {}
        self.subscriptions = {}
        self.services = []

    @cached_property
    def started(self):
        rospy.init_node(self.name, disable_signals=True)
        return True

    def start(self):
        with self.lock:
            return self.started

    @property
    def master(self):
        return rosgraph.Master(f"/{self.name}")

    def do_random(self, type, seed):
        """A message whose fields the seed determines."""
        message_type = ros1_messages.type_by_name(type)
        return ros1_messages.to_bytes(ros1_messages.random_message(message_type, RandomValues(seed))).hex()

    def do_again(self, type, hex):
        """Reads a message and writes it again."""
        message = ros1_messages.from_bytes(ros1_messages.type_by_name(type), bytes.fromhex(hex))
        return ros1_messages.to_bytes(message).hex()

    def do_decode(self, type, hex):
        message_type = ros1_messages.type_by_name(type)
        return ros1_messages.to_plain(ros1_messages.from_bytes(message_type, bytes.fromhex(hex)))

    def do_encode(self, type, fields):
        return ros1_messages.to_bytes(ros1_messages.from_plain(ros1_messages.type_by_name(type), fields)).hex()

    def do_md5sum(self, type):
        return ros1_messages.type_by_name(type)._md5sum

    def do_md5sum_of_text(self, type, text):
        """The sum of the type as a recording's or a connection's text defines it."""
        return genpy.dynamic.generate_dynamic(type, text)[type]._md5sum

    def do_advertise(self, topic, type, latch=False, depth=10):
        """Creates a permanent publisher; `publish` creates one if there is none."""
        self.start()
        with self.lock:
            if topic not in self.publishers:
                known = raw_type(ros1_messages.type_by_name(type))
                self.publishers[topic] = known, rospy.Publisher(topic, known, latch=latch, queue_size=depth)

    def do_publish(
        self, topic, type, messages, rate=None, count=None, latch=False, depth=10, subscribers=1, timeout=10
    ):
        """Waits for subscribers and publishes; when each message was sent, in nanoseconds."""
        self.do_advertise(topic, type, latch, depth)
        known, publisher = self.publishers[topic]
        wait_until(lambda: publisher.get_num_connections() >= subscribers, timeout, f"{subscribers} subscribers")
        payloads = []
        for message in messages:
            payloads.append(known())
            payloads[-1]._buff = bytes.fromhex(message)
        return repeat(publisher.publish, payloads, rate, len(payloads) if count is None else count)

    def do_subscribe(self, subscription, topic, type, depth=10):
        self.start()
        message_type = ros1_messages.type_by_name(type)
        has_stamp = list(message_type._slot_types[:1]) == ["std_msgs/Header"]

        def take(message):
            stamp = struct.unpack_from("<II", message._buff, 4) if has_stamp else None
            self.control.message(subscription, message._buff, stamp)

        made = rospy.Subscriber(topic, raw_type(message_type), take, queue_size=depth, buff_size=1 << 24)
        self.subscriptions[subscription] = made

    def do_unsubscribe(self, subscription):
        self.subscriptions.pop(subscription).unregister()

    def do_wait_for_publishers(self, subscription, count=1, timeout=10):
        made = self.subscriptions[subscription]
        wait_until(lambda: made.get_num_connections() >= count, timeout, f"{count} publishers")

    def do_call(self, service, type, hex, timeout=10):
        self.start()
        service_type = ros1_messages.type_by_name(type)
        rospy.wait_for_service(service, timeout)
        request = ros1_messages.from_bytes(service_type._request_class, bytes.fromhex(hex))
        return ros1_messages.to_bytes(rospy.ServiceProxy(service, service_type).call(request)).hex()

    def do_serve(self, service, type, hex):
        """A service that always returns the same response and reports every request."""
        self.start()
        service_type = ros1_messages.type_by_name(type)
        response = ros1_messages.from_bytes(service_type._response_class, bytes.fromhex(hex))

        def answer(request):
            known = ros1_messages.to_bytes(request).hex()
            self.control.say({"event": "request", "service": service, "hex": known})
            return response

        self.services.append(rospy.Service(service, service_type, answer))

    def do_set_parameters(self, node, values):
        """On the parameter server, under the node's name."""
        for name, value in values.items():
            rospy.set_param(f"{node}/{name}", value)

    def do_get_parameters(self, node, names):
        return [rospy.get_param(f"{node}/{name}", None) for name in names]

    def do_list_parameters(self, node):
        prefix = node.rstrip("/") + "/"
        return [name[len(prefix) :] for name in rospy.get_param_names() if name.startswith(prefix)]

    def do_nodes(self):
        sides = self.master.getSystemState()
        return sorted({node for side in sides for _, nodes in side for node in nodes})

    def do_topics(self):
        return {name: [kind] for name, kind in self.master.getTopicTypes()}

    def do_services(self):
        return [name for name, _ in self.master.getSystemState()[2]]

    def do_publishers(self, topic):
        return dict(self.master.getSystemState()[0]).get(topic, [])

    def do_subscribers(self, topic):
        return dict(self.master.getSystemState()[1]).get(topic, [])


def main():
    control = Control()
    peer = Peer(sys.argv[1], control)
    control.say({"event": "ready"})
    control.serve(peer)
    if "started" in vars(peer):
        rospy.signal_shutdown("requested")
    # Waiting threads are not joined.
    os._exit(0)


if __name__ == "__main__":
    main()
