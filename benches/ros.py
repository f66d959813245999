#!/usr/bin/env python3
"""Nodes beside rclpy and rospy: what arrives, how long it takes over the library call, what memory it holds.

    cargo xtask ros          # installs the peers
    cargo build --release
    unshare -n sh -c 'ip link set lo up multicast on; ip route add 224.0.0.0/4 dev lo; exec "$0" "$@"' \\
        target/ros-venv/bin/python benches/ros.py [--ros 1] [--learner single_shot_detector] [--quick]

Pictures go from a real peer to the node and detections back to it, in one run: 300 of 640x480 at 30 Hz, 1920x1080 at 25 Hz for
a minute, 100,000 small ones as fast as they go. "Added" is the time from before the peer publishes until it has the answer, less the
time that the node needs for messages and inference together (`processing_time_ms`); the library call alone is measured by
`opendr bench` in the same run.
"""

import argparse
import json
import os
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / "tests/ros"))

import peers  # noqa: E402
from patience import wait_until  # noqa: E402
from node import Node, environment, opendr  # noqa: E402
from pictures import image_fields, noise  # noqa: E402


class Ros2:
    image, float32 = "sensor_msgs/msg/Image", "std_msgs/msg/Float32"
    diagnostics = "diagnostic_msgs/msg/DiagnosticArray"

    def __enter__(self):
        self.domain = peers.new_domain()
        self.more = {"ROS_DOMAIN_ID": self.domain}
        self.peer = peers.Ros2Peer("jazzy", self.domain).__enter__()
        return self

    def __exit__(self, *how):
        self.peer.__exit__(*how)


class Ros1:
    image, float32, diagnostics = "sensor_msgs/Image", "std_msgs/Float32", "diagnostic_msgs/DiagnosticArray"

    def __enter__(self):
        self.folder = tempfile.TemporaryDirectory()
        self.roscore = peers.Roscore(self.folder.name).__enter__()
        self.more = self.roscore.environment
        self.peer = peers.Ros1Peer(self.roscore).__enter__()
        return self

    def __exit__(self, *how):
        self.peer.__exit__(*how)
        self.roscore.__exit__(*how)
        self.folder.cleanup()


def library_ms(learner):
    """p50 of the library call, milliseconds."""
    command = [opendr(), "bench", learner, "--json", "--quiet", "--frames", "50"]
    done = subprocess.run(command, env=environment(), capture_output=True, text=True, check=True)
    return json.loads(done.stdout)["p50_ms"]["total"]


def connected(ros, answers):
    ros.peer.advertise("/image_raw", ros.image)
    wait_until(lambda: ros.peer.subscribers("/image_raw"), 30, "the node's subscription")
    time.sleep(2)
    answers.clear()


def counts(ros, told):
    for message in reversed(list(told.messages)):
        for status in ros.peer.decode(ros.diagnostics, message.data)["status"]:
            if "inference" in status["name"]:
                return {value["key"]: value["value"] for value in status["values"]}
    return {}


def floats(ros, subscription):
    return [ros.peer.decode(ros.float32, message.data)["data"] for message in list(subscription.messages)]


def stream(ros, node, name, output, width, height, rate, count):
    """Sends pictures, every one with its number as stamp; a row of the table."""
    answers = ros.peer.subscribe(f"/{name}/{output[0]}", output[1])
    times = ros.peer.subscribe(f"/{name}/processing_time_ms", ros.float32)
    told = ros.peer.subscribe("/diagnostics", ros.diagnostics)
    connected(ros, answers)
    times.clear()
    rgb = noise(width, height)
    frames = [ros.peer.encode(ros.image, image_fields(width, height, rgb, sec=1, nanosec=index)) for index in range(20 if width > 100 else 1000)]
    before = node.memory()
    sent = ros.peer.publish("/image_raw", ros.image, frames, count=count, rate=rate, timeout=30 + 3 * count / rate)
    time.sleep(2)
    took, number, last = [], -1, None
    for message in list(answers.messages):
        # Stamps go round; the node answers in order, and leaves out less than a round.
        step = (message.stamp[1] - (last if last is not None else -1)) % len(frames) or len(frames)
        number, last = number + step, message.stamp[1]
        took.append((message.at - sent[number]) * 1e-6)
    processing = statistics.median(floats(ros, times))
    third = max(1, len(took) // 3)
    received = counts(ros, told).get("received", "?")
    print(
        f"| {width}x{height} at {rate} Hz | {received} | {len(answers.messages)} of {count} | {statistics.median(took):.2f} "
        f"| {processing:.2f} | {statistics.median(took) - processing:.2f} | {statistics.median(took[:third]):.2f}, "
        f"{statistics.median(took[-third:]):.2f} | {(node.memory() - before) / 1e6:+.1f} |",
        flush=True,
    )
    for subscription in (answers, times, told):
        subscription.close()


def main():
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("--ros", choices=["1", "2"], default="2")
    arguments.add_argument("--learner", default="single_shot_detector")
    arguments.add_argument("--output", default="boxes")
    arguments.add_argument("--message", default="vision_msgs/msg/Detection2DArray")
    arguments.add_argument("--quick", action="store_true", help="ten seconds of the large pictures, 2,000 small ones")
    options = arguments.parse_args()
    print(f"library call of {options.learner}: {library_ms(options.learner):.2f} ms at 1920x1080 (p50)")
    with (Ros1() if options.ros == "1" else Ros2()) as ros, Node(f"ros{options.ros}", options.learner, **ros.more) as node:
        message = options.message.replace("/msg/", "/") if options.ros == "1" else options.message
        output = (options.output, message)
        print("| pictures | received | answered | p50 there and back, ms | processing, ms | added, ms | first, last third, ms | memory, MB |")
        print("|---|---|---|---|---|---|---|---|")
        stream(ros, node, options.learner, output, 640, 480, 30, 300)
        stream(ros, node, options.learner, output, 1920, 1080, 25, 250 if options.quick else 1500)
        stream(ros, node, options.learner, output, 64, 48, 1000, 2_000 if options.quick else 100_000)


if __name__ == "__main__":
    os.environ.setdefault("OPENDR_BIN", str(peers.TARGET / "release/opendr"))
    main()
