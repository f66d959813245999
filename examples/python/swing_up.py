"""Swings up a pendulum with a trained policy, in a strip of images of the episode. Needs no input, but Gymnasium."""

import numpy as np

import opendr
from opendr.engine.data import Image
from opendr.simulation import Environment

policy = opendr.learner("sac")
env = Environment("Pendulum-v1", render_mode="rgb_array")
observation, _ = env.reset(seed=3)
images, total = [], 0.0
for step in range(100):
    if step % 10 == 0:
        images.append(env.render()[100:400:2, 100:400:2])
    action = policy.infer(observation)
    observation, reward, terminated, truncated, _ = env.step(np.array([float(action)], np.float32))
    total += reward
print(f"return {total:.1f}, at the end the cosine of the angle is {observation[0]:.3f}")
Image(np.concatenate(images, axis=1)[:, :, ::-1]).save("swing_up.png")
