"""`opendr infer`, `eval` and `bag` with rosbags and mcap: the command reads their recordings, and they read ours."""

import json
import shutil
import signal
import subprocess

import pytest
import robot
from mcap.reader import make_reader
from mcap_ros2.decoder import DecoderFactory
from rosbags.highlevel import AnyReader
from rosbags.rosbag1 import Writer as Writer1
from rosbags.rosbag2 import Writer
from rosbags.typesys import Stores, get_types_from_msg, get_typestore

DETECTOR = ["infer", "single_shot_detector", "--threshold", "0.05"]
BOXES = "/single_shot_detector/boxes"
STORAGES = ["bag1", "sqlite3", "mcap"]


@pytest.fixture
def recording(tmp_path):
    def make(storage, *topics):
        path = tmp_path / ("drive.bag" if storage == "bag1" else f"drive_{storage}")
        return robot.write(path, storage, *([topics] if topics else []))

    return make


def stamp(number):
    return robot.START + number * robot.STEP


def read(path, is_ros1):
    """Every message of a recording as rosbags reads it: (topic, log time, type, message)."""
    with AnyReader([path], default_typestore=robot.typestore(is_ros1)) as reader:
        return [
            (one.topic, time, one.msgtype, reader.deserialize(data, one.msgtype))
            for one, time, data in reader.messages()
        ]


def on(topic, messages):
    return [(time, kind, message) for name, time, kind, message in messages if name == topic]


def stamp_of(message):
    return message.header.stamp.sec * 10**9 + message.header.stamp.nanosec


def check_boxes(found, lines, class_id):
    """Detections are the boxes of the lines of JSON, logged with their image and with its stamp."""
    assert len(found) == len(lines) == robot.FRAMES
    for number, ((logged, kind, message), line) in enumerate(zip(found, lines, strict=True)):
        assert kind == "vision_msgs/msg/Detection2DArray"
        assert logged == stamp(number) + robot.LOGGED_AFTER
        assert (stamp_of(message), message.header.frame_id) == (stamp(number), "camera")
        boxes = line["outputs"]["boxes"]["boxes"]
        assert len(message.detections) == len(boxes) > 0
        for detection, box in zip(message.detections, boxes, strict=True):
            centre = detection.bbox.center
            x, y = (centre.position.x, centre.position.y) if hasattr(centre, "position") else (centre.x, centre.y)
            assert x == pytest.approx(box["left"] + box["width"] / 2)
            assert y == pytest.approx(box["top"] + box["height"] / 2)
            assert (detection.bbox.size_x, detection.bbox.size_y) == pytest.approx((box["width"], box["height"]))
            (result,) = detection.results
            told = result.hypothesis if hasattr(result, "hypothesis") else result
            assert told.score == pytest.approx(box["confidence"])
            assert (told.class_id if hasattr(told, "class_id") else told.id) == class_id


@pytest.mark.parametrize("storage", STORAGES)
def test_a_recording_is_answered_as_its_pictures_are(tmp_path, opendr, recording, storage):
    path = recording(storage)
    lines = opendr(*DETECTOR, path, "--json").lines
    pictures = opendr(*DETECTOR, robot.write_pictures(tmp_path / "pictures"), "--json").lines
    assert [line["index"] for line in lines] == list(range(robot.FRAMES))
    assert {line["input"] for line in lines} == {str(path)}
    for number, (line, picture) in enumerate(zip(lines, pictures, strict=True)):
        boxes = line["outputs"]["boxes"]
        assert (boxes.pop("stamp_ns"), boxes.pop("frame_id")) == (stamp(number), "camera")
        assert line["outputs"] == picture["outputs"]
    assert len(opendr(*DETECTOR, path, "--json", "--limit", 2).lines) == 2


@pytest.mark.parametrize("storage", STORAGES)
def test_series_are_answered(opendr, recording, storage):
    lines = opendr("infer", "gated_recurrent_unit", recording(storage), "--json").lines
    categories = [line["outputs"]["category"] for line in lines]
    # The message has no header: its recording time is the stamp.
    assert [one["stamp_ns"] for one in categories] == [stamp(at) + robot.LOGGED_AFTER for at in range(robot.FRAMES)]


