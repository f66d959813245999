"""A map of objects in a large image; the learner is trained on images with boxes."""

import os

import numpy as np
from opendr.engine.data import Image
from opendr.engine.datasets import ExternalDataset
from opendr.perception.binary_high_resolution import BinaryHighResolutionLearner, visualize
from opendr.perception.binary_high_resolution.utils.high_resolution_loader import HighResolutionDataset

os.makedirs("demo_dataset")
generator = np.random.default_rng(1)
for number in range(2):
    pixels = generator.integers(0, 90, (256, 256, 3), dtype=np.uint8)
    pixels[64:192, 64:192] = 220
    Image(pixels).save(f"demo_dataset/{number}.png")
    box = "<bndbox><xmin>65</xmin><ymin>65</ymin><xmax>192</xmax><ymax>192</ymax></bndbox>"
    with open(f"demo_dataset/{number}.xml", "w") as file:
        file.write(f"<annotation><filename>{number}.png</filename><object><name>mark</name>{box}</object></annotation>")

squares = HighResolutionDataset("demo_dataset", patch_size=64)
assert len(squares) == 32 and sum(squares.get_labels()) == 8
patch, category = squares[0]
assert (patch.width, patch.height, category.data) == (64, 64, 0)

learner = BinaryHighResolutionLearner(device="cpu", iters=1, batch_size=4, architecture="VGG_720p", num_workers=0)
stats = learner.fit(ExternalDataset("./demo_dataset", "VOC2012"), True, False)
assert stats["loss"]
learner.save("test_model")
assert "accuracy" in learner.eval(ExternalDataset("./demo_dataset", "VOC2012"), True)
drawn, heatmap = visualize(learner, "demo_dataset/0.png", show=False)
assert (drawn.width, drawn.height) == (256, 256) and heatmap.numpy().ndim == 2
