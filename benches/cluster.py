"""Compares evaluations and trainings on a Ray cluster of this machine with those of one worker.

    python benches/cluster.py [--images 2000] [--epochs 2]

Evaluation: `single_shot_detector` on images of noise, by one worker and by two with a core each; the ratio of the times is printed with
the time to start the workers left out. Training: the time of a step of `image_classifier` in one process, in a group of two, and of the
exchange alone; from these, the time of a step on more machines is computed, with the exchange through one actor.
"""

from __future__ import annotations

import argparse
import os
import sys
import tempfile
import time

import numpy as np
import opendr
import ray
from opendr._cluster_fit import _Exchange
from opendr.engine.data import Image
from opendr.engine.datasets import DatasetIterator
from opendr.engine.target import BoundingBox, BoundingBoxList, Category

#: Bandwidth of the network between machines, for the computed times.
NETWORK_BYTES_PER_S = 1.25e9


class Noise(DatasetIterator):
    """Images of noise with a box each."""

    classes = ["person"]

    def __init__(self, count: int) -> None:
        self.count = count

    def __len__(self) -> int:
        return self.count

    def __getitem__(self, index: int):
        image = np.random.default_rng(index).integers(0, 256, (240, 320, 3), np.uint8)
        return Image(image), BoundingBoxList([BoundingBox(name=0, left=1, top=1, width=20, height=20)])


class Shades(DatasetIterator):
    """Dark and bright images."""

    classes = ["dark", "bright"]

    def __len__(self) -> int:
        return 512

    def __getitem__(self, index: int):
        noise = np.random.default_rng(index).integers(0, 128, (28, 28, 3), np.uint8)
        return Image(noise + 127 * (index % 2)), Category(index % 2)


def started(cores: int) -> None:
    """Starts a cluster of this machine whose workers have loaded the package."""
    variables = {"PYTHONPATH": os.pathsep.join(sys.path)}
    ray.init(num_cpus=cores, include_dashboard=False, log_to_driver=False, runtime_env={"env_vars": variables})


def evaluation(images: int) -> None:
    """Prints the times of an evaluation by one worker and by two."""
    learner = opendr.learner("single_shot_detector")
    times = []
    for cores in (1, 2):
        started(cores)
        learner.eval(Noise(8 * cores), by_number=True, resamples=0, ray=True)
        begun = time.perf_counter()
        learner.eval(Noise(images), by_number=True, resamples=0, ray=True)
        times.append(time.perf_counter() - begun)
        print(f"evaluation of {images} images, {cores} worker(s): {times[-1]:.1f} s")
        ray.shutdown()
    print(f"two workers are {times[0] / times[1]:.2f} times as fast as one")


def training(epochs: int) -> None:
    """Prints the times of a step of a training, and those computed for more machines."""
    params = {"batch_size": 16, "accumulate": 2, "silent": True}
    steps = 2 * epochs * len(Shades()) // 32
    learner = opendr.learners()["image_classifier"]
    times = {}
    started(2)
    for name, where in (("one process", {}), ("a group of two", {"ray": True})):
        seconds = []
        # The difference of two trainings leaves out the start of the processes.
        for factor in (1, 3):
            with tempfile.TemporaryDirectory() as out:
                run = os.path.join(out, "run")
                results = learner().fit(Shades(), out=run, epochs=factor * epochs, **params, **where)
                size = os.path.getsize(os.path.join(run, "model", "model.onnx"))
                seconds.append(results["seconds"])
        times[name] = (seconds[1] - seconds[0]) / steps
        print(f"a step of a training, {name}: {1e3 * times[name]:.1f} ms; network of {size / 1e6:.2f} MB")
    exchange = ray.remote(_Exchange).options(num_cpus=0).remote(1)
    payload = bytes(2 * size)
    ray.get(exchange.gather.remote(0, -1, payload))
    begun = time.perf_counter()
    for number in range(20):
        ray.get(exchange.gather.remote(0, number, payload))
    passed = (time.perf_counter() - begun) / 20
    print(f"the exchange of two batches by one process: {1e3 * passed:.1f} ms")
    ray.shutdown()
    batch = times["one process"] / 2
    for machines in (1, 2, 4, 8, 16, 64):
        sent = machines * machines * size / NETWORK_BYTES_PER_S if machines > 1 else 0.0
        step = batch + sent + (passed if machines > 1 else 0.0)
        print(f"computed: {machines} machines, a batch each: {machines * 16 / step:.0f} samples per second")


def main() -> None:
    """Runs both comparisons."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--images", type=int, default=2000)
    parser.add_argument("--epochs", type=int, default=2)
    arguments = parser.parse_args()
    evaluation(arguments.images)
    training(arguments.epochs)


if __name__ == "__main__":
    main()
