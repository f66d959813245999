"""Nodes of OpenDR with real nodes of ROS 2."""

import json
import signal
import struct
import subprocess
import time
import urllib.request

import peers
import pytest
from patience import wait_until
from node import START, Node, environment, opendr
from pictures import image_fields, noise, photograph

IMAGE, BOXES = "sensor_msgs/msg/Image", "vision_msgs/msg/Detection2DArray"
COMPRESSED, TRIGGER = "sensor_msgs/msg/CompressedImage", "std_srvs/srv/Trigger"
DETECTOR, CLASSIFIER = "single_shot_detector", "image_classifier"


@pytest.fixture(scope="module")
def detector(ros2):
    """A node of the detector that is included in the command."""
    with Node("ros2", DETECTOR, "--image", "/camera/image_raw", ROS_DOMAIN_ID=ros2.domain) as node:
        ros2.wait_for_node(f"/{DETECTOR}")
        yield node


def answered(ros2, topic, kind, message, *answers):
    """The first answer on each subscription to a message that is sent until the node, which may not know the peer yet, has it."""
    stamp = tuple(ros2.decode(kind, message)["header"]["stamp"].values())

    def found(subscription):
        return next((one for one in list(subscription.messages) if one.stamp == stamp), None)

    end = time.monotonic() + 60
    while not all(map(found, answers)):
        assert time.monotonic() < end, f"no answer on {topic}"
        ros2.publish(topic, kind, [message], count=5, rate=20)
    return [found(subscription) for subscription in answers]


def inferred(path):
    """Returns the command's prediction for the image, without ROS."""
    command = [opendr(), "infer", DETECTOR, path, "--json", "--quiet"]
    done = subprocess.run(command, env=environment(), capture_output=True, text=True, check=True)
    return json.loads(done.stdout)["outputs"]["boxes"]["boxes"]


def test_detections_are_those_of_the_library(ros2):
    path = photograph("bus.jpg")
    photo = path.read_bytes()
    # The same bytes, so that decoders cannot differ; a node of its own for the other message.
    words = [DETECTOR, "--name", "zipped", "--image", "/camera/compressed", "--image-message", COMPRESSED]
    with Node("ros2", *words, ROS_DOMAIN_ID=ros2.domain):
        answers = ros2.subscribe("/zipped/boxes", BOXES)
        answers.wait_for_publishers()
        message = {"header": {"stamp": {"sec": 12, "nanosec": 34}, "frame_id": "eye"}, "format": "jpeg", "data": list(photo)}
        [answer] = answered(ros2, "/camera/compressed", COMPRESSED, ros2.encode(COMPRESSED, message), answers)
    detections = ros2.decode(BOXES, answer.data)
    assert detections["header"] == message["header"]
    wanted = inferred(path)
    assert len(wanted) > 0 and len(detections["detections"]) == len(wanted)
    for found, box in zip(detections["detections"], wanted):
        [result] = found["results"]
        assert result["hypothesis"]["class_id"] == "person"
        assert result["hypothesis"]["score"] == pytest.approx(box["confidence"], rel=1e-6)
        centre = found["bbox"]["center"]["position"]
        assert centre["x"] == pytest.approx(box["left"] + box["width"] / 2, rel=1e-5)
        assert found["bbox"]["size_y"] == pytest.approx(box["height"], rel=1e-5)
        assert found["header"] == message["header"]


def test_every_picture_arrives_and_stamps_rise(ros2):
    with Node("ros2", CLASSIFIER, ROS_DOMAIN_ID=ros2.domain):
        seen = ros2.subscribe(f"/{CLASSIFIER}/category", "vision_msgs/msg/Classification")
        told = ros2.subscribe("/diagnostics", "diagnostic_msgs/msg/DiagnosticArray")
        seen.wait_for_publishers()
        told.wait_for_publishers()
        ros2.advertise("/image_raw", IMAGE)
        wait_until(lambda: ros2.subscribers("/image_raw"), 30, "a subscription")
        time.sleep(1)  # until the node knows the publisher, too
        rgb = noise(640, 480)
        frames = [ros2.encode(IMAGE, image_fields(640, 480, rgb, sec=2, nanosec=index)) for index in range(10)]
        ros2.publish("/image_raw", IMAGE, frames, count=300, rate=30, timeout=120)

        def received():
            for message in reversed(list(told.messages)):
                for status in ros2.decode("diagnostic_msgs/msg/DiagnosticArray", message.data)["status"]:
                    if status["hardware_id"] == CLASSIFIER:
                        return {value["key"]: value["value"] for value in status["values"]}
            return {"received": "0"}

        wait_until(lambda: received()["received"] == "300", 60, "300 of 300 pictures")
        counts = received()
    assert int(counts["errors"]) == 0
    assert int(counts["processed"]) + int(counts["left out for newer ones"]) == 300
    assert len(seen.messages) == int(counts["processed"])