def test_topics_are_chosen(tmp_path, opendr):
    path = robot.write(tmp_path / "two.bag", "bag1", ("/left", "/right", "/chatter"))
    done = opendr("infer", "image_classifier", path, code=11)
    assert "several topics" in done.stderr
    assert "/left  sensor_msgs/Image, 5 messages (fits)" in done.stderr
    assert "/chatter  std_msgs/String, 5 messages\n" in done.stderr
    assert len(opendr("infer", "image_classifier", path, "--topic", "/right", "--json").lines) == robot.FRAMES
    assert "cannot be read as Image" in opendr("infer", "image_classifier", path, "--topic", "chatter", code=11).stderr
    assert "/left" in opendr("infer", "image_classifier", path, "--topic", "/none", code=13).stderr


@pytest.mark.parametrize("storage", STORAGES)
@pytest.mark.parametrize(
    ("name", "flags"),
    [
        ("answers.mcap", []),
        ("answers.bag", []),
        ("answers", ["--bag-format", "bag2_sqlite"]),
        ("answers", ["--bag-format", "bag2_mcap"]),
    ],
)
def test_answers_are_recorded(tmp_path, opendr, recording, storage, name, flags):
    path, out = recording(storage), tmp_path / name
    lines = opendr(*DETECTOR, path, "--out", out, *flags, "--with-input", "--json").lines
    is_ros1 = name.endswith(".bag")
    messages = read(out, is_ros1)
    # ROS 1 has no names of classes.
    check_boxes(on(BOXES, messages), lines, 0 if is_ros1 else "person")
    pictures = on("/camera/image_raw", messages)
    assert [(logged, stamp_of(one)) for logged, _, one in pictures] == [
        (stamp(at) + robot.LOGGED_AFTER, stamp(at)) for at in range(robot.FRAMES)
    ]
    for number, (_, _, one) in enumerate(pictures):
        assert (one.encoding, one.header.frame_id) == ("bgr8", "camera")
        assert bytes(one.data) == robot.picture(number)[:, :, ::-1].tobytes()
    topics = {topic for topic, *_ in messages}
    assert topics == {BOXES, "/camera/image_raw"} | (set() if is_ros1 else {"/single_shot_detector/label_info"})
    if not is_ros1:
        ((_, _, info),) = on("/single_shot_detector/label_info", messages)
        assert [(one.class_id, one.class_name) for one in info.class_map] == [(0, "person")]
    assert "already exists" in opendr(*DETECTOR, path, "--out", out, *flags, code=12).stderr
    opendr(*DETECTOR, path, "--out", out, *flags, "--overwrite", "--limit", 1)
    assert len(on(BOXES, read(out, is_ros1))) == 1


def test_answers_are_decoded_by_mcap(tmp_path, opendr, recording):
    out = tmp_path / "answers.mcap"
    lines = opendr(*DETECTOR, recording("mcap"), "--out", out, "--json").lines
    with out.open("rb") as file:
        decoded = list(make_reader(file, decoder_factories=[DecoderFactory()]).iter_decoded_messages([BOXES]))
    found = [(message.log_time, schema.name, decoded) for schema, _, message, decoded in decoded]
    check_boxes(found, lines, "person")


@pytest.mark.parametrize(("name", "flags"), [("a.bag", []), ("a.mcap", []), ("a", ["--bag-format", "bag2_sqlite"])])
def test_answers_to_pictures_are_recorded(tmp_path, opendr, name, flags):
    pictures, out = robot.write_pictures(tmp_path / "pictures"), tmp_path / name
    lines = opendr(*DETECTOR, pictures, "--out", out, *flags, "--with-input", "--json").lines
    messages = read(out, name.endswith(".bag"))
    found, seen = on(BOXES, messages), on("/image_raw/compressed", messages)
    times = [max(number * 40_000_000, 1) for number in range(robot.FRAMES)]
    assert [(logged, stamp_of(one)) for logged, _, one in found] == [(one, one) for one in times]
    assert [(logged, stamp_of(one)) for logged, _, one in seen] == [(one, one) for one in times]
    counts = [len(line["outputs"]["boxes"]["boxes"]) for line in lines]
    assert [len(one.detections) for _, _, one in found] == counts
    again = opendr(*DETECTOR, out, "--json").lines
    assert len(again) == robot.FRAMES


