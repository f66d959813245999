#!/usr/bin/env python3
"""Tiled detection in 4K pictures: what it finds, how fast, and a Python loop over tiles (as SAHI does it) in the same run.

    cargo build --release -p opendr --example infer_json
    python3 -m venv /tmp/tiling && /tmp/tiling/bin/pip install numpy opencv-python-headless onnxruntime
    /tmp/tiling/bin/python benches/tiling.py --infer target/release/examples/infer_json --coco128 shared/data/coco128 \\
        --onnx nanodet.onnx

Persons and cars of COCO128, shrunk until their longer side has 24 pixels, stand on a ground of soft noise; a third of them walk,
4 pixels a frame. A box counts as found when one of its class overlaps it by half. Recall is of the second half of the frames,
when a budget has had time to look around; the time of a frame is that of the call alone, without decoding. `--onnx` is the network of the detector's container.
"""

import argparse
import json
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import cv2
import numpy as np

CLASSES = {0: "person", 2: "car"}
SIZE = (3840, 2160)
LONG = 24
AROUND = 0.4


def cuttings(folder):
    """Pictures of persons and cars with what is around them, with the place of the thing in it."""
    found = []
    for label in sorted(folder.glob("object_detection/labels/*/*.txt")):
        picture = next(iter(folder.glob(f"images/*/{label.stem}.jpg")), None)
        if picture is None:
            continue
        image = cv2.imread(str(picture))
        height, width = image.shape[:2]
        for line in label.read_text().splitlines():
            name, x, y, across, down = line.split()
            across, down = float(across) * width, float(down) * height
            x0, y0 = float(x) * width - across / 2, float(y) * height - down / 2
            if int(name) not in CLASSES or max(across, down) < 80 or min(across, down) < 30:
                continue
            pad = AROUND * max(across, down)
            left, top = max(0, int(x0 - pad)), max(0, int(y0 - pad))
            right, bottom = min(width, int(x0 + across + pad)), min(height, int(y0 + down + pad))
            scale = LONG / max(across, down)
            sides = (max(1, round((right - left) * scale)), max(1, round((bottom - top) * scale)))
            small = cv2.resize(image[top:bottom, left:right], sides, interpolation=cv2.INTER_AREA)
            place = np.array([x0 - left, y0 - top, across, down]) * scale
            found.append((int(name), small, place))
    return found


def scene(things, count, frames, seed=0):
    """Pictures and the true boxes `(class, left, top, width, height)` in each."""
    random = np.random.default_rng(seed)
    ground = cv2.resize(random.normal(0, 1, (27, 48, 3)), SIZE, interpolation=cv2.INTER_CUBIC) * 12 + 130
    ground = ground.clip(0, 255).astype(np.uint8)
    picked = [things[at] for at in random.permutation(len(things))[:count]]
    places, speeds = [], []
    for number, (_, small, _) in enumerate(picked):
        height, width = small.shape[:2]
        while True:
            place = random.uniform([100, 100], [SIZE[0] - 200, SIZE[1] - 200])
            if all(np.abs(place - other).max() > 130 for other in places):
                break
        places.append(place)
        angle = random.uniform(0, 2 * np.pi)
        speeds.append(4 * np.array([np.cos(angle), np.sin(angle)]) * (number % 3 == 0))
    for frame in range(frames):
        picture, truth = ground.copy(), []
        for (name, small, box), place, speed in zip(picked, places, speeds):
            # To and fro, so that nothing leaves the image.
            x, y = (place + (20 - abs(frame % 40 - 20)) * speed).round().astype(int)
            height, width = small.shape[:2]
            picture[y : y + height, x : x + width] = small
            truth.append((name, x + box[0], y + box[1], box[2], box[3]))
        yield picture, truth


def overlap(a, b):
    across = min(a[0] + a[2], b[0] + b[2]) - max(a[0], b[0])
    down = min(a[1] + a[3], b[1] + b[3]) - max(a[1], b[1])
    shared = max(across, 0) * max(down, 0)
    return shared / (a[2] * a[3] + b[2] * b[3] - shared)


def recall(truths, answers):
    """The share of objects that are detected, and the number of false positives per frame."""
    there = hit = extra = 0
    for truth, found in zip(truths, answers):
        used = set()
        for name, *box in truth:
            fits = [at for at, (other, *place) in enumerate(found) if other == name and at not in used and overlap(box, place) >= 0.5]
            used.update(fits[:1])
            hit += bool(fits)
        there += len(truth)
        extra += len(found) - len(used)
    return hit / there, extra / len(truths)


def ours(infer, learner, params, files):
    inputs = [word for at, file in enumerate(files) for word in ([","] if at else []) + [f"image={file}"]]
    done = subprocess.run([infer, "--seconds", learner, json.dumps(params), *inputs], stdout=subprocess.PIPE, text=True, check=True)
    *rows, seconds = map(json.loads, done.stdout.splitlines())
    boxes = [
        [(b["name"], b["left"], b["top"], b["width"], b["height"]) for b in row["boxes"]["boxes"]] for row in rows
    ]
    return boxes, seconds


