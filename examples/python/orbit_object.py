"""Moves a camera around an object of a simulated world, in a strip of its views. Needs no input, but Gymnasium."""

import numpy as np

from opendr.engine.data import Image
from opendr.simulation import Environment

env = Environment("SphereView-Object-v1", render_mode="rgb_array")
observation, _ = env.reset(seed=3)
views = [env.render()]
action = np.zeros(env.action_space.shape, np.float32)
action[:3] = (1.0, 0.2, 0.0)  # around the object and upwards, at the same distance
for step in range(6):
    observation, reward, terminated, truncated, _ = env.step(action)
    views.append(env.render())
    azimuth, elevation, distance, _ = observation["pose"]
    print(f"azimuth {azimuth:.2f}, elevation {elevation:.2f}, distance {distance:.2f}")
strip = np.concatenate(views, axis=1)
# Each pixel four times as large.
Image(strip.repeat(4, axis=0).repeat(4, axis=1)[:, :, ::-1]).save("orbit_object.png")
