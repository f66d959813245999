"""Compares the reference environments with Gymnasium 1.4, step by step.

    pip install gymnasium==1.4.0
    cargo build --release -p opendr-simulation --example serve_environments
    python tests/simulation/compare_gymnasium.py target/release/examples/serve_environments

Each of 10,000 steps per environment starts from Gymnasium's own state; then whole episodes from seeds.
"""

import json
import subprocess
import sys

import gymnasium
import numpy as np

IDS = ["CartPole-v1", "Pendulum-v1", "Acrobot-v1", "MountainCar-v0", "MountainCarContinuous-v0"]
STEPS = 10_000
EPISODES = 20


def asked(program, requests):
    lines = "".join(json.dumps(request) + "\n" for request in requests)
    done = subprocess.run([program], input=lines, capture_output=True, text=True, check=True)
    return [json.loads(line) for line in done.stdout.splitlines()]


def bits(numbers):
    """Doubles as whole numbers: the other side's parser of JSON may lose their last bit."""
    return np.atleast_1d(numbers).astype(np.float64).view(np.uint64).tolist()


def state_of(env_id, env):
    state = np.asarray(env.unwrapped.state)
    first = [float(state.dtype == np.float64)] if env_id == "MountainCarContinuous-v0" else []
    return state.astype(float).tolist() + first


def single_steps(env_id, program):
    env = gymnasium.make(env_id)
    env.action_space.seed(1)
    env.reset(seed=1)
    requests, wanted, held = [], [], None
    for _ in range(STEPS):
        # Held actions reach the far states; a tenth of them is drawn anew.
        if held is None or env.np_random.random() < 0.1:
            held = env.action_space.sample()
        requests.append({"id": env_id, "state": bits(state_of(env_id, env)), "action": bits(held)})
        observation, reward, terminated, truncated, _ = env.step(held)
        wanted.append((state_of(env_id, env), observation, float(reward), terminated, False))
        if terminated or truncated:
            env.reset()
    worst = {"state": 0.0, "observation": 0.0, "reward": 0.0}
    for ours, (state, observation, reward, terminated, truncated) in zip(asked(program, requests), wanted, strict=True):
        assert (ours["terminated"], ours["truncated"]) == (terminated, truncated), env_id
        for key, value in ("state", state), ("observation", observation), ("reward", reward):
            worst[key] = max(worst[key], float(np.max(np.abs(np.asarray(ours[key]) - value))))
    ended = sum(terminated for *_, terminated, _ in wanted)
    print(f"{env_id}: {STEPS} steps, {ended} terminated, largest difference {worst}")
    assert worst["state"] <= 1e-9 and worst["reward"] <= 1e-9, env_id
    # Observations are single precision: one unit in the last place of the largest.
    assert worst["observation"] <= 1e-6, env_id


def episodes(env_id, program):
    env = gymnasium.make(env_id)
    requests, wanted = [], []
    for seed in range(EPISODES):
        env.action_space.seed(seed)
        first, _ = env.reset(seed=seed)
        actions, steps = [], []
        while not steps or not (steps[-1][1] or steps[-1][2]):
            action = env.action_space.sample()
            actions.append(bits(action))
            _, reward, terminated, truncated, _ = env.step(action)
            steps.append((float(reward), terminated, truncated))
        requests.append({"id": env_id, "seed": seed, "actions": actions})
        wanted.append((first, steps))
    truncations = 0
    for ours, (first, steps) in zip(asked(program, requests), wanted, strict=True):
        assert np.max(np.abs(np.asarray(ours["first"]) - first)) <= 1e-7, env_id
        assert len(ours["steps"]) == len(steps), env_id
        for (_, reward, terminated, truncated), theirs in zip(ours["steps"], steps, strict=True):
            assert abs(reward - theirs[0]) <= 1e-6 and (terminated, truncated) == theirs[1:], env_id
        truncations += steps[-1][2]
    print(f"{env_id}: {EPISODES} episodes from seeds, {truncations} truncated")


if __name__ == "__main__":
    for env_id in IDS:
        single_steps(env_id, sys.argv[1])
        episodes(env_id, sys.argv[1])
