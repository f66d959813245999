#!/usr/bin/env python3
"""Our voxelisation and turned suppression beside NumPy and Shapely, in one run, on one core.

    cargo build --release -p opendr-clouds --example space_speed
    python3 -m venv /tmp/space && /tmp/space/bin/pip install numpy shapely
    /tmp/space/bin/python benches/space.py --speed target/release/examples/space_speed

Points are a scan of a flat street with walls, or a KITTI file that is given; boxes lie in heaps, as a detector returns them. The
reference sorts points into pillars as mmdetection3d's dynamic voxelisation does (cells of all points, then unique cells with
sums), writes an image of four numbers per pillar, and drops boxes by polygons of Shapely (GEOS), with circles first. Both sides
must find the same pillars and keep as many boxes. Seconds are medians.
"""

import argparse
import json
import os
import statistics
import subprocess
import tempfile
import time
from pathlib import Path

import numpy as np

LOW, HIGH, SIDE = np.array([0, -39.68, -3], np.float32), np.array([69.12, 39.68, 1], np.float32), np.float32(0.16)
COLUMNS, ROWS = 432, 496
OVERLAP = 0.1


def scan(random, rings=64, rays=2083):
    """x, y, z and reflectance of a turn over flat ground with round walls."""
    elevation = np.radians(np.linspace(2, -24.8, rings))[:, None]
    azimuth = np.linspace(-np.pi, np.pi, rays)[None]
    wall = 15 + 20 * (np.floor(azimuth * 5) % 3)
    ground = np.where(elevation < 0, 1.73 / np.tan(np.maximum(-elevation, 1e-3)), 200)
    distance = np.minimum(ground, wall) + random.normal(0, 0.02, (rings, rays))
    xyz = np.stack([distance * np.cos(azimuth), distance * np.sin(azimuth), distance * np.tan(elevation)], -1)
    return np.concatenate([xyz.reshape(-1, 3), random.random((rings * rays, 1))], 1).astype(np.float32)


def heaps(random, objects=25, each=16):
    """x, y, length, width, yaw and score of boxes."""
    middle = np.stack([random.uniform(0, 69, objects), random.uniform(-39, 39, objects)], 1)
    yaw = random.uniform(-np.pi, np.pi, objects)
    rows = []
    for at in range(objects):
        for _ in range(each):
            place = middle[at] + random.normal(0, 0.3, 2)
            size = np.array([3.9, 1.6]) * random.normal(1, 0.05, 2)
            rows.append([*place, *size, yaw[at] + random.normal(0, 0.1), random.random()])
    return np.array(rows, np.float32)


def voxelise(points):
    inside = np.all((points[:, :3] >= LOW) & (points[:, :3] < HIGH), axis=1)
    points = points[inside]
    cells = ((points[:, :2] - LOW[:2]) / SIDE).astype(np.int32)
    cells = np.minimum(cells, [COLUMNS - 1, ROWS - 1])
    flat = cells[:, 1] * COLUMNS + cells[:, 0]
    unique, inverse, counts = np.unique(flat, return_inverse=True, return_counts=True)
    middle = LOW[:2] + (cells + 0.5) * SIDE
    offsets = np.concatenate([points[:, :2] - middle, points[:, 2:3]], 1)
    canvas = np.zeros((4, ROWS * COLUMNS), np.float32)
    canvas[0, unique] = np.log(counts)
    for axis in range(3):
        canvas[axis + 1, unique] = np.bincount(inverse, offsets[:, axis], len(unique)) / counts
    return len(points), len(unique)


def suppress(boxes):
    from shapely import affinity, geometry

    boxes = boxes[np.argsort(-boxes[:, 5])]
    polygons = []
    for x, y, length, width, yaw, _ in boxes.astype(float):
        polygon = geometry.box(-length / 2, -width / 2, length / 2, width / 2)
        polygons.append(affinity.translate(affinity.rotate(polygon, yaw, (0, 0), use_radians=True), x, y))
    reach = np.hypot(boxes[:, 2], boxes[:, 3]) / 2
    dropped = np.zeros(len(boxes), bool)
    kept = 0
    for best in range(len(boxes)):
        if dropped[best]:
            continue
        kept += 1
        apart = np.hypot(boxes[best + 1 :, 0] - boxes[best, 0], boxes[best + 1 :, 1] - boxes[best, 1])
        for other in np.flatnonzero(apart <= reach[best] + reach[best + 1 :]) + best + 1:
            if not dropped[other]:
                shared = polygons[best].intersection(polygons[other]).area
                union = polygons[best].area + polygons[other].area - shared
                dropped[other] = shared / union > OVERLAP
    return kept


def timed(run, rounds):
    seconds = []
    for _ in range(rounds):
        begin = time.perf_counter()
        answer = run()
        seconds.append(time.perf_counter() - begin)
    return statistics.median(seconds), answer


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--speed", required=True, help="crates/perception/clouds/examples/space_speed.rs, built with --release")
    parser.add_argument("--points", help="a KITTI file of points instead of a made one")
    parser.add_argument("--rounds", type=int, default=5)
    arguments = parser.parse_args()
    if hasattr(os, "sched_setaffinity"):
        os.sched_setaffinity(0, {min(os.sched_getaffinity(0))})
    random = np.random.default_rng(0)
    points = np.fromfile(arguments.points, np.float32).reshape(-1, 4) if arguments.points else scan(random)
    boxes = heaps(random)
    with tempfile.TemporaryDirectory() as folder:
        files = [Path(folder, name) for name in ("points.bin", "boxes.bin")]
        points.tofile(files[0])
        boxes.tofile(files[1])
        told = subprocess.run([arguments.speed, *files], capture_output=True, text=True, check=True).stdout
    ours = json.loads(told)
    seconds, (inside, pillars) = timed(lambda: voxelise(points), arguments.rounds)
    # A point on the edge of a cell may fall on either side.
    assert abs(inside - ours["points"]) <= 2 and abs(pillars - ours["pillars"]) <= 1e-3 * pillars, (inside, pillars, ours)
    share = ours["voxelise"] / seconds
    print(f"voxelisation of {len(points)} points into {pillars} pillars: {1e3 * ours['voxelise']:.2f} ms, ", end="")
    print(f"NumPy {1e3 * seconds:.2f} ms: {share:.3f} of its time")
    seconds, kept = timed(lambda: suppress(boxes), arguments.rounds)
    assert kept == ours["kept"], (kept, ours)
    share = ours["suppress"] / seconds
    print(f"suppression of {len(boxes)} turned boxes, {kept} kept: {1e3 * ours['suppress']:.3f} ms, ", end="")
    print(f"Shapely {1e3 * seconds:.2f} ms: {share:.4f} of its time")


if __name__ == "__main__":
    main()
