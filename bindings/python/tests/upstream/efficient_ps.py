"""Panoptic segmentation of an image, drawn over it."""

import os
import sys
from pathlib import Path

from opendr.engine.data import Image
from opendr.perception.panoptic_segmentation import EfficientPsLearner

EfficientPsLearner.download("data", trained_on="cityscapes")
config_file = Path(sys.modules[EfficientPsLearner.__module__].__file__).parent / "configs" / "singlegpu_cityscapes.py"
learner = EfficientPsLearner(str(config_file), device="cpu")
learner.load(path="data/model_cityscapes.pth")
image = Image.open(os.path.join(os.environ["OPENDR_TEST_DATA"], "data/photos/bus.jpg"))
prediction = learner.infer(image)
instance, semantic = prediction
assert instance.numpy().shape == semantic.numpy().shape
drawn = EfficientPsLearner.visualize(image, prediction, False, True, "panoptic.png")
assert os.path.isfile("panoptic.png") and drawn.width == image.width
EfficientPsLearner.visualize(image, prediction, show_figure=False, detailed=True)
