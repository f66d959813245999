#!/usr/bin/env python3
"""Our matrix products beside NumPy's (OpenBLAS), on one thread, in one run: the median ratio of rounds that take turns.

    cargo build --release -p opendr-kernels --example gflops
    OPENBLAS_NUM_THREADS=1 benches/gemm.py target/release/examples/gflops

A ratio above 1 says that ours is faster. NumPy writes into an array that is there already (`out=`).
"""

import os
import statistics
import subprocess
import sys
import time

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
import numpy

ROUNDS = 3


def ours(program):
    lines = subprocess.run([program], check=True, capture_output=True, text=True).stdout.splitlines()
    print(lines[0])
    return {name: float(micros) for name, micros, _ in map(str.split, lines[1:])}


def numpy_micros(rows, columns, depth, kind):
    random = numpy.random.default_rng(1)
    shapes = {"a": (rows, depth), "b": (depth, columns)}
    a, b = (random.uniform(-1, 1, shapes[k]).astype(numpy.float32) for k in "ab")
    if kind == "nt":
        b = numpy.ascontiguousarray(b.T).T
    if kind == "tn":
        a = numpy.ascontiguousarray(a.T).T
    c = numpy.empty((rows, columns), numpy.float32)
    calls = int(min(max(1e8 / (2 * rows * columns * depth), 1), 20000))
    best = float("inf")
    for _ in range(20):
        start = time.perf_counter()
        for _ in range(calls):
            numpy.matmul(a, b, out=c)
        best = min(best, (time.perf_counter() - start) / calls)
    return best * 1e6


def is_product(name):
    return name[0].isdigit()


def main():
    rounds = []
    for _ in range(ROUNDS):
        mine = ours(sys.argv[1])
        theirs = {}
        for name in filter(is_product, mine):
            size, kind = name.split("-")
            theirs[name] = numpy_micros(*map(int, size.split("x")), kind)
        rounds.append((mine, theirs))
    print(f"{'product':>26} {'ours us':>10} {'NumPy us':>10} {'GFLOP/s':>8} {'ratio':>6}")
    for name in rounds[0][0]:
        if not is_product(name):
            print(f"{name:>26} {statistics.median(r[0][name] for r in rounds):10.2f}")
            continue
        rows, columns, depth = map(int, name.split("-")[0].split("x"))
        mine, theirs = (statistics.median(r[i][name] for r in rounds) for i in (0, 1))
        ratio = statistics.median(r[1][name] / r[0][name] for r in rounds)
        speed = 2e-3 * rows * columns * depth / mine
        print(f"{name:>26} {mine:10.2f} {theirs:10.2f} {speed:8.1f} {ratio:6.2f}")


if __name__ == "__main__":
    main()
