"""Trains a policy that balances a pole on a cart, by PPO, and draws its learning curve. Needs no input."""

import numpy as np

from opendr.control.reinforcement_learning import PpoLearner
from opendr.engine.data import Image

policy = PpoLearner()
steps = {"total_timesteps": 40_000, "eval_freq": 4_000, "n_eval_episodes": 10}
numbers = policy.fit("CartPole-v1", silent=True, out="train_policy", **steps)
returns = numbers["val_return"]
print("mean returns:", ", ".join(f"{value:.0f}" for value in returns))
print(f"after the training {policy.eval(episodes=20)['mean_return']:.0f} of 500")

# A bar for each evaluation; a pixel is a return of 2.
picture = np.full((250, 40 * len(returns), 3), 255, np.uint8)
for index, value in enumerate(returns):
    picture[250 - int(value) // 2 :, 40 * index + 5 : 40 * index + 35] = (160, 120, 40)
Image(picture).save("train_policy.png")
