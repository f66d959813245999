"""Images with boxes: formats of the toolkit under OpenDR's names."""

import os

import numpy as np
from opendr.engine.datasets import ExternalDataset, MappedDatasetIterator
from opendr.perception.object_detection_2d.datasets import ConcatDataset, DetectionDataset
from opendr.perception.object_detection_2d.datasets.detection_dataset import MappedDetectionDataset
from opendr.perception.object_detection_2d.datasets.transforms import (
    BoundingBoxListToNumpyArray,
    ImageToNumpyArrayTransform,
    ResizeImageAndBoxesTransform,
)

root = os.path.join(os.environ["OPENDR_TEST_DATA"], "data/tiny_coco")
dataset = DetectionDataset([], "coco", root, splits="train2017")
assert len(dataset) == 50 and dataset.num_classes == len(dataset.classes) > 1
image, boxes = dataset[3]
assert dataset.get_bboxes(3) == boxes and dataset.get_image(3).width == image.width
dataset.set_target_transform(BoundingBoxListToNumpyArray())
dataset.set_image_transform(ImageToNumpyArrayTransform())
pixels, rows = dataset[3]
assert pixels.shape == (3, image.height, image.width) and rows.shape == (len(boxes), 6)
small, scaled = ResizeImageAndBoxesTransform(40, 20)(pixels.transpose(1, 2, 0), rows)
assert small.shape == (20, 40, 3) and np.allclose(scaled[:, 0], rows[:, 0] * 40 / image.width)
mapped = dataset.transform(lambda picture, found: (picture, len(found)))
assert isinstance(mapped, MappedDetectionDataset) and mapped[3][1] == len(boxes)

both = ConcatDataset([ExternalDataset(root, "coco").open(), ExternalDataset(root, "coco").open()])
assert len(both) == 100 and both[53][1] == boxes and both.classes == dataset.classes
counts = MappedDatasetIterator(both, lambda sample: (sample[0], len(sample[1])))
assert counts[53][1] == len(boxes)
