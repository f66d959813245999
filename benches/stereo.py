#!/usr/bin/env python3
"""Our stereo matching beside OpenCV's and the same method in NumPy, in one run.

    cargo build --release -p opendr-vision --example disparity
    python3 -m venv /tmp/stereo && /tmp/stereo/bin/pip install numpy opencv-python-headless
    /tmp/stereo/bin/python benches/stereo.py --disparity target/release/examples/disparity --data shared/data/photos

The motorcycle pair of scikit-image 0.17.2 (Middlebury 2014, 741x500), 64 disparities. Milliseconds are those of the fastest round
with pictures in memory; what is bad is more than 2 pixels off, over all pixels with a truth (what is not known is bad) and over
those that are known.
"""

import argparse
import subprocess
import tempfile
import time
from pathlib import Path

import cv2
import numpy as np

DISPARITIES = 64


def timed(work, rounds):
    fastest = np.inf
    for _ in range(rounds):
        begin = time.perf_counter()
        found = work()
        fastest = min(fastest, time.perf_counter() - begin)
    return fastest, found


def ours(program, data, rounds):
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder) / "disparities"
        pair = [str(data / f"motorcycle_{side}.png") for side in ("left", "right")]
        done = subprocess.run([program, *pair, out, str(rounds)], capture_output=True, text=True, check=True)
        return float(done.stdout), np.fromfile(out, np.float32)


def opencv(mode, left, right):
    matcher = cv2.StereoSGBM_create(
        0, DISPARITIES, 5, P1=8 * 25, P2=32 * 25, disp12MaxDiff=1, uniquenessRatio=10,
        speckleWindowSize=100, speckleRange=2, mode=getattr(cv2, f"StereoSGBM_MODE_{mode}"),
    )
    return lambda: matcher.compute(left, right) / 16


def census(grey):
    padded = np.pad(grey, ((3, 3), (4, 4)), "edge").astype(np.int16)
    height, width = grey.shape
    words = np.zeros(grey.shape, np.uint64)
    for dy in range(7):
        for dx in range(9):
            if (dy, dx) != (3, 4):
                darker = padded[dy : dy + height, dx : dx + width] < grey
                words = words << np.uint64(1) | darker.astype(np.uint64)
    return words


def along(costs, dy, dx, small=8, large=40):
    """Sums of one path, row by row or column by column."""
    if dy == 0:
        return along(costs.transpose(1, 0, 2), dx, 0).transpose(1, 0, 2)
    rows = range(len(costs)) if dy > 0 else range(len(costs) - 1, -1, -1)
    sums = np.empty_like(costs)
    before = None
    for row in rows:
        if before is None:
            sums[row] = costs[row]
        else:
            moved = np.zeros_like(before)
            source, there = (slice(None, -dx), slice(dx, None)) if dx > 0 else (slice(-dx, None), slice(None, dx or None))
            moved[there] = before[source]
            least = moved.min(1, keepdims=True)
            wide = np.pad(moved, ((0, 0), (1, 1)), constant_values=9999)
            near = np.minimum(wide[:, :-2], wide[:, 2:]) + small
            sums[row] = costs[row] + np.minimum(np.minimum(moved, near), least + large) - least
        before = sums[row]
    return sums


def in_numpy(left, right):
    words = census(left), census(right)
    costs = np.full((*left.shape, DISPARITIES), 31, np.int16)
    for disparity in range(DISPARITIES):
        pair = words[0][:, disparity:], words[1][:, : left.shape[1] - disparity]
        costs[:, disparity:, disparity] = np.bitwise_count(pair[0] ^ pair[1])
    ways = [(dy, dx) for dy in (-1, 0, 1) for dx in (-1, 0, 1) if (dy, dx) != (0, 0)]
    return sum(along(costs, dy, dx) for dy, dx in ways).argmin(2).astype(np.float32)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--disparity", required=True, help="crates/vision/examples/disparity.rs, built with --release")
    parser.add_argument("--data", required=True, type=Path, help="where motorcycle_left.png is")
    parser.add_argument("--rounds", type=int, default=10)
    arguments = parser.parse_args()
    truth = np.load(arguments.data / "motorcycle_disp.npz")["arr_0"]
    read = lambda side: cv2.imread(str(arguments.data / f"motorcycle_{side}.png"), cv2.IMREAD_GRAYSCALE)
    left, right = read("left"), read("right")
    runs = {"ours, 8 paths": ours(arguments.disparity, arguments.data, arguments.rounds)}
    for mode, paths in [("SGBM", 5), ("SGBM_3WAY", 3), ("HH", 8)]:
        runs[f"OpenCV {mode}, {paths} paths"] = timed(opencv(mode, left, right), arguments.rounds)
    runs["NumPy, 8 paths, nothing checked"] = timed(lambda: in_numpy(left, right), 1)
    fastest = runs["ours, 8 paths"][0]
    has_truth = np.isfinite(truth) & (truth > 0)
    for name, (seconds, found) in runs.items():
        found = found.reshape(truth.shape)
        is_known = found > 0
        bad = ~is_known | (abs(found - truth) > 2)
        print(
            f"{name}: {1000 * seconds:.1f} ms ({fastest / seconds:.2f} of its time is ours), bad 2.0 "
            f"{100 * bad[has_truth].mean():.1f} %, of the known {100 * bad[has_truth & is_known].mean():.1f} %"
        )


if __name__ == "__main__":
    main()
