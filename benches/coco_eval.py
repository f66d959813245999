#!/usr/bin/env python3
"""COCO's evaluation of boxes beside pycocotools, faster-coco-eval and hotcoco, in one run, on the same machine.

    cargo build --release
    benches/coco_eval.py [--program target/release/opendr] [--threads 2] [--rounds 5]

From two JSON files on disk to the twelve numbers: 5,000 synthetic images, 36,000 objects of 80 classes, 100 detections
per image. Seconds of the whole process for ours, without start and imports for the others. Needs numpy, pycocotools,
faster-coco-eval, hotcoco.
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

PICTURES, OBJECTS, DETECTIONS, CLASSES = 5_000, 36_000, 100, 80
WIDTH, HEIGHT = 640, 480

PEERS = {
    "pycocotools": "from pycocotools.coco import COCO; from pycocotools.cocoeval import COCOeval as Evaluation",
    "faster-coco-eval": "from faster_coco_eval import COCO, COCOeval_faster as Evaluation",
    "hotcoco": "from hotcoco import COCO, COCOeval as Evaluation",
}
PEER = """
import contextlib, io, json, resource, time
{imports}
start = time.perf_counter()
with contextlib.redirect_stdout(io.StringIO()):
    truth = COCO({truth!r})
    found = truth.loadRes({results!r})
    evaluation = Evaluation(truth, found, "bbox")
    evaluation.evaluate()
    evaluation.accumulate()
    evaluation.summarize()
seconds = time.perf_counter() - start
print(json.dumps([seconds, resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024, [float(n) for n in evaluation.stats]]))
"""


def write_files(truth, results):
    """Four of ten detections are moved objects, the others lie anywhere."""
    import numpy as np

    rng = np.random.default_rng(0)
    rounded = lambda numbers: [round(float(number), 2) for number in numbers]

    def anywhere():
        size = np.exp(rng.uniform(np.log(6), np.log(400), 2))
        return np.concatenate([rng.uniform(0, 1, 2) * np.maximum([WIDTH, HEIGHT] - size, 1), size])

    pictures, annotations = [[] for _ in range(PICTURES)], []
    for number in range(OBJECTS):
        picture, box = int(rng.integers(PICTURES)), rounded(anywhere())
        entry = dict(id=number + 1, image_id=picture + 1, category_id=int(rng.integers(1, CLASSES + 1)), bbox=box)
        entry |= dict(area=round(box[2] * box[3] * 0.7, 4), iscrowd=int(rng.random() < 0.01))
        annotations.append(entry)
        pictures[picture].append(entry)
    images = [dict(id=at + 1, width=WIDTH, height=HEIGHT, file_name=f"{at + 1:012}.jpg") for at in range(PICTURES)]
    categories = [dict(id=at + 1, name=f"class {at + 1}") for at in range(CLASSES)]
    truth.write_text(json.dumps(dict(images=images, categories=categories, annotations=annotations)))
    found = []
    for at, objects in enumerate(pictures):
        for _ in range(DETECTIONS):
            if objects and rng.random() < 0.4:
                near = objects[rng.integers(len(objects))]
                box = np.array(near["bbox"])
                box = box + rng.normal(0, box[2:].min() * 0.15, 4)
                box[2:] = np.maximum(box[2:], 1)
                name, score = near["category_id"], rng.beta(3, 2)
            else:
                box, name, score = anywhere(), int(rng.integers(1, CLASSES + 1)), rng.beta(1, 6)
            found.append(dict(image_id=at + 1, category_id=name, bbox=rounded(box), score=round(float(score), 5)))
    results.write_text(json.dumps(found))


#: In the order of pycocotools.
NUMBERS = ["map", "map50", "map75", "map_small", "map_medium", "map_large"]
NUMBERS += ["mar1", "mar10", "mar", "mar_small", "mar_medium", "mar_large"]


def ours(program, threads, truth, results):
    start = time.perf_counter()
    command = [program, "score", results, truth, "--metric", "coco_detection", "--threads", str(threads), "--json"]
    process = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
    answer = process.stdout.read()
    _, status, usage = os.wait4(process.pid, 0)
    seconds = time.perf_counter() - start
    assert status == 0
    scalars = json.loads(answer)["scalars"]
    return [seconds, usage.ru_maxrss / 1024, [scalars.get(name, -1.0) for name in NUMBERS]]


def peer(name, truth, results):
    code = PEER.format(imports=PEERS[name], truth=str(truth), results=str(results))
    return json.loads(subprocess.run([sys.executable, "-c", code], stdout=subprocess.PIPE, text=True, check=True).stdout)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", default="target/release/opendr")
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--without", nargs="*", default=[], choices=PEERS, help="slow peers to leave out")
    parser.add_argument("--write", type=Path, nargs=2, help=argparse.SUPPRESS)
    arguments = parser.parse_args()
    if arguments.write:
        return write_files(*arguments.write)
    os.environ["RAYON_NUM_THREADS"] = os.environ["OMP_NUM_THREADS"] = str(arguments.threads)
    with tempfile.TemporaryDirectory() as place:
        truth, results = Path(place) / "truth.json", Path(place) / "results.json"
        # In a process of its own: peak memory is inherited by children.
        subprocess.run([sys.executable, __file__, "--write", truth, results], check=True)
        sides = {"opendr": lambda: ours(arguments.program, arguments.threads, truth, results)}
        sides |= {name: lambda name=name: peer(name, truth, results) for name in PEERS if name not in arguments.without}
        rounds = {name: [] for name in sides}
        for number in range(arguments.rounds):
            for name, run in sides.items():
                # pycocotools and faster-coco-eval take most of a minute.
                if number == 0 or name in ("opendr", "hotcoco"):
                    rounds[name].append(run())
    own = statistics.median(seconds for seconds, _, _ in rounds["opendr"])
    for name, done in rounds.items():
        seconds, memory = (statistics.median(one[at] for one in done) for at in (0, 1))
        apart = max(abs(a - b) for a, b in zip(done[0][2], rounds["opendr"][0][2], strict=True))
        print(f"{name}: {seconds:.3f} s, {memory:.0f} MB, {seconds / own:.2f} times opendr, numbers apart {apart:.1e}")
        assert apart < 1e-6


if __name__ == "__main__":
    main()
