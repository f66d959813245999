"""A node over Zenoh with PyZeROS and a Zenoh router: keys, hashes, attachments, services.

Run by `cargo xtask ros --zenoh`, which builds the command with the feature `zenoh`.
"""

import asyncio
import json
import os
import socket
import struct
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
import zenoh

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests/ros"))

from node import Node  # noqa: E402

pyzeros = pytest.importorskip("pyzeros")
from ros2_pyterfaces.cydr.all_msgs import Float32, Image  # noqa: E402
from ros2_pyterfaces.cydr.std_srvs.srv import Trigger  # noqa: E402


DOMAIN = "7"
PATIENCE = 60
#: Of ROS 2 itself: share/rcl_interfaces/srv/GetParameters.json of rcl_interfaces 2.0.3.
GET_PARAMETERS = "RIHS01_bf9803d5c74cf989a5de3e0c2e99444599a627c7ff75f97b8c05b01003675cbc"


@pytest.fixture(scope="module")
def endpoint():
    """A router; what peers connect to."""
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        port = probe.getsockname()[1]
    endpoint = f"tcp/127.0.0.1:{port}"
    config = zenoh.Config()
    config.insert_json5("mode", '"router"')
    config.insert_json5("listen/endpoints", json.dumps([endpoint]))
    config.insert_json5("scouting/multicast/enabled", "false")
    with zenoh.open(config):
        yield endpoint


@pytest.fixture(scope="module")
def node(endpoint):
    words = ["single_shot_detector", "--image", "/camera/image_raw", "--offline", "--ros-args", "-r", "__ns:=/robot"]
    override = f'connect/endpoints=["{endpoint}"]'
    more = {"RMW_IMPLEMENTATION": "rmw_zenoh_cpp", "ROS_DOMAIN_ID": DOMAIN, "ZENOH_CONFIG_OVERRIDE": override}
    with Node("ros2", *words, **more) as node:
        yield node


def until(ask, wanted):
    end = time.time() + PATIENCE
    while not wanted(answer := ask()):
        assert time.time() < end, answer
        time.sleep(0.1)
    return answer


def tokens(session):
    """The node's tokens, in their parts."""
    every = [str(reply.ok.key_expr) for reply in session.liveliness().get(f"@ros2_lv/{DOMAIN}/**")]
    return [token.split("/") for token in every if "/%robot/single_shot_detector" in token]


@pytest.fixture
def session(endpoint, node):
    """A peer that has found the node, which takes it a moment."""
    config = zenoh.Config()
    config.insert_json5("mode", '"peer"')
    config.insert_json5("connect/endpoints", json.dumps([endpoint]))
    config.insert_json5("scouting/multicast/enabled", "false")
    with zenoh.open(config) as opened:
        until(lambda: tokens(opened), bool)
        with pyzeros.auto_context(node="peer", zenoh_session=opened, domain_id=DOMAIN):
            yield opened


def picture(stamp):
    image = Image()
    image.header.stamp.sec = np.int32(stamp)
    image.header.frame_id = b"camera"
    image.height, image.width, image.step = np.uint32(480), np.uint32(640), np.uint32(1920)
    image.encoding = b"rgb8"
    image.data = np.random.default_rng(stamp).integers(0, 255, 480 * 1920, dtype=np.uint8)
    return image


def within(coroutine):
    return asyncio.run(asyncio.wait_for(coroutine, PATIENCE))


def test_pictures_come_and_times_go(node, session):
    boxes = []
    detections = session.declare_subscriber(
        f"{DOMAIN}/robot/single_shot_detector/**/vision_msgs::msg::dds_::Detection2DArray_/*", boxes.append
    )

    async def run():
        times = pyzeros.Sub(Float32, "/robot/single_shot_detector/processing_time_ms")
        pictures = pyzeros.Pub(Image, "/camera/image_raw")
        listening = times.listen_reliable()
        for stamp in range(1, 6):
            # Discovery takes a moment; nothing is sent again.
            for attempt in range(20):
                pictures.publish(picture(stamp))
                try:
                    taken = await asyncio.wait_for(anext(listening), 3)
                    break
                except TimeoutError:
                    assert attempt < 19, "no picture was answered"
            assert 0 < taken.data < 60_000

    within(run())
    assert len(boxes) >= 5
    first = boxes[0]
    payload, attachment = first.payload.to_bytes(), first.attachment.to_bytes()
    assert payload[:4] == b"\x00\x01\x00\x00" and int.from_bytes(payload[4:8], "little", signed=True) >= 1
    assert b"camera\x00" in payload
    assert len(attachment) == 33 and attachment[16] == 16
    numbers = [int.from_bytes(sample.attachment.to_bytes()[:8], "little") for sample in boxes]
    assert numbers == list(range(numbers[0], numbers[0] + len(numbers)))
    sent = int.from_bytes(attachment[8:16], "little") / 1e9
    assert abs(sent - time.time()) < 600
    detections.undeclare()


