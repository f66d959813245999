"""Messages made by hand: bytes of std_msgs/String and sensor_msgs/Image in both encodings of ROS."""

import struct

START = 1_700_000_000_123_456_789
STEP = 33_333_333


def string(text, is_cdr):
    data = text.encode()
    if is_cdr:
        return b"\0\1\0\0" + struct.pack("<I", len(data) + 1) + data + b"\0"
    return struct.pack("<I", len(data)) + data


def image(number, width, height, is_cdr):
    """An image of bgr8 from camera `c`."""
    pixels = bytes((at * 7 + number) % 251 for at in range(width * 3)) * height
    seconds, nanoseconds = divmod(START + number * STEP, 10**9)
    if not is_cdr:
        head = struct.pack("<III", number, seconds, nanoseconds) + string("c", False)
        size = struct.pack("<II", height, width) + string("bgr8", False)
        return head + size + struct.pack("<BII", 0, width * 3, len(pixels)) + pixels
    # CDR aligns numbers to their size, counted from behind the encapsulation.
    head = struct.pack("<iI", seconds, nanoseconds) + struct.pack("<I", 2) + b"c\0" + b"\0\0"
    size = struct.pack("<II", height, width) + struct.pack("<I", 5) + b"bgr8\0"
    return b"\0\1\0\0" + head + size + struct.pack("<B", 0) + b"\0\0" + struct.pack("<II", width * 3, len(pixels)) + pixels


def talk(is_cdr):
    """(topic, time, bytes) of two topics: the times of one sometimes repeat or decrease."""
    messages = []
    for number in range(60):
        time = START + number * STEP
        messages.append(("/camera/image_raw", time, image(number, 160, 120, is_cdr)))
        messages.append(("/chatter", time - (number % 7) * STEP, string(f"hello {number} äöü", is_cdr)))
    return messages


def in_order(messages):
    return sorted(messages, key=lambda message: message[1])
