"""Measures whether the best place on a map is ambiguous, for instance where to push an object. The map is computed here."""

import numpy as np

import opendr
from opendr.engine.target import Heatmap

measure = opendr.learner("ambiguity_measure", threshold=0.4)
row, column = np.mgrid[:120, :160].astype(np.float32)
for height in (4.0, 8.9):
    # A peak of 9 at the left, and a second one at the right.
    left = 9 / (1 + ((column - 40) ** 2 + (row - 60) ** 2) / 200)
    right = np.float32(height) / (1 + ((column - 120) ** 2 + (row - 50) ** 2) / 200)
    places = Heatmap(left + right)
    category, peaks = measure.infer(places)
    print(f"second peak {height}: {measure.classes[category.data]}, best peak with probability {peaks.data[0, 3]:.2f}")
places.plot(np.zeros((120, 160, 3), np.uint8)).save("ambiguous_map.png")