def test_parameters_have_ranges_and_change_while_it_runs(ros2, detector):
    node = f"/{DETECTOR}"
    assert {"threshold", "annotate", "use_sim_time"} <= set(ros2.list_parameters(node))
    threshold, sim = ros2.describe_parameters(node, ["threshold", "use_sim_time"])
    assert threshold["floating_point_range"] == [{"from_value": 0.0, "to_value": 1.0, "step": 0.0}]
    assert threshold["description"] and not threshold["read_only"] and sim["read_only"]
    before = ros2.get_parameters(node, ["threshold"])
    assert ros2.set_parameters(node, {"threshold": 0.125}) == [{"successful": True, "reason": ""}]
    assert ros2.get_parameters(node, ["threshold"]) == [0.125]
    [refused] = ros2.set_parameters(node, {"threshold": 1.5})
    assert not refused["successful"] and "out of range" in refused["reason"]
    [refused] = ros2.set_parameters(node, {"threshold": float("nan")})
    assert not refused["successful"]
    [refused] = ros2.set_parameters(node, {"use_sim_time": True})
    assert not refused["successful"] and "cannot change" in refused["reason"]
    [refused] = ros2.set_parameters(node, {"nonsense": 1})
    assert not refused["successful"]
    assert ros2.get_parameters(node, ["threshold"]) == [0.125]
    ros2.set_parameters(node, {"threshold": before[0]})


def test_words_of_ros_name_and_set_it(ros2):
    words = ["--ros-args", "-r", "__ns:=/robot", "-r", "__node:=eyes", "-r", "image_raw:=/front", "-p", "threshold:=0.75"]
    with Node("ros2", DETECTOR, *words, ROS_DOMAIN_ID=ros2.domain):
        ros2.wait_for_node("/robot/eyes")
        assert ros2.get_parameters("/robot/eyes", ["threshold"]) == [0.75]
        wait_until(lambda: ros2.subscribers("/front"), 30, "a subscription to /front")
        assert "/robot/eyes/boxes" in ros2.topics()


def test_learners_of_one_process_share_the_picture(ros2):
    words = [DETECTOR, "--image", "/shared", "+", CLASSIFIER, "--image", "/shared"]
    with Node("ros2", *words, ready=2, ROS_DOMAIN_ID=ros2.domain):
        boxes = ros2.subscribe(f"/{DETECTOR}/boxes", BOXES)
        category = ros2.subscribe(f"/{CLASSIFIER}/category", "vision_msgs/msg/Classification")
        boxes.wait_for_publishers()
        category.wait_for_publishers()
        wait_until(lambda: ros2.subscribers("/shared"), 30, "a subscription")
        assert len(ros2.subscribers("/shared")) == 1
        picture = ros2.encode(IMAGE, image_fields(64, 48, noise(64, 48), sec=9))
        answered(ros2, "/shared", IMAGE, picture, boxes, category)


def test_the_annotated_picture_is_compressed(ros2, detector):
    seen = ros2.subscribe(f"/{DETECTOR}/annotated/compressed", COMPRESSED)
    seen.wait_for_publishers()
    picture = ros2.encode(IMAGE, image_fields(64, 48, noise(64, 48), sec=5))
    [answer] = answered(ros2, "/camera/image_raw", IMAGE, picture, seen)
    message = ros2.decode(COMPRESSED, answer.data)
    assert bytes(message["data"][:2]) == b"\xff\xd8" and "jpeg" in message["format"]
    assert message["header"]["stamp"] == {"sec": 5, "nanosec": 0}


