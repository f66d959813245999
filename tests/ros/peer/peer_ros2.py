"""A ROS 2 node controlled by control.py; for the interpreter of an environment with rclpy.

    python peer_ros2.py NAME
"""

import os
import struct
import sys
import threading
import time
from functools import cached_property

import rclpy
import ros2_messages
from control import Control, repeat, wait_until
from random_values import RandomValues
from rclpy.event_handler import SubscriptionEventCallbacks
from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor
from rclpy.node import Node
from rclpy.parameter import Parameter, parameter_value_to_python
from rclpy.parameter_client import AsyncParameterClient
from rclpy.qos import DurabilityPolicy, HistoryPolicy, QoSProfile, ReliabilityPolicy
from rclpy.serialization import deserialize_message, serialize_message


def quality(names, depth):
    """A QoS out of words: best_effort or reliable, transient_local or volatile; depth 0 keeps all."""
    words = set(names.split())
    unknown = words - {"reliable", "best_effort", "volatile", "transient_local"}
    if unknown:
        raise ValueError(f"unknown QoS {unknown}")
    return QoSProfile(
        history=HistoryPolicy.KEEP_LAST if depth else HistoryPolicy.KEEP_ALL,
        depth=depth,
        reliability=ReliabilityPolicy.BEST_EFFORT if "best_effort" in words else ReliabilityPolicy.RELIABLE,
        durability=DurabilityPolicy.TRANSIENT_LOCAL if "transient_local" in words else DurabilityPolicy.VOLATILE,
    )


