"""Finds abnormal heart beats and draws all. Input: heart.txt, beats of the data set ECG5000 (UCR archive)."""

import numpy as np

import opendr
from opendr.engine.data import Image
from opendr.engine.datasets import ExternalDataset

recogniser = opendr.learner("gated_recurrent_unit")
beats = ExternalDataset("heart.txt", "ucr").open()
picture, abnormal, right = np.full((240, 560, 3), 255, np.uint8), 0, 0
for index in range(0, len(beats), 10):
    beat, annotation = beats[index]
    found = recogniser.infer(beat).data
    abnormal += found
    # The first class of the data set is the normal beat.
    right += found == (annotation.data > 0)
    for time, value in enumerate(beat.data[:, 0]):
        row = min(max(int(120 - 22 * float(value)), 0), 239)
        picture[row, 4 * time : 4 * time + 4] = (40, 40, 200) if found else (160, 120, 40)
print(f"{abnormal} of 50 beats are abnormal, {right} as annotated")
Image(picture).save("heart_beats.png")
