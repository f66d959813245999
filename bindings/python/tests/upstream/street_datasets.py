"""Class maps of streets: Cityscapes as published, and folders prepared by OpenDR."""

import os

import numpy as np
from opendr.engine.data import Image
from opendr.perception.panoptic_segmentation import CityscapesDataset, KittiDataset
from opendr.perception.panoptic_segmentation.datasets import CityscapesDataset as Same

assert Same is CityscapesDataset
pixels, labels = np.zeros((16, 32, 3), np.uint8), np.full((16, 32, 1), 7, np.uint8)
for folder in ("city/leftImg8bit/val/ulm", "city/gtFine/val/ulm", "own/images", "own/stuffthingmaps"):
    os.makedirs(folder)
Image(pixels).save("city/leftImg8bit/val/ulm/ulm_000000_000019_leftImg8bit.png")
Image(labels, guess_format=True).save("city/gtFine/val/ulm/ulm_000000_000019_gtFine_labelIds.png")
dataset = CityscapesDataset(path="city")
image, heatmap = dataset[0]
assert len(dataset) == 1 and image.width == 32 and dataset.classes[int(heatmap.numpy()[0, 0])].lower() == "road"

Image(pixels).save("own/images/a.png")
Image(labels, guess_format=True).save("own/stuffthingmaps/a.png")
prepared = KittiDataset("own")
assert len(prepared) == 1 and int(prepared[0][1].numpy()[3, 3]) == 7
for method in (dataset.evaluate, CityscapesDataset.prepare_data):
    try:
        method("a", "b")
    except NotImplementedError:
        pass
    else:
        raise AssertionError("it is there")
