#!/usr/bin/env python3
"""Steps of environments a second beside envpool's and Gymnasium's: the same batch, through Python, in one run.

    pip install dist/opendr_rs-*.whl gymnasium==1.4.0 envpool
    python benches/environments.py

CartPole-v1 with random actions that are made before, NumPy in and out, copies as each makes them by default. Every
measurement is a process of its own; rounds take turns, and the table has the medians.
"""

import argparse
import json
import statistics
import subprocess
import sys
import time

#: Environments and the threads that step them.
BATCHES = [(1, 1), (64, 1), (64, 2), (1024, 2)]
NAMES = ["opendr", "envpool", "gymnasium"]
SECONDS = 1.0


def made(name, count, threads):
    """The environments, and a function that steps them."""
    if name == "opendr":
        from opendr.simulation import VectorEnvironment

        return VectorEnvironment("CartPole-v1", count, threads=threads, autoreset_mode="NextStep")
    if name == "envpool":
        import envpool

        return envpool.make_gymnasium("CartPole-v1", num_envs=count, num_threads=threads)
    import gymnasium

    return gymnasium.make_vec("CartPole-v1", num_envs=count, vectorization_mode="vector_entry_point")


def measure(name, count, threads):
    import numpy as np

    envs = made(name, count, threads)
    envs.reset()
    random = np.random.default_rng(0)
    kind = np.int32 if name == "envpool" else np.int64
    actions = [random.integers(0, 2, count).astype(kind) for _ in range(64)]
    steps, begin = 0, time.perf_counter()
    while time.perf_counter() - begin < 0.2:
        envs.step(actions[0])
    begin = time.perf_counter()
    while (seconds := time.perf_counter() - begin) < SECONDS:
        for action in actions:
            observations, rewards, terminations, truncations, _ = envs.step(action)
        steps += len(actions)
    assert observations.shape == (count, 4) and observations.dtype == np.float32 and len(rewards) == count
    print(json.dumps({"rate": steps * count / seconds}))


def main():
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("--rounds", type=int, default=3)
    arguments.add_argument("--measure", nargs=3, help=argparse.SUPPRESS)
    given = arguments.parse_args()
    if given.measure:
        name, count, threads = given.measure
        return measure(name, int(count), int(threads))
    print("| environments | threads | opendr, steps/s | envpool, steps/s | Gymnasium, steps/s | opendr / envpool |")
    print("|---|---|---|---|---|---|")
    for count, threads in BATCHES:
        rates = {name: [] for name in NAMES}
        for _ in range(given.rounds):
            for name in NAMES:
                command = [sys.executable, __file__, "--measure", name, str(count), str(threads)]
                done = subprocess.run(command, capture_output=True, text=True, check=True)
                rates[name].append(json.loads(done.stdout.splitlines()[-1])["rate"])
        ours, envpool, gymnasium = (statistics.median(rates[name]) for name in NAMES)
        cells = " | ".join(f"{rate / 1e3:,.0f} k" for rate in (ours, envpool, gymnasium))
        print(f"| {count} | {threads} | {cells} | {ours / envpool:.1f} |", flush=True)


if __name__ == "__main__":
    main()
