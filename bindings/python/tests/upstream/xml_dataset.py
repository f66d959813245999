"""Boxes in XML files, in folders of any names."""

import os

import numpy as np
from opendr.engine.data import Image
from opendr.perception.object_detection_2d.datasets import XMLBasedDataset

os.makedirs("data/human")
os.makedirs("data/human_anot")
Image(np.zeros((40, 50, 3), np.uint8)).save("data/human/one.png")
TEXT = (
    "<annotation><object><name>Person</name><bndbox><xmin>1</xmin><ymin>2</ymin><xmax>10</xmax><ymax>20</ymax></bndbox>"
    "</object></annotation>"
)
with open("data/human_anot/one.xml", "w") as file:
    file.write(TEXT)
dataset = XMLBasedDataset(
    root="data", dataset_type="agi_human", images_dir="human", annotations_dir="human_anot", preload_anno=True
)
image, boxes = dataset[0]
assert dataset.classes == ["person"] and image.width == 50
assert (boxes[0].left, boxes[0].top, boxes[0].width, boxes[0].height) == (0, 1, 10, 19)
assert dataset.bboxes[0] == dataset.get_bboxes(0)
with open("data/human_anot/one.xml", "w") as file:
    file.write('<!DOCTYPE x [<!ENTITY a "aaaa">]>' + TEXT)
try:
    XMLBasedDataset("agi_human", "data", images_dir="human", annotations_dir="human_anot")
except ValueError as error:
    assert "document type" in str(error)
else:
    raise AssertionError("entities are read")
