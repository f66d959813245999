"""Nodes of OpenDR with real nodes of ROS 1: Debian's roscore and rospy."""

import struct
import subprocess
import time

import peers
import pytest
from node import Node
from patience import wait_until
from pictures import image_fields, noise, photograph
from test_node_ros2 import inferred

IMAGE, BOXES, COMPRESSED = "sensor_msgs/Image", "vision_msgs/Detection2DArray", "sensor_msgs/CompressedImage"
DETECTOR, CLASSIFIER = "single_shot_detector", "image_classifier"


@pytest.fixture(scope="module")
def camera(roscore):
    with peers.Ros1Peer(roscore, "camera") as peer:
        yield peer


@pytest.fixture(scope="module")
def detector(roscore):
    with Node("ros1", DETECTOR, "--image", "/camera/image_raw", **roscore.environment) as node:
        yield node


def answer(peer, topic, kind, message, subscription):
    """Sends a message until the first prediction arrives, and returns it."""
    stamp = tuple(peer.decode(kind, message)["header"]["stamp"].values())

    def found():
        return next((one for one in list(subscription.messages) if one.stamp == stamp), None)

    end = time.monotonic() + 60
    while not found():
        assert time.monotonic() < end, f"no answer on {topic}"
        peer.publish(topic, kind, [message], count=5, rate=20)
    return found()


def test_detections_are_those_of_the_library(roscore, camera):
    path = photograph("bus.jpg")
    words = [DETECTOR, "--name", "zipped", "--image", "/photo", "--image-message", COMPRESSED, "--class-ids", "numbers"]
    with Node("ros1", *words, **roscore.environment):
        seen = camera.subscribe("/zipped/boxes", BOXES)
        stamp = {"sec": 12, "nanosec": 34}
        fields = {"header": {"stamp": stamp, "frame_id": "eye"}, "format": "jpeg", "data": list(path.read_bytes())}
        found = answer(camera, "/photo", COMPRESSED, camera.encode(COMPRESSED, fields), seen)
    detections = camera.decode(BOXES, found.data)
    assert detections["header"]["stamp"] == stamp and detections["header"]["frame_id"] == "eye"
    wanted = inferred(path)
    assert len(wanted) > 0 and len(detections["detections"]) == len(wanted)
    for found, box in zip(detections["detections"], wanted):
        assert found["results"][0]["id"] == 0
        assert found["results"][0]["score"] == pytest.approx(box["confidence"], rel=1e-6)
        assert found["bbox"]["center"]["y"] == pytest.approx(box["top"] + box["height"] / 2, rel=1e-5)


def test_every_picture_arrives(roscore, camera):
    with Node("ros1", CLASSIFIER, **roscore.environment):
        told = camera.subscribe("/diagnostics", "diagnostic_msgs/DiagnosticArray")
        picture = camera.encode(IMAGE, image_fields(640, 480, noise(640, 480)))
        camera.publish("/image_raw", IMAGE, [picture], count=300, rate=30, timeout=120, depth=10)

        def received():
            for message in reversed(list(told.messages)):
                for status in camera.decode("diagnostic_msgs/DiagnosticArray", message.data)["status"]:
                    if status["hardware_id"] == CLASSIFIER:
                        return {value["key"]: value["value"] for value in status["values"]}
            return {"received": "0", "errors": "0"}

        wait_until(lambda: received()["received"] == "300", 60, "300 of 300 pictures")
        assert received()["errors"] == "0"


def test_parameters_are_followed_and_put_back(camera, detector):
    node = f"/{DETECTOR}"
    assert camera.get_parameters(node, ["threshold", "annotate"])[1] is True
    camera.set_parameters(node, {"threshold": 0.125})
    camera.set_parameters(node, {"threshold": 7.5})
    detector.wait_for_line("out of range")
    wait_until(lambda: camera.get_parameters(node, ["threshold"]) == [0.125], 30, "the value that holds")


def test_nonsense_does_not_stop_it(camera, detector):
    seen = camera.subscribe(f"/{DETECTOR}/boxes", BOXES)
    good = camera.encode(IMAGE, image_fields(32, 24, noise(32, 24), sec=77))
    length = good.rindex(struct.pack("<I", 32 * 24 * 3))
    wide = camera.encode(IMAGE, {**image_fields(32, 24, noise(32, 24)), "width": 4_000_000_000})
    broken = [good[:length] + b"\xff\xff\xff\xff" + good[length + 4 :], wide, good[:30], b"", good + b"\0"]
    camera.publish("/camera/image_raw", IMAGE, broken, rate=20)
    answer(camera, "/camera/image_raw", IMAGE, good, seen)
    assert detector.process.poll() is None and detector.memory() < 1 << 30


def test_rosnode_kill_ends_it(roscore, camera):
    with Node("ros1", CLASSIFIER, "--name", "victim", **roscore.environment) as node:
        subprocess.run(["rosnode", "kill", "/victim"], env={"PATH": "/usr/bin:/bin", **roscore.environment}, check=True)
        assert node.process.wait(30) == 0