def test_a_page_displays_what_the_node_processes(ros2):
    with Node("ros2", DETECTOR, "--name", "viewed", "--image", "/camera/viewed", "--view=127.0.0.1:0", ready=0, ROS_DOMAIN_ID=ros2.domain) as node:
        url = node.wait_for_line("viewer: ", START).split("viewer: ")[1].rstrip("/")
        node.wait_for_line("is ready as", START)
        answers = ros2.subscribe("/viewed/boxes", BOXES)
        answers.wait_for_publishers()
        message = ros2.encode(IMAGE, image_fields(64, 48, noise(64, 48), sec=5, nanosec=6))
        answered(ros2, "/camera/viewed", IMAGE, message, answers)
        with urllib.request.urlopen(f"{url}/api/next?after=0&plain=1", timeout=20) as answer:
            content = answer.read()
    assert answer.status == 200 and b"/camera/viewed" in content and b"inference" in content


def test_reset_and_labels(ros2, detector):
    response = ros2.decode(f"{TRIGGER}_Response", ros2.call(f"/{DETECTOR}/reset", TRIGGER, ros2.encode(f"{TRIGGER}_Request", {})))
    assert response["success"]
    labels = ros2.subscribe(
        f"/{DETECTOR}/label_info", "vision_msgs/msg/LabelInfo", qos="reliable transient_local", depth=1
    )
    [info] = labels.wait(1)
    names = [row["class_name"] for row in ros2.decode("vision_msgs/msg/LabelInfo", info.data)["class_map"]]
    assert "person" in names


def test_nonsense_does_not_stop_it(ros2, detector):
    """Broken CDR, lengths of 4 GB, images that contradict themselves, another type on the topic."""
    seen = ros2.subscribe(f"/{DETECTOR}/boxes", BOXES)
    seen.wait_for_publishers()
    good = ros2.encode(IMAGE, image_fields(32, 24, noise(32, 24), sec=77))
    length = good.rindex(struct.pack("<I", 32 * 24 * 3))
    huge = good[:length] + b"\xff\xff\xff\xff" + good[length + 4 :]
    wide = ros2.encode(IMAGE, {**image_fields(32, 24, noise(32, 24)), "width": 4_000_000_000})
    odd = ros2.encode(IMAGE, {**image_fields(32, 24, noise(32, 24)), "encoding": "nonsense"})
    broken = [huge, wide, odd, good[:40], good[:4], b"\x00\x07\x00\x00" + good[4:], b"\x00\x01\x00\x00"]
    ros2.publish("/camera/image_raw", IMAGE, broken, rate=20)
    with peers.Ros2Peer("jazzy", ros2.domain, "stranger") as stranger:
        stranger.advertise("/camera/image_raw", "std_msgs/msg/String")
        answered(ros2, "/camera/image_raw", IMAGE, good, seen)
    assert detector.process.poll() is None
    assert detector.memory() < 1 << 30


def test_peers_may_die_and_come_back(ros2, detector):
    for stamp in (101, 102):
        with peers.Ros2Peer("jazzy", ros2.domain, f"camera{stamp}") as camera:
            seen = camera.subscribe(f"/{DETECTOR}/boxes", BOXES)
            seen.wait_for_publishers()
            picture = camera.encode(IMAGE, image_fields(32, 24, noise(32, 24), sec=stamp))
            camera.publish("/camera/image_raw", IMAGE, [picture], count=200, rate=20, background=True)
            wait_until(lambda: any(message.stamp == (stamp, 0) for message in seen.messages), 30, "an answer")
            camera.process.kill()


def test_it_ends_when_it_is_told_to(ros2):
    for how in (signal.SIGINT, signal.SIGTERM):
        with Node("ros2", CLASSIFIER, ROS_DOMAIN_ID=ros2.domain) as node:
            assert node.stop(how) == 130


def test_usage_errors_are_told():
    def run(*words):
        command = [opendr(), "ros2", "run", *words]
        return subprocess.run(command, env=environment(), capture_output=True, text=True, timeout=60)

    assert run("--help").returncode == 0
    helped = run(DETECTOR, "--help")
    assert helped.returncode == 0 and "--image <TOPIC>" in helped.stdout and "image_raw" in helped.stdout
    assert run(DETECTOR, "--nonsense", "1").returncode == 2
    wrong = run(DETECTOR, "--image-message", "std_msgs/msg/String")
    assert wrong.returncode == 11 and "there are sensor_msgs/msg/Image" in wrong.stderr
    assert run(DETECTOR, "--ros-args", "-p", "threshold:=7").returncode == 12
    assert run(DETECTOR, "--image", "a b").returncode == 11




