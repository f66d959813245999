#!/usr/bin/env python3
"""Our PPO and SAC beside Stable-Baselines3: the same environments, networks and settings, in one run, one thread each.

    cargo build --release -p opendr-rl --examples
    ../shared/tools/torch_cpu.sh /tmp/torch                       # or any environment with torch
    /tmp/torch/bin/pip install stable-baselines3 gymnasium
    /tmp/torch/bin/python-torch benches/rl.py --examples target/release/examples

PPO balances a pole with the settings of rl-zoo (8 environments, 32 steps each, minibatches of 256, 20 epochs, 64-64); SAC swings
up a pendulum (256-256, batches of 256, one update a step). Rounds take turns; every measurement is a process of its own. Ours
counts from its start to its end, with evaluations; Stable-Baselines3 counts what is spent in `learn`. Times of the
processor do not depend on what else runs; wall clock does.
"""

import argparse
import json
import os
import statistics
import subprocess
import sys
import time

#: Steps of a measurement that are learnt from: ours, and Stable-Baselines3's.
STEPS = {"ppo": (100_096, 20_480), "sac": (3_000 - 100, 1_100 - 100)}
#: Steps before learning begins.
BEFORE = {"ppo": 0, "sac": 100}
NAMES = {"ppo": "PPO, CartPole-v1", "sac": "SAC, Pendulum-v1"}
ENVIRONMENT = {**os.environ, "OMP_NUM_THREADS": "1", "MKL_NUM_THREADS": "1", "OPENDR_THREADS": "1"}


def measure_stable_baselines3(name):
    import torch
    from stable_baselines3 import PPO, SAC
    from stable_baselines3.common.env_util import make_vec_env

    torch.set_num_threads(1)
    if name == "ppo":
        settings = {"n_steps": 32, "batch_size": 256, "gae_lambda": 0.8, "gamma": 0.98, "n_epochs": 20}
        rates = {"learning_rate": lambda left: 1e-3 * left, "clip_range": lambda left: 0.2 * left}
        model = PPO("MlpPolicy", make_vec_env("CartPole-v1", 8), **settings, **rates, device="cpu", seed=0)
    else:
        model = SAC("MlpPolicy", "Pendulum-v1", learning_rate=1e-3, device="cpu", seed=0)
    wall, cpu = time.perf_counter(), time.process_time()
    model.learn(STEPS[name][1] + BEFORE[name])
    cpu, wall = time.process_time() - cpu, time.perf_counter() - wall
    print(json.dumps({"cpu": STEPS[name][1] / cpu, "wall": STEPS[name][1] / wall}))


def measure_ours(name, folder):
    """Steps per second of a whole process."""
    steps, thousands = STEPS[name][0], (STEPS[name][0] + BEFORE[name]) // 1000
    command = {"ppo": ["ppo_cart_pole", "0"], "sac": ["sac_pendulum", "0", "1", str(thousands)]}[name]
    wall = time.perf_counter()
    process = subprocess.Popen([os.path.join(folder, command[0]), *command[1:]], stdout=subprocess.DEVNULL, env=ENVIRONMENT)
    _, status, usage = os.wait4(process.pid, 0)
    assert status == 0, f"{command} failed"
    return {"cpu": steps / (usage.ru_utime + usage.ru_stime), "wall": steps / (time.perf_counter() - wall)}


def main():
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("--examples", help="the folder of the examples of opendr-rl, built for release")
    arguments.add_argument("--rounds", type=int, default=3)
    arguments.add_argument("--only", choices=STEPS)
    arguments.add_argument("--stable-baselines3", choices=STEPS, help=argparse.SUPPRESS)
    given = arguments.parse_args()
    if given.stable_baselines3:
        return measure_stable_baselines3(given.stable_baselines3)
    if not given.examples:
        arguments.error("give --examples")
    import stable_baselines3
    import torch

    versions = f"Stable-Baselines3 {stable_baselines3.__version__}, torch {torch.__version__}"
    print(f"{versions}, one thread, {given.rounds} rounds, medians of steps per second\n")
    print("| learner | ours, CPU | SB3, CPU | ratio | ours, wall | SB3, wall | ratio |")
    print("|---|---|---|---|---|---|---|")
    for name in [given.only] if given.only else STEPS:
        ours, theirs = [], []
        for _ in range(given.rounds):
            ours.append(measure_ours(name, given.examples))
            command = [sys.executable, __file__, "--stable-baselines3", name]
            done = subprocess.run(command, env=ENVIRONMENT, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, check=True)
            theirs.append(json.loads(done.stdout))
        row = []
        for clock in ("cpu", "wall"):
            a, b = (statistics.median(run[clock] for run in runs) for runs in (ours, theirs))
            row += [f"{a:.0f}", f"{b:.0f}", f"{a / b:.1f}"]
        print(f"| {NAMES[name]} | {' | '.join(row)} |", flush=True)


if __name__ == "__main__":
    main()
