#!/usr/bin/env python3
"""Our trackers beside those of the Python package trackers (Apache-2.0), in one run, on one core.

    cargo build --release -p opendr-tracking --example follow
    python3 -m venv /tmp/tracking && /tmp/tracking/bin/pip install trackers
    /tmp/tracking/bin/python benches/tracking.py --follow target/release/examples/follow

25 objects walk about with noise, one in twenty boxes is missed, and boxes cross; both sides get the same boxes. Frames per second of
the trackers alone: reading and writing boxes does not count. Rounds take turns; the figures are medians.
"""

import argparse
import json
import os
import statistics
import subprocess
import time

import numpy as np

PAIRS = ["sort", "byte_track", "oc_sort"]


def scene(objects, frames, seed=0):
    """Boxes `[left, top, width, height, confidence]` of each frame."""
    random = np.random.default_rng(seed)
    size = np.array([1920.0, 1080.0])
    place = random.uniform(0, size, (objects, 2))
    speed = random.normal(0, 4, (objects, 2))
    width = random.uniform(40, 90, objects)
    for _ in range(frames):
        speed += random.normal(0, 0.3, speed.shape)
        place += speed
        outside = (place < 0) | (place > size)
        speed[outside] *= -1
        place = place.clip(0, size)
        seen = random.random(objects) > 0.05
        sides = np.stack([width, 2.5 * width], 1) * (1 + random.normal(0, 0.02, (objects, 1)))
        corners = place + random.normal(0, 1.5, place.shape) - sides / 2
        scores = random.uniform(0.5, 1.0, (objects, 1))
        yield np.concatenate([corners, sides, scores], 1)[seen].astype(np.float32)


def ours(follow, name, frames):
    lines = "".join(json.dumps(frame.tolist()) + "\n" for frame in frames)
    done = subprocess.run([follow, name, "{}"], input=lines, capture_output=True, text=True, check=True)
    *rows, last = done.stdout.splitlines()
    return json.loads(last)["seconds"] / len(frames), sum(len(json.loads(row)) for row in rows)


def theirs(name, frames):
    import supervision
    from trackers import ByteTrackTracker, OCSORTTracker, SORTTracker

    tracker = {"sort": SORTTracker, "byte_track": ByteTrackTracker, "oc_sort": OCSORTTracker}[name]()
    detections = [
        supervision.Detections(
            xyxy=np.concatenate([frame[:, :2], frame[:, :2] + frame[:, 2:4]], 1),
            confidence=frame[:, 4],
            class_id=np.zeros(len(frame), dtype=int),
        )
        for frame in frames
    ]
    told = 0
    begin = time.perf_counter()
    for found in detections:
        told += int((tracker.update(found).tracker_id >= 0).sum())
    return (time.perf_counter() - begin) / len(frames), told


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--follow", required=True, help="crates/perception/tracking/examples/follow.rs, built with --release")
    parser.add_argument("--objects", type=int, default=25)
    parser.add_argument("--frames", type=int, default=2000)
    parser.add_argument("--rounds", type=int, default=3)
    arguments = parser.parse_args()
    if hasattr(os, "sched_setaffinity"):
        os.sched_setaffinity(0, {min(os.sched_getaffinity(0))})
    frames = list(scene(arguments.objects, arguments.frames))
    print(f"{arguments.objects} objects, {arguments.frames} frames, one core")
    for name in PAIRS:
        rounds = [(ours(arguments.follow, name, frames), theirs(name, frames[: arguments.frames // 10])) for _ in range(arguments.rounds)]
        fast, slow = (statistics.median(side[at][0] for side in rounds) for at in (0, 1))
        print(f"{name}: {1 / fast:.0f} frames/s, in Python {1 / slow:.0f}: {slow / fast:.0f} times as fast")


if __name__ == "__main__":
    main()