def test_ids_follow_from_tokens(node, session):
    # Peers that are establishing a direct connection may not respond for a moment.
    own = until(lambda: tokens(session), lambda own: {parts[5] for parts in own} == {"NN", "MP", "MS", "SS"})
    image = next(parts for parts in own if parts[5] == "MS" and parts[9] == "%camera%image_raw")
    assert image[10:12] == ["sensor_msgs::msg::dds_::Image_", Image.hash_rihs01()]
    times = next(parts for parts in own if parts[5] == "MP" and parts[9].endswith("%processing_time_ms"))
    gids = []
    key = f"{DOMAIN}/robot/single_shot_detector/processing_time_ms/**"
    subscriber = session.declare_subscriber(key, lambda sample: gids.append(sample.attachment.to_bytes()[17:]))

    async def run():
        pictures = pyzeros.Pub(Image, "/camera/image_raw")
        for stamp in range(10, 200):
            pictures.publish(picture(stamp))
            await asyncio.sleep(0.3)
            if gids:
                return

    within(run())
    assert gids[0] == pyzeros.utils.rmw_zenoh_gid("/".join(times))
    subscriber.undeclare()


def test_services_answer(node, session):
    async def run():
        reset = pyzeros.Client(Trigger, "/robot/single_shot_detector/reset")
        await reset.wait_for_service()
        answer = await reset.call_async(Trigger.Request())
        assert answer.success and answer.message

    within(run())


def test_parameters_are_services(node, session):
    """In bytes: PyTerfaces has no lists of structures, hence none of these types."""

    def call(service, request):
        def is_server(parts):
            return parts[5] == "SS" and parts[9] == f"%robot%single_shot_detector%{service}"

        of, digest = until(lambda: list(filter(is_server, tokens(session))), bool)[0][10:12]
        key = f"{DOMAIN}/robot/single_shot_detector/{service}/{of}/{digest}"
        attachment = struct.pack("<qqB", 1, time.time_ns(), 16) + bytes(16)
        answers = session.get(key, payload=b"\0\1\0\0" + request, attachment=attachment)
        return digest, next(iter(answers)).ok.payload.to_bytes()[4:]

    name = struct.pack("<I", 10) + b"threshold\0"
    digest, answer = call("get_parameters", struct.pack("<I", 1) + name)
    assert digest == GET_PARAMETERS
    count, kind = struct.unpack_from("<IB", answer)
    (threshold,) = struct.unpack_from("<d", answer, 16)
    assert (count, kind) == (1, 3) and 0 <= threshold <= 1

    def set_to(number):
        value = struct.pack("<BB4xqd", 3, 0, 0, number) + struct.pack("<I", 1) + b"\0" + bytes(3) + bytes(20)
        _, answer = call("set_parameters", struct.pack("<I", 1) + name + value)
        count, done, length = struct.unpack_from("<IB3xI", answer)
        assert count == 1
        return done, answer[12:][:length]

    done, reason = set_to(7.0)
    assert not done and b"threshold" in reason
    assert set_to(0.25)[0]
    assert struct.unpack_from("<d", call("get_parameters", struct.pack("<I", 1) + name)[1], 16) == (0.25,)


def test_nobody_is_there_without_a_router():
    words = ["single_shot_detector", "--image", "/image", "--offline", "--rmw", "zenoh"]
    override = 'connect/endpoints=["tcp/127.0.0.1:9"]'
    with Node("ros2", *words, ZENOH_CONFIG_OVERRIDE=override, ready=0) as node:
        node.wait_for_line("no Zenoh router is reachable", 120)


def test_a_wrong_override_is_told():
    command = [os.environ["OPENDR_BIN"], "ros2", "run", "single_shot_detector", "--rmw", "zenoh", "--offline"]
    done = subprocess.run(
        command, env={**os.environ, "ZENOH_CONFIG_OVERRIDE": "mode"}, capture_output=True, text=True, timeout=120
    )
    assert done.returncode != 0 and "ZENOH_CONFIG_OVERRIDE" in done.stderr
