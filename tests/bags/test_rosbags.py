"""Recordings of rosbags are read, and rosbags reads ours."""

import os

import pytest
from conftest import told
from messages import in_order, talk
from rosbags.highlevel import AnyReader
from rosbags.interfaces import Qos, QosDurability, QosHistory, QosLiveliness, QosReliability, QosTime
from rosbags.rosbag1 import Reader as Reader1
from rosbags.rosbag1 import Writer as Writer1
from rosbags.rosbag2 import CompressionFormat, CompressionMode, Reader, StoragePlugin, Writer
from rosbags.typesys import Stores, get_typestore

NOETIC = get_typestore(Stores.ROS1_NOETIC)
JAZZY = get_typestore(Stores.ROS2_JAZZY)
TYPES = {"/camera/image_raw": "sensor_msgs/msg/Image", "/chatter": "std_msgs/msg/String"}
QOS = Qos(
    QosHistory.KEEP_LAST,
    10,
    QosReliability.RELIABLE,
    QosDurability.TRANSIENT_LOCAL,
    QosTime(0, 0),
    QosTime(0, 0),
    QosLiveliness.AUTOMATIC,
    QosTime(0, 0),
    False,
)


def write_bag1(path, compression=None):
    writer = Writer1(path)
    if compression:
        writer.set_compression(compression)
    with writer:
        connections = {
            topic: writer.add_connection(topic, kind, typestore=NOETIC, callerid="/robot", latching=1)
            for topic, kind in TYPES.items()
        }
        for topic, time, data in talk(False):
            writer.write(connections[topic], time, data)
    return path


def write_bag2(path, storage, version=9, mode=CompressionMode.NONE):
    writer = Writer(path, version=version, storage_plugin=storage)
    writer.set_compression(mode, CompressionFormat.ZSTD)
    with writer:
        connections = {
            topic: writer.add_connection(topic, kind, typestore=JAZZY, offered_qos_profiles=[QOS])
            for topic, kind in TYPES.items()
        }
        for topic, time, data in talk(True):
            writer.write(connections[topic], time, data)
    return path


def wanted(is_cdr):
    return sorted(told(*message) for message in talk(is_cdr))


def read(reader):
    """Returns the messages of a recording, and its topics with types, definitions and hashes, as read by rosbags."""
    with reader:
        messages = [told(connection.topic, time, data) for connection, time, data in reader.messages()]
        connections = {
            one.topic: (one.msgtype, one.msgdef.data, one.digest, one.msgcount) for one in reader.connections
        }
    times = [time for _, time, _ in messages]
    assert times == sorted(times)
    return sorted(messages), connections


def check_head(head, messages, is_cdr):
    times = [time for _, time, _ in messages]
    assert times == sorted(times)
    assert head["is_complete"]
    assert (head["messages"], head["counts"]) == (120, [60, 60])
    assert (head["start_ns"], head["end_ns"]) == (times[0], times[-1])
    store = JAZZY if is_cdr else NOETIC
    for channel in head["channels"]:
        kind = TYPES[channel["topic"]]
        assert channel["type"] == (kind if is_cdr else kind.replace("/msg", ""))
        assert channel["encoding"] == ("cdr" if is_cdr else "ros1")
        definition, md5 = store.generate_msgdef(kind, ros_version=2 if is_cdr else 1)
        assert channel["definition"] == definition
        assert channel["hash"] == (store.hash_rihs01(kind) if is_cdr else md5)


@pytest.mark.parametrize("is_cdr", [False, True])
def test_bytes_by_hand_are_those_of_rosbags(is_cdr):
    store = JAZZY if is_cdr else NOETIC
    decode, encode = (
        (store.deserialize_cdr, store.serialize_cdr) if is_cdr else (store.deserialize_ros1, store.serialize_ros1)
    )
    for topic, _, data in talk(is_cdr)[:4]:
        assert bytes(encode(decode(data, TYPES[topic]), TYPES[topic])) == data


@pytest.mark.parametrize("compression", [None, Writer1.CompressionFormat.BZ2, Writer1.CompressionFormat.LZ4])
def test_bag1_is_read(tmp_path, dump, compression):
    head, messages = dump(write_bag1(tmp_path / "a.bag", compression))
    assert head["format"] == "bag1"
    check_head(head, messages, False)
    assert all(channel["latching"] and channel["caller_id"] == "/robot" for channel in head["channels"])
    assert sorted(messages) == wanted(False)


@pytest.mark.parametrize("version", [8, 9])
@pytest.mark.parametrize(
    ("storage", "mode"),
    [
        (StoragePlugin.SQLITE3, CompressionMode.NONE),
        (StoragePlugin.SQLITE3, CompressionMode.FILE),
        (StoragePlugin.SQLITE3, CompressionMode.MESSAGE),
        (StoragePlugin.MCAP, CompressionMode.NONE),
        (StoragePlugin.MCAP, CompressionMode.FILE),
        (StoragePlugin.MCAP, CompressionMode.STORAGE),
    ],
)
def test_bag2_is_read(tmp_path, dump, storage, mode, version):
    head, messages = dump(write_bag2(tmp_path / "a", storage, version, mode))
    assert head["format"] == ("bag2_sqlite" if storage == StoragePlugin.SQLITE3 else "bag2_mcap")
    check_head(head, messages, True)
    assert sorted(messages) == wanted(True)


