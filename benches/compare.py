#!/usr/bin/env python3
"""Our pipeline beside the same pipeline in Python (OpenCV, NumPy, ONNX Runtime), in one run, on the same machine.

    benches/compare.py --opendr target/release/opendr --data ../shared [--threads 2]

From a decoded 1080p frame to boxes: pre- plus post-processing, session, whole, as medians and as ratios; and frames per
second over a folder of 200 JPEGs, decoding included. Both sides run the same ONNX file with the same ONNX Runtime
library (set ORT_DYLIB_PATH to the one that Python imports). Needs numpy, onnxruntime, opencv-python-headless.
"""

import argparse
import json
import os
import shutil
import statistics
import subprocess
import tempfile
import time
from pathlib import Path

import cv2
import numpy as np
import onnxruntime

ROUNDS = 5


def suppress(boxes, scores, classes, threshold, overlap):
    """Per-class hard suppression by OpenCV."""
    if len(boxes) == 0:
        return []
    rectangles = np.concatenate([boxes[:, :2], boxes[:, 2:] - boxes[:, :2]], axis=1)
    return cv2.dnn.NMSBoxesBatched(rectangles, scores, classes, threshold, overlap)


class Centernet:
    name, threshold = "centernet", 0.3

    def pre(self, frame):
        picture = cv2.cvtColor(cv2.resize(frame, (512, 512)), cv2.COLOR_BGR2RGB)
        return np.ascontiguousarray(picture.astype(np.float32).transpose(2, 0, 1)[None])

    def post(self, outputs, frame):
        rows = outputs["tower_0/detections"][0]
        rows = rows[rows[:, 4] >= self.threshold]
        kept = suppress(rows[:, :4], rows[:, 4], rows[:, 5].astype(np.int32), self.threshold, 0.5)
        height, width = frame.shape[:2]
        return rows[kept, :4] * np.array([width, height, width, height]) / 512


