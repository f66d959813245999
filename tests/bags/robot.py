"""A robot's recording, written by rosbags: a camera with a noisy scene, and chatter; and its images as files."""

from pathlib import Path

import numpy as np
from mcap.writer import Writer as McapWriter
from PIL import Image
from rosbags.rosbag1 import Writer as Writer1
from rosbags.rosbag2 import StoragePlugin, Writer
from rosbags.typesys import Stores, get_types_from_msg, get_typestore

MESSAGES = Path(__file__).resolve().parents[2] / "crates/messages"
FRAMES = 5
START = 1_700_000_000_000_000_000
STEP = 100_000_000
LOGGED_AFTER = 4_000_000


def typestore(is_ros1):
    """The messages of a ROS, with vision_msgs and opendr_msgs as OpenDR has them."""
    store = get_typestore(Stores.ROS1_NOETIC if is_ros1 else Stores.ROS2_JAZZY)
    types = {}
    for folder in ["msg", "ros1"] if is_ros1 else ["msg"]:
        for package in ("vision_msgs", "audio_common_msgs", "opendr_msgs"):
            for file in sorted((MESSAGES / folder / package / "msg").glob("*.msg")):
                types.update(get_types_from_msg(file.read_text(), f"{package}/msg/{file.stem}"))
    store.register({name: fields for name, fields in types.items() if name not in store.types})
    return store


def picture(number):
    """Returns an image of random coloured blobs."""
    small = np.random.default_rng(number).integers(0, 256, (6, 8, 3), dtype=np.uint8)
    return np.asarray(Image.fromarray(small).resize((160, 120), Image.Resampling.BICUBIC))


def write_pictures(folder):
    folder.mkdir()
    for number in range(FRAMES):
        Image.fromarray(picture(number)).save(folder / f"{number}.png")
    return folder


def header(store, stamp, frame, number, is_ros1):
    time = store.types["builtin_interfaces/msg/Time"](stamp // 10**9, stamp % 10**9)
    kind = store.types["std_msgs/msg/Header"]
    return kind(number, time, frame) if is_ros1 else kind(time, frame)


def image(store, number, is_ros1):
    kind = store.types["sensor_msgs/msg/Image"]
    head = header(store, START + number * STEP, "camera", number, is_ros1)
    pixels = np.ascontiguousarray(picture(number)[:, :, ::-1])
    height, width, _ = pixels.shape
    return kind(head, height, width, "bgr8", 0, 3 * width, pixels.reshape(-1))


def series(store, number, is_ros1):
    layout = store.types["std_msgs/msg/MultiArrayLayout"]([], 0)
    beat = np.sin(np.arange(140) / (15 + number)).astype(np.float32)
    return store.types["std_msgs/msg/Float32MultiArray"](layout, beat)


def write(path, storage, topics=("/camera/image_raw", "/chatter", "/beats")):
    """The recording; `storage` is bag1, sqlite3 or mcap."""
    is_ros1 = storage == "bag1"
    store = typestore(is_ros1)
    make = {"/chatter": lambda number: store.types["std_msgs/msg/String"](f"hello {number}")}
    make["/beats"] = lambda number: series(store, number, is_ros1)
    plugin = {"sqlite3": StoragePlugin.SQLITE3, "mcap": StoragePlugin.MCAP}.get(storage)
    with Writer1(path) if is_ros1 else Writer(path, version=9, storage_plugin=plugin) as writer:
        connections = {}
        for number in range(FRAMES):
            for topic in topics:
                message = make.get(topic, lambda number: image(store, number, is_ros1))(number)
                kind = message.__msgtype__
                if topic not in connections:
                    connections[topic] = writer.add_connection(topic, kind, typestore=store)
                serialize = store.serialize_ros1 if is_ros1 else store.serialize_cdr
                logged = START + number * STEP + LOGGED_AFTER
                writer.write(connections[topic], logged, serialize(message, kind))
    return path


def write_mcap(path):
    """The camera's topic only, written by the mcap package, one chunk per image."""
    store, kind = typestore(False), "sensor_msgs/msg/Image"
    with path.open("wb") as file:
        writer = McapWriter(file, chunk_size=50_000)
        writer.start(profile="ros2", library="test")
        schema = writer.register_schema(kind, "ros2msg", store.generate_msgdef(kind, ros_version=2)[0].encode())
        channel = writer.register_channel("/camera/image_raw", "cdr", schema)
        for number in range(FRAMES):
            logged = START + number * STEP + LOGGED_AFTER
            data = bytes(store.serialize_cdr(image(store, number, False), kind))
            writer.add_message(channel, logged, data, logged, number)
        writer.finish()
    return path