@pytest.mark.parametrize("storage", [StoragePlugin.SQLITE3, StoragePlugin.MCAP])
def test_a_file_of_bag2_is_read_alone(tmp_path, dump, storage):
    folder = write_bag2(tmp_path / "a", storage)
    (file,) = (path for path in folder.iterdir() if path.suffix in {".db3", ".mcap"})
    head, messages = dump(file)
    assert head["is_complete"]
    assert sorted(messages) == wanted(True)
    # Without its metadata, the folder is as left by a killed recorder.
    os.remove(folder / "metadata.yaml")
    head, messages = dump(folder)
    assert not head["is_complete"]
    assert sorted(messages) == wanted(True)


def test_splits_are_one_recording(tmp_path, dump):
    """Two recordings of the same time as two files of one."""
    folder = write_bag2(tmp_path / "a", StoragePlugin.SQLITE3)
    other = write_bag2(tmp_path / "b", StoragePlugin.SQLITE3)
    os.rename(other / "b.db3", folder / "b.db3")
    metadata = folder / "metadata.yaml"
    # Early recordings have the folder in the file's path.
    metadata.write_text(metadata.read_text().replace("  - a.db3\n", "  - a/a.db3\n  - a/b.db3\n", 1))
    head, messages = dump(folder)
    assert (head["messages"], head["counts"], len(head["channels"])) == (240, [120, 120], 2)
    assert sorted(messages) == sorted(2 * wanted(True))
    times = [time for _, time, _ in messages]
    assert times == sorted(times)


@pytest.mark.parametrize("options", [[], ["--lz4"]])
def test_our_bag1_is_read(tmp_path, copy, options):
    theirs = write_bag1(tmp_path / "a.bag")
    ours = copy(theirs, tmp_path / "b.bag", "bag1", *options)
    messages, connections = read(Reader1(ours))
    assert messages == wanted(False)
    assert connections == read(Reader1(theirs))[1]
    with Reader1(ours) as reader:
        assert all(one.ext.latching == 1 and one.ext.callerid == "/robot" for one in reader.connections)


@pytest.mark.parametrize("version", [8, 9])
@pytest.mark.parametrize(("form", "options"), [("bag2_sqlite", []), ("bag2_mcap", []), ("bag2_mcap", ["--lz4"])])
def test_our_bag2_is_read(tmp_path, copy, form, options, version):
    theirs = write_bag2(tmp_path / "a", StoragePlugin.SQLITE3, version)
    ours = copy(theirs, tmp_path / "b", form, *options)
    messages, connections = read(Reader(ours))
    assert messages == wanted(True)
    assert connections == read(Reader(theirs))[1]
    with Reader(ours) as reader, Reader(theirs) as other:
        assert (reader.start_time, reader.end_time) == (other.start_time, other.end_time)
        assert all(one.ext.offered_qos_profiles == [QOS] for one in reader.connections)
    # Its messages can be decoded with the definitions that it holds.
    with AnyReader([ours]) as reader:
        decoded = [reader.deserialize(data, one.msgtype) for one, _, data in reader.messages()]
    assert {message.data for message in decoded if "String" in message.__msgtype__} == {
        f"hello {number} äöü" for number in range(60)
    }


def test_our_mcap_of_ros2_is_read(tmp_path, copy):
    theirs = write_bag2(tmp_path / "a", StoragePlugin.MCAP)
    ours = copy(theirs, tmp_path / "b.mcap", "mcap", "--lz4")
    with Reader(ours) as reader:
        messages = [told(connection.topic, time, data) for connection, time, data in reader.messages()]
    assert sorted(messages) == wanted(True)


def test_a_bag_that_was_cut_is_read_as_far_as_it_goes(tmp_path, dump):
    path = write_bag1(tmp_path / "a.bag")
    size = path.stat().st_size
    for part in (0.3, 0.6, 0.9):
        with path.open("rb") as whole:
            (tmp_path / "cut.bag").write_bytes(whole.read(int(size * part)))
        head, messages = dump(tmp_path / "cut.bag")
        assert not head["is_complete"]
        assert len(messages) == head["messages"]
        assert set(messages) <= set(wanted(False))
        assert len(messages) >= 120 * part - 4


def test_topics_and_times_are_chosen(tmp_path, dump):
    path = write_bag1(tmp_path / "a.bag")
    messages = in_order(talk(False))
    start, end = messages[30][1], messages[80][1]
    _, chosen = dump(path, "--topic", "/chatter", "--start", start, "--end", end)
    assert sorted(chosen) == sorted(
        told(*message) for message in messages if message[0] == "/chatter" and start <= message[1] <= end
    )