class Nanodet:
    name, threshold = "nanodet", 0.35
    mean = np.array([103.53, 116.28, 123.675], dtype=np.float32)
    deviation = np.array([57.375, 57.12, 58.395], dtype=np.float32)
    bins = np.arange(11, dtype=np.float32)

    def pre(self, frame):
        picture = (cv2.resize(frame, (416, 416)).astype(np.float32) - self.mean) / self.deviation
        return np.ascontiguousarray(picture.transpose(2, 0, 1)[None])

    def post(self, outputs, frame):
        boxes, scores, classes = [], [], []
        for stride, score, distance in ((8, "", "_3"), (16, "_1", "_4"), (32, "_2", "_5")):
            score, distance = outputs[f"Identity{score}"][0], outputs[f"Identity{distance}"][0]
            cell, found = np.nonzero(score >= self.threshold)
            if len(cell) == 0:
                continue
            logits = distance[cell].reshape(-1, 4, 11)
            weights = np.exp(logits - logits.max(axis=2, keepdims=True))
            sides = (weights @ self.bins) / weights.sum(axis=2) * stride
            side = 416 // stride
            x, y = (cell % side + 0.5) * stride, (cell // side + 0.5) * stride
            boxes.append(np.stack([x - sides[:, 0], y - sides[:, 1], x + sides[:, 2], y + sides[:, 3]], axis=1))
            scores.append(score[cell, found])
            classes.append(found)
        if not boxes:
            return np.empty((0, 4))
        boxes, scores = np.concatenate(boxes), np.concatenate(scores)
        kept = suppress(boxes, scores, np.concatenate(classes).astype(np.int32), self.threshold, 0.6)
        height, width = frame.shape[:2]
        return boxes[kept] * np.array([width, height, width, height]) / 416


class Python:
    """A learner's pipeline in Python over the container that the command uses."""

    def __init__(self, learner, container, threads):
        self.learner = learner
        options = onnxruntime.SessionOptions()
        options.intra_op_num_threads = threads
        self.session = onnxruntime.InferenceSession(
            str(container / "model.onnx"), options, providers=["CPUExecutionProvider"]
        )
        self.input = self.session.get_inputs()[0].name
        self.outputs = [output.name for output in self.session.get_outputs()]

    def run(self, frame):
        """Milliseconds before, in and after the session."""
        start = time.perf_counter()
        tensor = self.learner.pre(frame)
        ready = time.perf_counter()
        outputs = dict(zip(self.outputs, self.session.run(None, {self.input: tensor}), strict=True))
        done = time.perf_counter()
        self.learner.post(outputs, frame)
        end = time.perf_counter()
        return [1e3 * (ready - start), 1e3 * (done - ready), 1e3 * (end - done)]

    def measure(self, frame, frames):
        for _ in range(10):
            self.run(frame)
        rows = np.array([self.run(frame) for _ in range(frames)])
        pre, session, post = np.median(rows, axis=0)
        return {"ours": pre + post, "session": session, "total": np.median(rows.sum(axis=1))}


def command(opendr, *arguments):
    done = subprocess.run([opendr, *map(str, arguments)], capture_output=True, text=True, check=True)
    return done.stdout


def rust(opendr, learner, picture, frames):
    report = json.loads(command(opendr, "bench", learner, picture, "--frames", frames, "--json", "--quiet"))
    stages = report["p50_ms"]
    return {
        "ours": stages["pre"] + stages["post"],
        "session": stages["session"],
        "total": stages["total"],
        "peak": report["peak_memory_mb"],
    }


def one_frame(arguments, learner, container, picture):
    frame = cv2.imread(str(picture))
    python, rounds = Python(learner, container, arguments.threads), []
    for _ in range(ROUNDS):
        rounds.append((rust(arguments.opendr, learner.name, picture, 60), python.measure(frame, 60)))
    ratio = lambda top, bottom: statistics.median(top(ours, theirs) / bottom(ours, theirs) for ours, theirs in rounds)
    median = lambda side, key: statistics.median(pair[side][key] for pair in rounds)
    print(f"{learner.name}, 1080p frame to boxes, {arguments.threads} threads, median of {ROUNDS} rounds of 60:")
    for side, name in ((0, "opendr"), (1, "python")):
        own, session, total = (median(side, key) for key in ("ours", "session", "total"))
        print(f"  {name}: pre+post {own:.2f} ms, session {session:.2f} ms, whole {total:.2f} ms")
    print(f"  pre+post ratio {ratio(lambda o, t: o['ours'], lambda o, t: t['ours']):.2f} (aim 0.35)")
    print(f"  whole / bare session {ratio(lambda o, t: o['total'], lambda o, t: t['session']):.2f} (aim 1.10)")
    print(f"  whole / Python {ratio(lambda o, t: o['total'], lambda o, t: t['total']):.2f} (aim 1.00)")
    print(f"  peak memory {median(0, 'peak'):.0f} MB (aim 200)")


def folder(arguments, learner, container, pictures):
    """Frames per second over a folder of 200 JPEGs, process start and model loading left out on both sides."""
    with tempfile.TemporaryDirectory() as place:
        for number in range(200):
            shutil.copy(pictures[number % len(pictures)], Path(place) / f"{number:03}.jpg")
        files, few, ratios = sorted(Path(place).iterdir()), Path(place) / "few", []
        few.mkdir()
        shutil.copy(files[0], few / "0.jpg")
        python = Python(learner, container, arguments.threads)
        for _ in range(ROUNDS):
            start = time.perf_counter()
            command(arguments.opendr, "infer", learner.name, few, "--quiet")
            alone = time.perf_counter()
            command(arguments.opendr, "infer", learner.name, f"{place}/*.jpg", "--quiet")
            ours = 200 / (time.perf_counter() - alone - (alone - start))
            start = time.perf_counter()
            for file in files:
                python.run(cv2.imread(str(file)))
            theirs = 200 / (time.perf_counter() - start)
            ratios.append((ours, theirs))
    ours, theirs = (statistics.median(pair[side] for pair in ratios) for side in (0, 1))
    ratio = statistics.median(ours / theirs for ours, theirs in ratios)
    print(f"{learner.name}, 200 JPEGs: opendr {ours:.1f}/s, python {theirs:.1f}/s, ratio {ratio:.2f} (aim 1.30)")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--opendr", default="target/release/opendr")
    parser.add_argument("--data", type=Path, default=Path("../shared"))
    parser.add_argument("--threads", type=int, default=2)
    arguments = parser.parse_args()
    os.environ["OPENDR_THREADS"] = str(arguments.threads)
    cv2.setNumThreads(arguments.threads)
    with tempfile.TemporaryDirectory() as place:
        picture = Path(place) / "frame.png"
        cv2.imwrite(str(picture), cv2.resize(cv2.imread(str(arguments.data / "data/photos/zidane.jpg")), (1920, 1080)))
        for learner in (Centernet(), Nanodet()):
            line = command(arguments.opendr, "download", learner.name, "--quiet")
            container = Path(line.strip().split(": ", 1)[1])
            one_frame(arguments, learner, container, picture)
            folder(arguments, learner, container, sorted((arguments.data / "data/coco128/images/val2017").glob("*.jpg")))


if __name__ == "__main__":
    main()
