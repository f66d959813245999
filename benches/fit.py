#!/usr/bin/env python3
"""A step of our `fit` beside PyTorch's training loop: the same networks, batches and optimiser, in one run.

    cargo build --release -p opendr-training --example step_time
    ../shared/tools/torch_cpu.sh /tmp/torch          # or any environment with torch
    /tmp/torch/bin/python-torch benches/fit.py --step-time target/release/examples/step_time

MobileNetV1 at 96x96 with batches of 32, ResNet-18 (for 32x32) with 64, a GRU of 128 units over 140 steps with 32, an MLP
64-64-64-10 with 64; cross entropy over ten classes, SGD with momentum 0.9; two threads. Every measurement is a process of its
own; rounds take turns, and the table has the median step and the highest memory. Ours is the whole loop with its loader, log
and checks; PyTorch's is forward, backward and step on a batch that lies in memory.
"""

import argparse
import json
import os
import statistics
import subprocess
import sys
import time

THREADS, WARM_UP = 2, 3
#: Steps of a measurement, by network.
STEPS = {"mobilenet": 12, "resnet18": 6, "gru": 20, "mlp": 400}
NAMES = {
    "mobilenet": "MobileNetV1, 96x96, batch 32",
    "resnet18": "ResNet-18, 32x32, batch 64",
    "gru": "GRU 128, 140 steps, batch 32",
    "mlp": "MLP 64-64-64-10, batch 64",
}


def network(name):
    """The network and the shape of its batch."""
    import torch
    from torch import nn

    def conv(inputs, outputs, size, stride, groups=1):
        layer = nn.Conv2d(inputs, outputs, size, stride, size // 2, groups=groups, bias=False)
        return nn.Sequential(layer, nn.BatchNorm2d(outputs), nn.ReLU())

    class Block(nn.Module):
        def __init__(self, inputs, outputs, stride):
            super().__init__()
            self.one = conv(inputs, outputs, 3, stride)
            self.two = nn.Sequential(nn.Conv2d(outputs, outputs, 3, 1, 1, bias=False), nn.BatchNorm2d(outputs))
            self.short = nn.Sequential()
            if stride > 1 or inputs != outputs:
                self.short = nn.Sequential(nn.Conv2d(inputs, outputs, 1, stride, bias=False), nn.BatchNorm2d(outputs))

        def forward(self, x):
            return torch.relu(self.two(self.one(x)) + self.short(x))

    class Gru(nn.Module):
        def __init__(self):
            super().__init__()
            self.gru, self.last = nn.GRU(1, 128, batch_first=True), nn.Linear(128, 10)

        def forward(self, x):
            return self.last(self.gru(x)[0][:, -1])

    if name == "mobilenet":
        layers, inputs = [conv(3, 32, 3, 2)], 32
        for outputs, stride in [(64, 1), (128, 2), (128, 1), (256, 2), (256, 1), (512, 2)] + [(512, 1)] * 5 + [(1024, 2), (1024, 1)]:
            layers += [conv(inputs, inputs, 3, stride, inputs), conv(inputs, outputs, 1, 1)]
            inputs = outputs
        return nn.Sequential(*layers, nn.AdaptiveAvgPool2d(1), nn.Flatten(), nn.Linear(1024, 10)), (32, 3, 96, 96)
    if name == "resnet18":
        layers, inputs = [conv(3, 64, 3, 1)], 64
        for outputs, stride in [(64, 1), (128, 2), (256, 2), (512, 2)]:
            layers += [Block(inputs, outputs, stride), Block(outputs, outputs, 1)]
            inputs = outputs
        return nn.Sequential(*layers, nn.AdaptiveAvgPool2d(1), nn.Flatten(), nn.Linear(512, 10)), (64, 3, 32, 32)
    if name == "gru":
        return Gru(), (32, 140, 1)
    layers = [nn.Linear(64, 64), nn.ReLU(), nn.Linear(64, 64), nn.ReLU(), nn.Linear(64, 10)]
    return nn.Sequential(*layers), (64, 64)


def measure_torch(name):
    import resource

    import torch

    torch.set_num_threads(THREADS)
    torch.manual_seed(0)
    model, shape = network(name)
    inputs, classes = torch.rand(shape) * 2 - 1, torch.arange(shape[0]) % 10
    optimizer = torch.optim.SGD(model.parameters(), lr=0.01, momentum=0.9)
    times = []
    for _ in range(STEPS[name] + WARM_UP):
        begin = time.perf_counter()
        optimizer.zero_grad()
        torch.nn.functional.cross_entropy(model(inputs), classes).backward()
        optimizer.step()
        times.append((time.perf_counter() - begin) * 1e3)
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1.024e-3
    print(json.dumps({"ms": statistics.median(times[WARM_UP:]), "peak_mb": peak}))


def measured(command):
    threads = {name: str(THREADS) for name in ("RAYON_NUM_THREADS", "OMP_NUM_THREADS", "OPENDR_THREADS")}
    done = subprocess.run(command, env={**os.environ, **threads}, capture_output=True, text=True, check=True)
    return json.loads(done.stdout)


def main():
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("--step-time", help="the program of crates/training/examples/step_time.rs, built for release")
    arguments.add_argument("--rounds", type=int, default=3)
    arguments.add_argument("--torch", choices=STEPS, help=argparse.SUPPRESS)
    given = arguments.parse_args()
    if given.torch:
        return measure_torch(given.torch)
    if not given.step_time:
        arguments.error("give --step-time")
    import torch

    print(f"torch {torch.__version__}, {THREADS} threads, {given.rounds} rounds\n")
    print("| network | ours, ms a step | PyTorch, ms a step | ratio | ours, peak MB | PyTorch, peak MB |")
    print("|---|---|---|---|---|---|")
    for name, steps in STEPS.items():
        ours, theirs = [], []
        for _ in range(given.rounds):
            ours.append(measured([given.step_time, name, str(steps)]))
            theirs.append(measured([sys.executable, __file__, "--torch", name]))
        (a, a_mb), (b, b_mb) = (
            (statistics.median(run["ms"] for run in runs), max(run["peak_mb"] for run in runs)) for runs in (ours, theirs)
        )
        print(f"| {NAMES[name]} | {a:.2f} | {b:.2f} | {a / b:.2f} | {a_mb:.0f} | {b_mb:.0f} |", flush=True)


if __name__ == "__main__":
    main()
