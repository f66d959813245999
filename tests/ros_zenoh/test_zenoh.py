"""A node over Zenoh beside PyZeROS and a Zenoh router: keys, hashes, attachments, services.

Run by `cargo xtask ros --zenoh`, which builds the command with the feature `zenoh`.
"""

import asyncio
import json
import os
import socket
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
from ros2_pyterfaces.cydr.rcl_interfaces.srv import GetParameters, SetParameters  # noqa: E402
from ros2_pyterfaces.cydr.std_srvs.srv import Trigger  # noqa: E402

DOMAIN = "7"
PATIENCE = 60


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


@pytest.fixture
def session(endpoint):
    config = zenoh.Config()
    config.insert_json5("mode", '"peer"')
    config.insert_json5("connect/endpoints", json.dumps([endpoint]))
    config.insert_json5("scouting/multicast/enabled", "false")
    with zenoh.open(config) as opened:
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
    tokens = [str(reply.ok.key_expr) for reply in session.liveliness().get(f"@ros2_lv/{DOMAIN}/**")]
    own = [token.split("/") for token in tokens if "/%robot/single_shot_detector" in token]
    assert {parts[5] for parts in own} == {"NN", "MP", "MS", "SS"}
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
        get = pyzeros.Client(GetParameters, "/robot/single_shot_detector/get_parameters")
        await get.wait_for_service()
        answer = await get.call_async(GetParameters.Request(names=[b"threshold"]))
        assert len(answer.values) == 1 and 0 <= answer.values[0].double_value <= 1
        wrong = SetParameters.Request()
        parameter = answer.values[0]
        parameter.double_value = np.float64(7)
        from ros2_pyterfaces.cydr.all_msgs import Parameter

        wrong.parameters = [Parameter(name=b"threshold", value=parameter)]
        put = pyzeros.Client(SetParameters, "/robot/single_shot_detector/set_parameters")
        await put.wait_for_service()
        answer = await put.call_async(wrong)
        assert not answer.results[0].successful and b"threshold" in bytes(answer.results[0].reason)

    within(run())


def test_nobody_is_there_without_a_router():
    words = ["single_shot_detector", "--image", "/image", "--offline", "--rmw", "zenoh"]
    override = 'connect/endpoints=["tcp/127.0.0.1:9"]'
    with Node("ros2", *words, ZENOH_CONFIG_OVERRIDE=override, ready=0) as node:
        node.wait_for_line("no Zenoh router is there yet", 120)


def test_a_wrong_override_is_told():
    command = [os.environ["OPENDR_BIN"], "ros2", "run", "single_shot_detector", "--rmw", "zenoh", "--offline"]
    done = subprocess.run(
        command, env={**os.environ, "ZENOH_CONFIG_OVERRIDE": "mode"}, capture_output=True, text=True, timeout=120
    )
    assert done.returncode != 0 and "ZENOH_CONFIG_OVERRIDE" in done.stderr
