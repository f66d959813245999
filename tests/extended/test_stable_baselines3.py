"""Stable-Baselines3 on the environments of the toolkit."""

import gymnasium
import numpy as np
import opendr.simulation
import pytest
import torch
from opendr.control.reinforcement_learning import PpoLearner
from stable_baselines3 import PPO
from stable_baselines3.common.env_checker import check_env
from stable_baselines3.common.env_util import make_vec_env
from stable_baselines3.common.evaluation import evaluate_policy

STEPS = 30_000
#: Enough for hopping to begin.
HOPPER_STEPS = 60_000
#: RL Zoo's for CartPole.
SETTINGS = {"n_steps": 32, "batch_size": 256, "gae_lambda": 0.8, "gamma": 0.98, "n_epochs": 20, "learning_rate": 1e-3}


@pytest.fixture(autouse=True)
def one_thread():
    torch.set_num_threads(1)


@pytest.mark.parametrize("name", list(opendr.simulation.environments()))
def test_its_checker_passes(name):
    check_env(gymnasium.make(f"opendr/{name}").unwrapped, warn=False)


def trained(name, seed):
    """Mean and deviation of the returns after a training, and the returns during it."""
    envs = make_vec_env(name, n_envs=8, seed=seed)
    model = PPO("MlpPolicy", envs, seed=seed, device="cpu", clip_range=0.2, ent_coef=0.0, **SETTINGS)
    model.learn(STEPS)
    returns, _ = evaluate_policy(model, make_vec_env(name, seed=1000), n_eval_episodes=20, return_episode_rewards=True)
    return np.mean(returns), np.std(returns), [episode["r"] for episode in model.ep_info_buffer]


def test_it_trains_on_ours_as_on_gymnasiums():
    ours, theirs = ([trained(f"{prefix}CartPole-v1", seed) for seed in range(3)] for prefix in ("opendr/", ""))
    print([f"{mean:.0f} +- {deviation:.0f}" for mean, deviation, _ in ours + theirs])
    assert min(mean for mean, *_ in ours) >= 195
    deviation = max(np.std([mean for mean, *_ in theirs]), np.mean([deviation for _, deviation, _ in theirs]), 10.0)
    assert abs(np.mean([mean for mean, *_ in ours]) - np.mean([mean for mean, *_ in theirs])) <= deviation


def test_it_learns_from_pictures_and_numbers():
    envs = make_vec_env("opendr/UavDepthCorridor-v1", n_envs=2, seed=1)
    model = PPO("MultiInputPolicy", envs, n_steps=64, batch_size=64, n_epochs=1, seed=1, device="cpu")
    before = [parameter.clone() for parameter in model.policy.parameters()]
    model.learn(256)
    assert any(not torch.equal(old, new) for old, new in zip(before, model.policy.parameters()))
    assert all(torch.isfinite(parameter).all() for parameter in model.policy.parameters())


def hopping_by_stable_baselines3(seed):
    envs = make_vec_env("Hopper-v5", n_envs=4, seed=seed)
    model = PPO("MlpPolicy", envs, n_steps=512, seed=seed, device="cpu").learn(HOPPER_STEPS)
    return evaluate_policy(model, make_vec_env("Hopper-v5", seed=1000), n_eval_episodes=20)[0]


def hopping_by_ours(seed, folder):
    """The same with Stable-Baselines3's default settings, which are ours too."""
    learner = PpoLearner(n_envs=4, n_steps=512, total_timesteps=HOPPER_STEPS, seed=seed, eval_freq=0)
    learner.fit(env=lambda: gymnasium.make("Hopper-v5"), out=folder, silent=True)
    return learner.eval(env=lambda: gymnasium.make("Hopper-v5"), episodes=20)["mean_return"]


def test_ours_trains_on_gymnasiums_hopper_as_well(tmp_path):
    ours = [hopping_by_ours(seed, tmp_path / str(seed)) for seed in range(5)]
    theirs = [hopping_by_stable_baselines3(seed) for seed in range(5)]
    print(f"ours {np.round(ours)}, Stable-Baselines3 {np.round(theirs)}")
    # A policy that falls at once has a return of about 20.
    assert min(ours) > 100
    assert np.mean(ours) >= np.mean(theirs) - np.std(theirs, ddof=1)
