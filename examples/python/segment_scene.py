"""Predicts the class of every pixel. Input: street.jpg, any photograph."""

import numpy as np

import opendr

segmenter = opendr.learner("deeplab")
classes = segmenter.infer("street.jpg")
indices, pixels = np.unique(classes.data, return_counts=True)
for index, count in zip(indices, pixels):
    print(f"{classes.class_names[index]}: {100 * count / classes.data.size:.1f} % of the image")
classes.save("segment_scene.png")
