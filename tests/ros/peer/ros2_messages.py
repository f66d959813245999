"""ROS 2's messages by name: random ones, and as plain values."""

import importlib
import re

from random_values import INTEGERS

ARRAY = re.compile(r"^sequence<(?P<item>.+?)(, (?P<most>\d+))?>$|^(?P<fixed>.+)\[(?P<count>\d+)\]$")


def type_by_name(name):
    """The class of `std_msgs/msg/String`, `std_srvs/srv/Trigger` or `std_srvs/srv/Trigger_Request`."""
    package, kind, short = name.split("/")
    return getattr(importlib.import_module(f"{package}.{kind}"), short)


def fields_of(message_type):
    """Names and types; without the filling of messages that have none."""
    return message_type.get_fields_and_field_types().items()


def nested(kind):
    package, short = kind.split("/")
    return type_by_name(f"{package}/msg/{short}")


def random_message(message_type, values, depth=0):
    message = message_type()
    for name, kind in fields_of(message_type):
        setattr(message, name, random_field(kind, values, depth))
    if message_type.__module__.startswith("builtin_interfaces."):
        # Types that ROS 1 has too.
        message.nanosec %= 10**9
        if message_type.__name__ == "Time":
            message.sec &= 2**31 - 1
    return message


def random_field(kind, values, depth):
    array = ARRAY.match(kind)
    if array:
        item = array["item"] or array["fixed"]
        count = int(array["count"]) if array["count"] else values.length(depth, "/" not in item and item != "string")
        count = min(count, int(array["most"] or count))
        return [random_field(item, values, depth + 1) for _ in range(count)]
    if "/" in kind:
        return random_message(nested(kind), values, depth + 1)
    if kind in INTEGERS:
        return values.integer(kind)
    return {
        "boolean": values.boolean,
        "double": values.double,
        "float": values.single,
        "string": values.text,
        "octet": lambda: bytes([values.integer("uint8")]),
    }[kind]()


def to_plain(value):
    """A message as dict, an array as list."""
    if hasattr(value, "get_fields_and_field_types"):
        return {name: to_plain(getattr(value, name)) for name, _ in fields_of(value)}
    if isinstance(value, (bytes, bytearray)):
        return value[0]
    if isinstance(value, (str, int, float)):
        return value
    if hasattr(value, "tolist"):
        return value.tolist()
    return [to_plain(item) for item in value]


def from_plain(message_type, plain):
    """A message; fields that are not named keep their defaults."""
    message = message_type()
    kinds = dict(fields_of(message_type))
    for name, value in plain.items():
        setattr(message, name, field_from_plain(kinds[name], value))
    return message


def field_from_plain(kind, value):
    array = ARRAY.match(kind)
    if array:
        return [field_from_plain(array["item"] or array["fixed"], item) for item in value]
    if "/" in kind:
        return from_plain(nested(kind), value)
    if kind == "octet":
        return bytes([value % 256])
    return float(value) if kind in ("double", "float") else value


SIZES = {"boolean": 1, "octet": 1, "int8": 1, "uint8": 1, "int16": 2, "uint16": 2, "int32": 4, "uint32": 4}
SIZES.update({"float": 4, "int64": 8, "uint64": 8, "double": 8})


class Layout:
    """Where the fields of a message are in CDR (DDSI-RTPS 2.5, section 10), and what rclpy's bytes have besides.

    Fast CDR leaves in the gaps between fields what its buffer had there before. After the last field rclpy has bytes
    too: it gives out as many as it had reserved, which is a multiple of four for messages of a fixed size, and where an
    empty array of 8 byte numbers is, as many as if there were a first.
    """

    def __init__(self, message):
        self.end = 0
        self.reserved = 0
        self.gaps = []
        self.is_fixed = True
        self.message(message)
        if self.is_fixed:
            self.reserved += -self.reserved % 4

    def place(self, size, count=1):
        if count:
            start = self.end + -self.end % size
            # After the header of 4 bytes.
            self.gaps += range(4 + self.end, 4 + start)
            self.end = start + size * count
        self.reserved += -self.reserved % size + size * count

    def message(self, message):
        if not fields_of(message):
            # The byte of a message without fields.
            self.place(1)
        for name, kind in fields_of(message):
            self.field(kind, getattr(message, name))

    def field(self, kind, value):
        array = ARRAY.match(kind)
        if array:
            item = array["item"] or array["fixed"]
            if array["item"]:
                self.is_fixed = False
                self.place(4)
            if item in SIZES:
                self.place(SIZES[item], len(value))
            else:
                for one in value:
                    self.field(item, one)
        elif kind in SIZES:
            self.place(SIZES[kind])
        elif kind == "string":
            self.is_fixed = False
            self.place(4)
            self.place(1, len(value.encode()) + 1)
        else:
            self.message(value)


def fields_alone(message, data):
    """The CDR that rclpy wrote of the message, with zeros between its fields and nothing after them.

    ValueError when the length is not what rclpy reserves.
    """
    layout = Layout(message)
    if len(data) != 4 + layout.reserved:
        raise ValueError(f"{len(data)} bytes, where rclpy reserves {4 + layout.reserved}")
    fields = bytearray(data[: 4 + layout.end])
    for gap in layout.gaps:
        fields[gap] = 0
    return bytes(fields)
