"""Detects how a gripper can grasp an object, in colour and depth. The images are drawn here: a bar on a table."""

import numpy as np

import opendr
from opendr.engine.data import Image

y, x = np.mgrid[:480, :640].astype(int)
along, across = 4 * (x - 320) + 3 * (y - 240), 4 * (y - 240) - 3 * (x - 320)
bar = (abs(along) < 550) & (abs(across) < 90)
colour, depth = np.full((480, 640, 3), 200, np.uint8), np.full((480, 640, 1), 800, np.uint16)
colour[bar], depth[bar] = (40, 60, 180), 760  # depth in millimetres
image = Image(colour)

detector = opendr.learner("gr_conv_net")
grasps = detector.infer(image, Image(depth, dtype="uint16"))
for grasp in grasps:
    (x0, y0), (x1, y1) = grasp.data.tolist()
    print(f"fingers at {x0:.0f}, {y0:.0f} and {x1:.0f}, {y1:.0f}, quality {grasp.confidence:.2f}")
grasps.save("detect_grasps.png")