class Peer:
    def __init__(self, name, control):
        self.name = name
        self.control = control
        self.lock = threading.Lock()
        self.publishers = {}
        self.subscriptions = {}
        # How many publishers the middleware has connected each with.
        self.matches = {}
        self.services = []
        self.clients = {}

    @cached_property
    def node(self):
        """Created when the first command needs it: reading and writing messages works without it."""
        rclpy.init()
        node = Node(self.name)
        executor = self.executor = SingleThreadedExecutor()
        executor.add_node(node)

        def spin():
            try:
                executor.spin()
            except ExternalShutdownException:
                pass

        self.spinning = threading.Thread(target=spin, daemon=True)
        self.spinning.start()
        return node

    def close(self):
        """Shuts down the node, so that others notice its end immediately."""
        if "node" in vars(self):
            self.executor.shutdown()
            self.spinning.join(5)
            self.node.destroy_node()
            rclpy.shutdown()

    def locked_node(self):
        with self.lock:
            return self.node

    def do_random(self, type, seed):
        """A message whose fields the seed determines."""
        message_type = ros2_messages.type_by_name(type)
        return serialize_message(ros2_messages.random_message(message_type, RandomValues(seed))).hex()

    def do_again(self, type, hex):
        """Reads a message and writes it again."""
        return serialize_message(deserialize_message(bytes.fromhex(hex), ros2_messages.type_by_name(type))).hex()

    def do_fields_alone(self, type, hex):
        data = bytes.fromhex(hex)
        message = deserialize_message(data, ros2_messages.type_by_name(type))
        return ros2_messages.fields_alone(message, data).hex()

    def do_decode(self, type, hex):
        return ros2_messages.to_plain(deserialize_message(bytes.fromhex(hex), ros2_messages.type_by_name(type)))

    def do_encode(self, type, fields):
        return serialize_message(ros2_messages.from_plain(ros2_messages.type_by_name(type), fields)).hex()

    def do_advertise(self, topic, type, qos="reliable", depth=10):
        """Creates a permanent publisher; `publish` creates one if there is none."""
        node = self.locked_node()
        with self.lock:
            if topic not in self.publishers:
                message_type = ros2_messages.type_by_name(type)
                self.publishers[topic] = node.create_publisher(message_type, topic, quality(qos, depth))
            return None

    def do_publish(
        self, topic, type, messages, rate=None, count=None, qos="reliable", depth=10, subscribers=1, timeout=10
    ):
        """Waits for subscribers and publishes; when each message was sent, in nanoseconds."""
        self.do_advertise(topic, type, qos, depth)
        publisher = self.publishers[topic]
        wait_until(lambda: publisher.get_subscription_count() >= subscribers, timeout, f"{subscribers} subscribers")
        payloads = [bytes.fromhex(message) for message in messages]
        return repeat(publisher.publish, payloads, rate, len(payloads) if count is None else count)

    def do_subscribe(self, subscription, topic, type, qos="reliable", depth=10):
        node = self.locked_node()
        message_type = ros2_messages.type_by_name(type)
        has_stamp = "std_msgs/Header" in list(message_type.get_fields_and_field_types().values())[:1]

        def take(raw):
            stamp = struct.unpack_from("<iI", raw, 4) if has_stamp else None
            self.control.message(subscription, raw, stamp)

        def matched(status):
            self.matches[subscription] = status.current_count

        events = SubscriptionEventCallbacks(matched=matched)
        made = node.create_subscription(
            message_type, topic, take, quality(qos, depth), raw=True, event_callbacks=events
        )
        self.subscriptions[subscription] = made

    def do_unsubscribe(self, subscription):
        self.node.destroy_subscription(self.subscriptions.pop(subscription))

    def do_wait_for_publishers(self, subscription, count=1, timeout=10):
        wait_until(lambda: self.matches.get(subscription, 0) >= count, timeout, f"{count} publishers")

    def do_call(self, service, type, hex, timeout=10):
        node = self.locked_node()
        service_type = ros2_messages.type_by_name(type)
        with self.lock:
            if service not in self.clients:
                self.clients[service] = node.create_client(service_type, service)
        client = self.clients[service]
        if not client.wait_for_service(timeout_sec=timeout):
            raise TimeoutError(f"no service {service} within {timeout} s")
        request = deserialize_message(bytes.fromhex(hex), service_type.Request)
        return serialize_message(result(client.call_async(request), timeout)).hex()

    def do_serve(self, service, type, hex):
        """A service that always returns the same response and reports every request."""
        service_type = ros2_messages.type_by_name(type)
        response = deserialize_message(bytes.fromhex(hex), service_type.Response)

        def answer(request, _):
            self.control.say({"event": "request", "service": service, "hex": serialize_message(request).hex()})
            return response

        self.services.append(self.locked_node().create_service(service_type, service, answer))

    def parameters_of(self, node, timeout):
        here = self.locked_node()
        with self.lock:
            if ("parameters", node) not in self.clients:
                self.clients["parameters", node] = AsyncParameterClient(here, node)
        client = self.clients["parameters", node]
        if not client.wait_for_services(timeout_sec=timeout):
            raise TimeoutError(f"{node} has no services for parameters within {timeout} s")
        return client

    def do_set_parameters(self, node, values, timeout=10):
        parameters = [Parameter(name, value=value).to_parameter_msg() for name, value in values.items()]
        answer = result(self.parameters_of(node, timeout).set_parameters(parameters), timeout)
        return [ros2_messages.to_plain(one) for one in answer.results]

    def do_get_parameters(self, node, names, timeout=10):
        answer = result(self.parameters_of(node, timeout).get_parameters(names), timeout)
        values = [parameter_value_to_python(value) for value in answer.values]
        return [list(value) if hasattr(value, "tolist") else value for value in values]

    def do_describe_parameters(self, node, names, timeout=10):
        answer = result(self.parameters_of(node, timeout).describe_parameters(names), timeout)
        return [ros2_messages.to_plain(one) for one in answer.descriptors]

    def do_list_parameters(self, node, timeout=10):
        return list(result(self.parameters_of(node, timeout).list_parameters(), timeout).result.names)

    def do_declare_parameters(self, values):
        for name, value in values.items():
            self.locked_node().declare_parameter(name, value)

    def do_nodes(self):
        names = self.locked_node().get_node_names_and_namespaces()
        return sorted(f"{space.rstrip('/')}/{name}" for name, space in names)

    def do_topics(self):
        return dict(self.locked_node().get_topic_names_and_types())

    def do_services(self):
        return dict(self.locked_node().get_service_names_and_types())

    def do_publishers(self, topic):
        return endpoints(self.locked_node().get_publishers_info_by_topic, topic)

    def do_subscribers(self, topic):
        return endpoints(self.locked_node().get_subscriptions_info_by_topic, topic)


def endpoints(look_up, topic):
    """Returns the endpoints of a topic. The node's name arrives later than the rest, and never for endpoints without a ROS node."""
    for _ in range(100):
        found = [endpoint(info) for info in look_up(topic)]
        if not any("UNKNOWN" in one["node"] for one in found):
            break
        time.sleep(0.05)
    return found


def endpoint(info):
    return {
        "node": f"{info.node_namespace.rstrip('/')}/{info.node_name}",
        "type": info.topic_type,
        "hash": str(info.topic_type_hash),
        "reliability": info.qos_profile.reliability.name.lower(),
        "durability": info.qos_profile.durability.name.lower(),
    }


def result(future, timeout):
    wait_until(future.done, timeout, "an answer")
    return future.result()


def main():
    control = Control()
    peer = Peer(sys.argv[1], control)
    control.say({"event": "ready"})
    control.serve(peer)
    peer.close()
    # Waiting threads are not joined.
    os._exit(0)


if __name__ == "__main__":
    main()
