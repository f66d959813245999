"""Predicts class and instance of every pixel, and draws the instances. Input: street.jpg, any photograph."""

import numpy as np

import opendr

segmenter = opendr.learner("efficient_ps")
instance, semantic = segmenter.infer("street.jpg")
for index in np.unique(instance.data):
    pixels = instance.data == index
    name = semantic.label_of(semantic.data[pixels][0])  # a number where no class is certain
    print(f"instance {index}: {name}, {pixels.sum()} pixels")
instance.save("panoptic.png")
