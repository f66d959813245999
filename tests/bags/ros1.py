"""ROS 1's own rosbag, for the interpreter that it is installed for: `ros1.py write|leave|read PATH [COMPRESSION]`,
`ros1.py listen COUNT`."""

import hashlib
import json
import os
import sys
import time

import genpy
import rosbag
import rospy
from messages import talk
from sensor_msgs.msg import Image
from std_msgs.msg import String

TYPES = {"/camera/image_raw": Image, "/chatter": String}


def write(path, compression, is_left):
    bag = rosbag.Bag(path, "w", compression=compression, chunk_threshold=300_000)
    for topic, stamp, data in talk(False):
        kind = TYPES[topic]
        raw = (kind._type, data, kind._md5sum, kind)
        bag.write(topic, raw, genpy.Time(*divmod(stamp, 10**9)), raw=True)
    if is_left:
        # As after a kill: no file is closed.
        bag._file.flush()
        os._exit(0)
    bag.close()


def read(path):
    with rosbag.Bag(path) as bag:
        for topic, (kind, data, md5, _, _), stamp in bag.read_messages(raw=True):
            assert (kind, md5) == (TYPES[topic]._type, TYPES[topic]._md5sum)
            print(json.dumps([topic, stamp.to_nsec(), hashlib.sha256(data).hexdigest()]))
        decoded = [message for _, message, _ in bag.read_messages()]
    assert {message.data for message in decoded if isinstance(message.data, str)} == {
        f"hello {number} äöü" for number in range(60)
    }


def listen(count):
    """Prints the messages of the topics once all have arrived."""
    heard = []

    def hear(topic):
        return lambda message: heard.append([topic, hashlib.sha256(message._buff).hexdigest()])

    rospy.init_node("listener", anonymous=True)
    for topic in TYPES:
        rospy.Subscriber(topic, rospy.AnyMsg, hear(topic), queue_size=count)
    print("ready", flush=True)
    until = time.monotonic() + 60
    while len(heard) < count and time.monotonic() < until:
        time.sleep(0.1)
    print(json.dumps(heard), flush=True)


if __name__ == "__main__":
    verb, path, *compression = sys.argv[1:]
    if verb == "listen":
        listen(int(path))
    elif verb == "read":
        read(path)
    else:
        write(path, *compression, verb == "leave")
