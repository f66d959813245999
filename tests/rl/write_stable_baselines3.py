"""Writes crates/rl/tests/data: small policies of Stable-Baselines3, and their actions.

    python tests/rl/write_stable_baselines3.py crates/rl/tests/data

Of the settings only those that are read are kept.
"""

import io
import json
import sys
import zipfile

import gymnasium
import numpy
import torch
from stable_baselines3 import DQN, PPO, SAC, TD3


def moved_until_it_differs(model, seen):
    """Adds noise to the parameters until the actions differ; returns the actions."""
    while True:
        with torch.no_grad():
            for parameter in model.policy.parameters():
                parameter.add_(0.3 * torch.randn_like(parameter))
        done, _ = model.predict(seen, deterministic=True)
        if numpy.ptp(done) > 0:
            return done


def main(folder):
    torch.manual_seed(0)
    small = {"net_arch": [6, 5]}
    relu = {**small, "activation_fn": torch.nn.ReLU, "log_std_init": -0.5}
    models = {
        "ppo_cart_pole": PPO("MlpPolicy", "CartPole-v1", policy_kwargs=dict(small), device="cpu"),
        "ppo_pendulum": PPO("MlpPolicy", "Pendulum-v1", policy_kwargs=relu, device="cpu"),
        "sac_pendulum": SAC("MlpPolicy", "Pendulum-v1", policy_kwargs=dict(small), buffer_size=1, device="cpu"),
        "td3_pendulum": TD3("MlpPolicy", "Pendulum-v1", policy_kwargs=dict(small), buffer_size=1, device="cpu"),
        "dqn_cart_pole": DQN("MlpPolicy", "CartPole-v1", policy_kwargs=dict(small), buffer_size=1, device="cpu"),
    }
    answers = {}
    for name, model in models.items():
        seen = numpy.random.default_rng(7).uniform(-1, 1, (8, *model.observation_space.shape)).astype(numpy.float32)
        done = moved_until_it_differs(model, seen)
        answers[name] = {"observations": seen.ravel().tolist(), "actions": done.ravel().tolist()}
        whole = io.BytesIO()
        model.save(whole)
        with zipfile.ZipFile(whole) as archive, zipfile.ZipFile(f"{folder}/{name}.zip", "w") as kept:
            data = json.loads(archive.read("data"))
            kwargs = {key: value for key, value in data["policy_kwargs"].items() if not key.startswith(":")}
            kept.writestr("data", json.dumps({"policy_kwargs": kwargs, "use_sde": data.get("use_sde", False)}))
            kept.writestr("policy.pth", archive.read("policy.pth"), zipfile.ZIP_DEFLATED)
    with open(f"{folder}/answers.json", "w") as file:
        json.dump(answers, file)


main(sys.argv[1])