@pytest.mark.skipif(shutil.which("ffmpeg") is None, reason="no ffmpeg")
def test_answers_to_videos_are_recorded(tmp_path, opendr, recording):
    """One after the other, each with its own stamps."""
    video, out = tmp_path / "seen.mp4", tmp_path / "answers.bag"
    opendr(*DETECTOR, recording("bag1"), "--out", video)
    shutil.copy(video, tmp_path / "again.mp4")
    opendr(*DETECTOR, video, tmp_path / "again.mp4", "--out", out, "--with-input")
    times = [logged for logged, _, _ in on(BOXES, read(out, True))]
    # Ten frames per second, as in the recording.
    first = [max(number * robot.STEP, 1) for number in range(robot.FRAMES)]
    assert times[: robot.FRAMES] == pytest.approx(first, abs=1_000_000)
    second = [time - times[robot.FRAMES] for time in times[robot.FRAMES :]]
    assert second == pytest.approx(first, abs=1_000_000)
    assert times == sorted(set(times))


@pytest.mark.parametrize("storage", ["bag1", "mcap"])
def test_a_recording_that_was_cut_is_answered_as_far_as_it_goes(tmp_path, opendr, recording, storage):
    file = recording("bag1", "/camera/image_raw") if storage == "bag1" else robot.write_mcap(tmp_path / "a.mcap")
    cut = tmp_path / f"cut{file.suffix}"
    cut.write_bytes(file.read_bytes()[: file.stat().st_size * 6 // 10])
    out = tmp_path / "answers.mcap"
    done = opendr(*DETECTOR, cut, "--out", out, "--json", code=1)
    assert "truncated" in done.stderr
    told, *lines = done.lines
    assert (told["input"], told["error"]["kind"]) == (str(cut), "Format")
    assert len(on(BOXES, read(out, False))) == len(lines)
    assert 1 <= len(lines) < robot.FRAMES


def test_what_ctrl_c_leaves_is_read(tmp_path, opendr):
    """A long recording, stopped after the first predictions."""
    path = tmp_path / "long.bag"
    store = robot.typestore(True)
    with Writer1(path) as writer:
        message = robot.image(store, 0, True)
        connection = writer.add_connection("/camera", message.__msgtype__, typestore=store)
        data = store.serialize_ros1(message, message.__msgtype__)
        for number in range(3000):
            writer.write(connection, stamp(number), data)
    out = tmp_path / "answers.bag"
    command = [*opendr.program, *DETECTOR, str(path), "--out", str(out), "--json"]
    running = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    running.stdout.readline()
    running.send_signal(signal.SIGINT)
    rest, _ = running.communicate(timeout=60)
    assert running.returncode == 130
    found = on(BOXES, read(out, True))
    assert len(found) == len(rest.splitlines()) + 1 < 3000


def test_recordings_are_converted(tmp_path, opendr, recording):
    """From ROS 1 to ROS 2 and back, each read by rosbags; unknown types are reported and skipped."""
    path = recording("bag1")
    before = {topic: on(topic, read(path, True)) for topic in ("/camera/image_raw", "/chatter", "/beats")}
    folder, again = tmp_path / "folder", tmp_path / "again.bag"
    opendr("bag", "convert", path, folder, "--to", "bag2_sqlite")
    opendr("bag", "convert", folder, again)
    for copy, is_ros1 in ((folder, False), (again, True)):
        messages = read(copy, is_ros1)
        for topic, wanted in before.items():
            found = on(topic, messages)
            assert [(time, kind) for time, kind, _ in found] == [(time, kind) for time, kind, _ in wanted]
            for (_, _, one), (_, _, other) in zip(found, wanted, strict=True):
                data = (one.data, other.data)
                assert data[0] == data[1] if isinstance(data[0], str) else bytes(data[0]) == bytes(data[1])
    opendr("bag", "convert", path, tmp_path / "chatter.mcap", "--topic", "/chatter", "--ros2", "--lz4")
    with (tmp_path / "chatter.mcap").open("rb") as file:
        reader = make_reader(file, decoder_factories=[DecoderFactory()])
        texts = [decoded.data for _, _, _, decoded in reader.iter_decoded_messages()]
    assert texts == [f"hello {number}" for number in range(robot.FRAMES)]


def test_messages_that_are_not_known_are_left_out_of_a_conversion(tmp_path, opendr):
    store, path = robot.typestore(True), tmp_path / "a.bag"
    with Writer1(path) as writer:
        for topic, kind in (("/heat", "sensor_msgs/msg/Temperature"), ("/chatter", "std_msgs/msg/String")):
            connection = writer.add_connection(topic, kind, typestore=store)
            fields = ["hi"] if topic == "/chatter" else [robot.header(store, 1, "a", 0, True), 20.0, 0.0]
            writer.write(connection, 10**9, store.serialize_ros1(store.types[kind](*fields), kind))
    done = opendr("bag", "convert", path, tmp_path / "a.mcap", "--ros2", code=1)
    assert "skipped: /heat (sensor_msgs/Temperature)" in done.stderr
    info = json.loads(opendr("bag", "info", tmp_path / "a.mcap", "--json").stdout)
    assert [(one["name"], one["messages"]) for one in info["topics"]] == [("/chatter", 1)]
    # As it is, everything is kept.
    opendr("bag", "convert", path, tmp_path / "b.mcap")
    info = json.loads(opendr("bag", "info", tmp_path / "b.mcap", "--json").stdout)
    assert {one["name"] for one in info["topics"]} == {"/heat", "/chatter"}


def test_another_version_of_a_message_is_told(tmp_path, opendr):
    """vision_msgs of another release has the same name and other fields."""
    store, path = get_typestore(Stores.ROS2_JAZZY), tmp_path / "a"
    kind = "vision_msgs/msg/Detection2DArray"
    store.register(get_types_from_msg("std_msgs/Header header\nfloat64 other\n", kind))
    with Writer(path, version=9) as writer:
        connection = writer.add_connection("/truth", kind, typestore=store)
        message = store.types[kind](robot.header(store, 1, "a", 0, False), 1.0)
        writer.write(connection, 10**9, store.serialize_cdr(message, kind))
    assert "another version" in opendr("bag", "info", path).stdout


@pytest.mark.parametrize("storage", STORAGES)
def test_a_recording_is_a_data_set(tmp_path, opendr, storage):
    """The detector's own predictions are the ground truth: every box is a true positive."""
    is_ros1 = storage == "bag1"
    drive = robot.write(tmp_path / ("drive.bag" if is_ros1 else "drive"), storage)
    truth = tmp_path / ("truth.bag" if is_ros1 else "truth")
    form = {"bag1": "bag1", "sqlite3": "bag2_sqlite", "mcap": "bag2_mcap"}[storage]
    opendr(*DETECTOR, drive, "--out", truth, "--bag-format", form, "--with-input")
    report = json.loads(opendr("eval", "single_shot_detector", truth, "--threshold", "0.05", "--json").stdout)
    assert (report["counted"], report["skipped"]) == (robot.FRAMES, 0)
    assert (report["scalars"]["map"], report["scalars"]["mar"]) == (1.0, 1.0)
    stats = opendr("data", "stats", truth).stdout
    assert stats.startswith(f"{robot.FRAMES} samples")
    opendr("data", "check", truth)
    missing = opendr("data", "stats", drive, code=13).stderr
    assert "BoundingBoxList" in missing


def test_recordings_do_not_mix_with_files(tmp_path, opendr, recording):
    pictures = robot.write_pictures(tmp_path / "pictures")
    assert "use one command for each" in opendr(*DETECTOR, recording("bag1"), pictures, code=11).stderr
    assert "needs a recording" in opendr(*DETECTOR, pictures, "--topic", "/a", code=12).stderr
