"""ROS 1's messages by name: random ones, and as plain values."""

import re
from io import BytesIO

import genpy
import roslib.message
from random_values import INTEGERS

ARRAY = re.compile(r"^(?P<item>.+?)\[(?P<count>\d*)\]$")


def type_by_name(name):
    """The class of `std_msgs/String`, `std_srvs/Trigger` or `std_srvs/TriggerRequest`."""
    found = roslib.message.get_message_class(name) or roslib.message.get_service_class(name)
    if found is None:
        service = re.sub(r"(Request|Response)$", "", name)
        found = roslib.message.get_service_class(service) if service != name else None
        found = found and getattr(found, "_request_class" if name.endswith("Request") else "_response_class")
    if found is None:
        raise LookupError(f"no ROS 1 message {name}")
    return found


def to_bytes(message):
    buffer = BytesIO()
    message.serialize(buffer)
    return buffer.getvalue()


def from_bytes(message_type, data):
    message = message_type()
    message.deserialize(data)
    return message


def random_message(message_type, values, depth=0):
    message = message_type()
    for name, kind in zip(message.__slots__, message._slot_types):
        setattr(message, name, random_field(kind, values, depth))
    if message._type == "std_msgs/Header":
        # Documented: OpenDR writes 0.
        message.seq = 0
    return message


def random_field(kind, values, depth):
    array = ARRAY.match(kind)
    if array:
        item = array["item"]
        count = int(array["count"]) if array["count"] else values.length(depth, item in INTEGERS)
        items = [random_field(item, values, depth + 1) for _ in range(count)]
        return bytes(items) if item == "uint8" else items
    if kind in INTEGERS:
        return values.integer(kind)
    if kind == "time":
        # OpenDR's stamps are ROS 2's: seconds of 31 bits, nanoseconds of less than a second.
        return genpy.Time(values.integer("uint32") >> 1, values.integer("uint32") % 10**9)
    if kind == "duration":
        return genpy.Duration(values.integer("int32"), values.integer("uint32") % 10**9)
    if "/" in kind:
        return random_message(type_by_name(kind), values, depth + 1)
    return {
        "bool": values.boolean,
        "float64": values.double,
        "float32": values.single,
        "string": values.text,
        "byte": lambda: values.integer("int8"),
        "char": lambda: values.integer("uint8"),
    }[kind]()


def to_plain(value):
    """A message as dict, an array as list."""
    if isinstance(value, (genpy.Time, genpy.Duration)):
        return {"sec": value.secs, "nanosec": value.nsecs}
    if isinstance(value, genpy.Message):
        return {name: to_plain(getattr(value, name)) for name in value.__slots__}
    if isinstance(value, (list, tuple, bytes)):
        return [to_plain(item) for item in value]
    return value


def from_plain(message_type, plain):
    """A message; fields that are not named keep their defaults."""
    message = message_type()
    kinds = dict(zip(message.__slots__, message._slot_types))
    for name, value in plain.items():
        setattr(message, name, field_from_plain(kinds[name], value))
    return message


def field_from_plain(kind, value):
    array = ARRAY.match(kind)
    if array:
        items = [field_from_plain(array["item"], item) for item in value]
        return bytes(items) if array["item"] in ("uint8", "char") else items
    if kind in ("time", "duration"):
        return (genpy.Time if kind == "time" else genpy.Duration)(value["sec"], value["nanosec"])
    if kind == "byte":
        # Signed here, unlike ROS 2's.
        return (value + 128) % 256 - 128
    return from_plain(type_by_name(kind), value) if "/" in kind else value
