"""Files of the mcap package are read, and it reads ours."""

import json

import pytest
from conftest import told
from mcap.reader import make_reader
from mcap.writer import CompressionType, IndexType, Writer
from mcap_ros1.decoder import DecoderFactory as Decoder1
from mcap_ros2.decoder import DecoderFactory as Decoder2
from messages import talk

DEFINITIONS = {
    "std_msgs/String": "string data\n",
    "sensor_msgs/Image": "std_msgs/Header header\nuint32 height\nuint32 width\nstring encoding\nuint8 is_bigendian\n"
    "uint32 step\nuint8[] data\n" + 80 * "=" + "\nMSG: std_msgs/Header\n",
}
HEADERS = {True: "builtin_interfaces/Time stamp\nstring frame_id\n", False: "uint32 seq\ntime stamp\nstring frame_id\n"}
TIME = 80 * "=" + "\nMSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n"
TYPES = {"/camera/image_raw": "sensor_msgs/Image", "/chatter": "std_msgs/String"}


def definition(kind, is_cdr):
    text = DEFINITIONS[kind]
    return text + HEADERS[is_cdr] + (TIME if is_cdr else "") if "Header" in text else text


def write(path, is_cdr, **options):
    with path.open("wb") as file:
        writer = Writer(file, chunk_size=100_000, **options)
        writer.start(profile="ros2" if is_cdr else "ros1", library="test")
        channels = {}
        for topic, kind in TYPES.items():
            name = kind.replace("/", "/msg/") if is_cdr else kind
            data = definition(kind, is_cdr).encode()
            schema = writer.register_schema(name, "ros2msg" if is_cdr else "ros1msg", data)
            channels[topic] = writer.register_channel(topic, "cdr" if is_cdr else "ros1", schema)
        for number, (topic, time, data) in enumerate(talk(is_cdr)):
            writer.add_message(channels[topic], time, data, time - 5, number)
        writer.finish()
    return path


def wanted(is_cdr):
    return sorted(told(*message) for message in talk(is_cdr))


@pytest.mark.parametrize("is_cdr", [False, True])
@pytest.mark.parametrize(
    "options",
    [
        {"compression": CompressionType.NONE},
        {"compression": CompressionType.LZ4},
        {"compression": CompressionType.ZSTD},
        {"use_chunking": False},
        {"index_types": IndexType.NONE},
        {"index_types": IndexType.CHUNK},
        {"use_statistics": False},
        {"use_summary_offsets": False, "enable_crcs": False},
        {"repeat_channels": False, "repeat_schemas": False},
        {"enable_data_crcs": True},
    ],
    ids=str,
)
def test_mcap_is_read(tmp_path, dump, is_cdr, options):
    head, messages = dump(write(tmp_path / "a.mcap", is_cdr, **options))
    assert head["format"] == "mcap"
    assert head["is_complete"]
    assert (head["messages"], head["counts"]) == (120, [60, 60])
    times = [time for _, time, _ in messages]
    assert times == sorted(times)
    assert (head["start_ns"], head["end_ns"]) == (times[0], times[-1])
    assert sorted(messages) == wanted(is_cdr)
    for channel in head["channels"]:
        kind = TYPES[channel["topic"]]
        assert channel["definition"] == definition(kind, is_cdr)
        assert channel["type"] == (kind.replace("/", "/msg/") if is_cdr else kind)


def test_other_encodings_are_told_and_read(tmp_path, dump):
    path = tmp_path / "a.mcap"
    with path.open("wb") as file:
        writer = Writer(file)
        writer.start()
        schema = writer.register_schema("point", "jsonschema", b'{"type": "object"}')
        channel = writer.register_channel("/point", "json", schema)
        writer.add_attachment(1, 2, "notes.txt", "text/plain", b"between")
        writer.add_metadata("about", {"robot": "r2"})
        writer.add_message(channel, 7, json.dumps({"x": 1}).encode(), 7)
        writer.finish()
    head, messages = dump(path)
    (channel,) = head["channels"]
    assert (channel["encoding"], channel["type"], channel["is_read_only"]) == ("json", "point", True)
    assert messages == [told("/point", 7, b'{"x": 1}')]


@pytest.mark.parametrize("is_cdr", [False, True])
@pytest.mark.parametrize("options", [[], ["--lz4"]])
def test_our_mcap_is_read(tmp_path, copy, is_cdr, options):
    theirs = write(tmp_path / "a.mcap", is_cdr)
    ours = copy(theirs, tmp_path / "b.mcap", "mcap", *options)
    with ours.open("rb") as file:
        reader = make_reader(file, validate_crcs=True, decoder_factories=[Decoder1(), Decoder2()])
        assert reader.get_header().profile == ("ros2" if is_cdr else "ros1")
        summary = reader.get_summary()
        assert summary.statistics.message_count == 120
        assert summary.statistics.chunk_count == len(summary.chunk_indexes) > 1
        decoded = list(reader.iter_decoded_messages())
    assert sorted(told(channel.topic, one.log_time, one.data) for _, channel, one, _ in decoded) == wanted(is_cdr)
    assert all(message.publish_time == message.log_time - 5 for _, _, message, _ in decoded)
    times = [message.log_time for _, _, message, _ in decoded]
    assert times == sorted(times)
    strings = {message.data for schema, _, _, message in decoded if "String" in schema.name}
    assert strings == {f"hello {number} äöü" for number in range(60)}
    pictures = [message for schema, _, _, message in decoded if "Image" in schema.name]
    assert {(one.width, one.height, one.encoding, len(one.data)) for one in pictures} == {(160, 120, "bgr8", 57600)}


def test_topics_of_our_mcap_are_found_by_its_index(tmp_path, copy):
    ours = copy(write(tmp_path / "a.mcap", True), tmp_path / "b.mcap", "mcap")
    with ours.open("rb") as file:
        found = [told(channel.topic, one.log_time, one.data) for _, channel, one in make_reader(file).iter_messages(["/chatter"])]
    assert sorted(found) == [message for message in wanted(True) if message[0] == "/chatter"]


def test_our_bag2_holds_its_metadata(tmp_path, copy):
    folder = copy(write(tmp_path / "a.mcap", True), tmp_path / "b", "bag2_mcap")
    with (folder / "b_0.mcap").open("rb") as file:
        (metadata,) = make_reader(file).iter_metadata()
    assert metadata.name == "rosbag2"
    assert "message_count: 120" in metadata.metadata["serialized_metadata"]


def test_ros1_goes_from_bag_to_mcap_and_back(tmp_path, dump, copy):
    theirs = write(tmp_path / "a.mcap", False)
    bag = copy(theirs, tmp_path / "a.bag", "bag1", "--lz4")
    again = copy(bag, tmp_path / "b.mcap", "mcap")
    for path in (bag, again):
        head, messages = dump(path)
        assert sorted(messages) == wanted(False)
        assert [channel["type"] for channel in head["channels"]] == list(TYPES.values())