def slicing(onnx, picture, tile=256, overlap_pixels=48, threads=2):
    """Every tile of an image through NanoDet, in Python, with its duration in seconds."""
    import onnxruntime

    options = onnxruntime.SessionOptions()
    options.intra_op_num_threads = threads
    session = onnxruntime.InferenceSession(onnx, options, providers=["CPUExecutionProvider"])
    name, outputs = session.get_inputs()[0].name, {output.name: at for at, output in enumerate(session.get_outputs())}
    mean, std = np.float32([103.53, 116.28, 123.675]), np.float32([57.375, 57.12, 58.395])
    grids = [(8, "Identity", "Identity_3"), (16, "Identity_1", "Identity_4"), (32, "Identity_2", "Identity_5")]
    begin = time.perf_counter()
    boxes, scores, tiles = [], [], 0
    starts = [sorted({min(at, side - tile) for at in range(0, side, tile - overlap_pixels)}) for side in SIZE]
    for top in starts[1]:
        for left in starts[0]:
            tiles += 1
            part = cv2.resize(picture[top : top + tile, left : left + tile], (416, 416)).astype(np.float32)
            answers = session.run(None, {name: ((part - mean) / std).transpose(2, 0, 1)[None]})
            for stride, classes, distances in grids:
                score = answers[outputs[classes]].reshape(-1, 80)
                cells = np.nonzero(score.max(1) >= 0.35)[0]
                spread = answers[outputs[distances]].reshape(-1, 4, 11)[cells]
                spread = np.exp(spread - spread.max(-1, keepdims=True))
                sides = (spread / spread.sum(-1, keepdims=True) * np.arange(11)).sum(-1) * stride
                columns = 416 // stride
                x, y = (cells % columns + 0.5) * stride, (cells // columns + 0.5) * stride
                corners = np.stack([x - sides[:, 0], y - sides[:, 1], sides[:, 0] + sides[:, 2], sides[:, 1] + sides[:, 3]], 1)
                corners = corners * tile / 416 + [left, top, 0, 0]
                boxes.extend(corners.tolist())
                scores.extend(score[cells].max(1).tolist())
    kept = cv2.dnn.NMSBoxes(boxes, scores, 0.35, 0.5) if boxes else []
    return time.perf_counter() - begin, tiles, len(kept)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--infer", required=True, help="crates/opendr/examples/infer_json.rs, built with --release")
    parser.add_argument("--coco128", required=True, type=Path, help="has images/ and object_detection/labels/")
    parser.add_argument("--onnx", help="NanoDet, to compare with Python")
    parser.add_argument("--objects", type=int, default=40)
    parser.add_argument("--frames", type=int, default=24)
    parser.add_argument("--budget", type=float, default=90, help="milliseconds a frame")
    parser.add_argument("--variants", nargs="*", default=["nanodet", "centernet"])
    parser.add_argument("--params", default="{}", help="further parameters of the tiled learner, JSON")
    arguments = parser.parse_args()
    things = cuttings(arguments.coco128)
    print(f"{len(things)} persons and cars to pick from; {arguments.objects} in a {SIZE[0]}x{SIZE[1]} picture, {LONG} px long")
    with tempfile.TemporaryDirectory() as folder:
        files, truths = [], []
        for at, (picture, truth) in enumerate(scene(things, arguments.objects, arguments.frames)):
            files.append(f"{folder}/{at:03}.png")
            cv2.imwrite(files[-1], picture, [cv2.IMWRITE_PNG_COMPRESSION, 1])
            truths.append(truth)
        for variant in arguments.variants:
            cases = [("plain", variant, {}), ("tiled, no limit", f"tiled_detection/{variant}", {}), ("tiled, every tile", f"tiled_detection/{variant}", {"detail_threshold": 0.0, "change_threshold": 0.0})]
            cases.append((f"tiled, {arguments.budget:.0f} ms", f"tiled_detection/{variant}", {"time_budget": arguments.budget}))
            for what, learner, params in cases:
                few = files[:3] if "every" in what else files
                further = json.loads(arguments.params) if learner != variant else {}
                boxes, seconds = ours(arguments.infer, learner, {**params, **further}, few)
                share, extra = recall(truths[len(few) // 2 : len(few)], boxes[len(few) // 2 :])
                rest = seconds[1:]
                print(
                    f"{variant}, {what}: recall {share:.3f}, {extra:.1f} boxes more a frame; first frame {1e3 * seconds[0]:.0f} ms,"
                    f" then median {1e3 * statistics.median(rest):.1f} ms ({1 / statistics.median(rest):.1f} FPS), worst {1e3 * max(rest):.0f} ms",
                    flush=True,
                )
        if arguments.onnx:
            seconds, tiles, count = slicing(arguments.onnx, cv2.imread(files[-1]))
            print(f"Python over all {tiles} tiles: {1e3 * seconds:.0f} ms a frame, {1e3 * seconds / tiles:.1f} ms a tile, {count} boxes")


if __name__ == "__main__":
    sys.exit(main())
