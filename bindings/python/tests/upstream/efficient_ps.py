"""Classes and objects of a picture, drawn over it."""

import os

from opendr.engine.data import Image
from opendr.perception.panoptic_segmentation import EfficientPsLearner

EfficientPsLearner.download("data", mode="model", trained_on="cityscapes")
learner = EfficientPsLearner(config_file="singlegpu_cityscapes.py", device="cpu")
learner.load("data/efficient_ps")
image = Image.open(os.path.join(os.environ["OPENDR_TEST_DATA"], "data/photos/bus.jpg"))
prediction = learner.infer(image)
instance, semantic = prediction
assert instance.numpy().shape == semantic.numpy().shape
drawn = EfficientPsLearner.visualize(image, prediction, False, True, "panoptic.png")
assert os.path.isfile("panoptic.png") and drawn.width == image.width
EfficientPsLearner.visualize(image, prediction, show_figure=False, detailed=True)