def test_the_model_may_be_replaced_while_it_runs(ros2, tmp_path):
    model = tmp_path / "model"
    subprocess.run([opendr(), "export", CLASSIFIER, "--out", model], env=environment(), capture_output=True, check=True)
    words = [CLASSIFIER, "--model", model, "--name", "replaced", "--image", "/replaced_raw"]
    with Node("ros2", *words, ROS_DOMAIN_ID=ros2.domain) as node:
        seen = ros2.subscribe("/replaced/category", "vision_msgs/msg/Classification")
        seen.wait_for_publishers()
        for stamp, damage in ((21, None), (22, b"nonsense"), (23, b"")):
            if damage is not None:
                for file in model.iterdir():
                    file.write_bytes(damage)
            answered(ros2, "/replaced_raw", IMAGE, ros2.encode(IMAGE, image_fields(32, 24, noise(32, 24), sec=stamp)), seen)
        assert node.process.poll() is None


def test_time_may_jump(ros2):
    clock = "rosgraph_msgs/msg/Clock"
    words = [CLASSIFIER, "--name", "timed", "--image", "/timed_raw", "--use-sim-time", "true"]
    with Node("ros2", *words, ROS_DOMAIN_ID=ros2.domain) as node:
        seen = ros2.subscribe("/timed/category", "vision_msgs/msg/Classification")
        latency = ros2.subscribe("/timed/latency_ms", "std_msgs/msg/Float32")
        seen.wait_for_publishers()
        latency.wait_for_publishers()
        ros2.advertise("/clock", clock)
        for sec, stamp in ((1000, 999), (5, 4), (2_000_000_000, 1_999_999_999)):
            picture = ros2.encode(IMAGE, image_fields(32, 24, noise(32, 24), sec=stamp))
            for attempt in range(10):
                ros2.publish("/clock", clock, [ros2.encode(clock, {"clock": {"sec": sec}})], count=10, rate=20)
                seen.clear()
                latency.clear()
                answered(ros2, "/timed_raw", IMAGE, picture, seen)
                told = ros2.decode("std_msgs/msg/Float32", latency.wait(1)[-1].data)["data"]
                # The node may not have found the publisher of the clock yet.
                if abs(told - 1000) <= 1 or attempt == 9:
                    break
            assert told == pytest.approx(1000, abs=1)
        assert node.process.poll() is None


def test_a_managed_node_waits_to_be_activated(ros2):
    change, get = "lifecycle_msgs/srv/ChangeState", "lifecycle_msgs/srv/GetState"
    words = [CLASSIFIER, "--name", "managed", "--image", "/managed_raw", "--lifecycle"]

    def changed(label):
        request = ros2.encode(f"{change}_Request", {"transition": {"id": 0, "label": label}})
        return ros2.decode(f"{change}_Response", ros2.call("/managed/change_state", change, request))["success"]

    def state():
        request = ros2.encode(f"{get}_Request", {})
        return ros2.decode(f"{get}_Response", ros2.call("/managed/get_state", get, request))["current_state"]["label"]

    with Node("ros2", *words, ROS_DOMAIN_ID=ros2.domain) as node:
        seen = ros2.subscribe("/managed/category", "vision_msgs/msg/Classification")
        seen.wait_for_publishers()
        picture = ros2.encode(IMAGE, image_fields(32, 24, noise(32, 24), sec=31))
        assert state() == "unconfigured" and not changed("activate")
        assert changed("configure") and state() == "inactive"
        ros2.publish("/managed_raw", IMAGE, [picture], count=20, rate=20)
        assert seen.messages == []
        assert changed("activate") and state() == "active"
        answered(ros2, "/managed_raw", IMAGE, picture, seen)
        assert changed("deactivate") and state() == "inactive"
        assert changed("shutdown")
        assert node.process.wait(30) == 0
