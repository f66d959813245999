"""Recognises the action of a moving skeleton and draws its path. Input: skeleton.npy, [frames, 20 joints of Kinect, 3]."""

import numpy as np

import opendr
from opendr.engine.data import Image

recogniser = opendr.learner("spatio_temporal_gcn/utd_mhad")
action = recogniser.infer("skeleton.npy")
print(f"{recogniser.classes[action.data]} {action.confidence:.2f}")

joints = np.load("skeleton.npy")
picture = np.full((400, 400, 3), 255, np.uint8)
for frame, points in enumerate(joints):
    shade = 230 - 230 * frame // len(joints)
    for x, y, _ in points.tolist():
        # Metres, y upwards; a pixel is 5 mm.
        column, row = int(200 + 200 * x), int(200 - 200 * y)
        picture[max(row - 1, 0) : row + 2, max(column - 1, 0) : column + 2] = (255, shade, shade)
action.plot(Image(picture)).save("recognise_action.png")
