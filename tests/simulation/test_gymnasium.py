"""The reference environments and Gymnasium 1.4: single steps from its own states, and whole episodes from seeds."""

import gymnasium
import numpy as np
import pytest

IDS = ["CartPole-v1", "Pendulum-v1", "Acrobot-v1", "MountainCar-v0", "MountainCarContinuous-v0"]
STEPS = 10_000
EPISODES = 20


def bits(numbers):
    """Doubles as integers: the other side's parser of JSON may lose their last bit."""
    return np.atleast_1d(numbers).astype(np.float64).view(np.uint64).tolist()


def state_of(env_id, env):
    state = np.asarray(env.unwrapped.state)
    first = [float(state.dtype == np.float64)] if env_id == "MountainCarContinuous-v0" else []
    return state.astype(float).tolist() + first


@pytest.mark.parametrize("env_id", IDS)
def test_single_steps(env_id, serve):
    env = gymnasium.make(env_id)
    env.action_space.seed(1)
    env.reset(seed=1)
    requests, wanted, held = [], [], None
    for _ in range(STEPS):
        # Repeated actions reach distant states; a tenth of them is sampled again.
        if held is None or env.np_random.random() < 0.1:
            held = env.action_space.sample()
        requests.append({"id": env_id, "state": bits(state_of(env_id, env)), "action": bits(held)})
        observation, reward, terminated, truncated, _ = env.step(held)
        # Steps from a state have no time limit: the episodes below have.
        wanted.append((state_of(env_id, env), observation, float(reward), terminated))
        if terminated or truncated:
            env.reset()
    answers = serve(requests)
    assert len(answers) == STEPS
    assert [(ours["terminated"], ours["truncated"]) for ours in answers] == [(ended, False) for *_, ended in wanted]

    def worst(key, index):
        return np.max(np.abs(np.array([ours[key] for ours in answers]) - np.array([theirs[index] for theirs in wanted])))

    assert worst("state", 0) <= 1e-9
    assert worst("reward", 2) <= 1e-9
    # Observations are single precision: one unit in the last place of the largest.
    assert worst("observation", 1) <= 1e-6


@pytest.mark.parametrize("env_id", IDS)
def test_episodes_from_seeds(env_id, serve):
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
    for ours, (first, steps) in zip(serve(requests), wanted, strict=True):
        assert np.max(np.abs(np.asarray(ours["first"]) - first)) <= 1e-7
        assert [tuple(step[2:]) for step in ours["steps"]] == [step[1:] for step in steps]
        rewards = [np.array([step[at] for step in all_steps]) for all_steps, at in ((ours["steps"], 1), (steps, 0))]
        assert np.max(np.abs(rewards[0] - rewards[1])) <= 1e-6
