"""The detector of persons, with the calls of OpenDR's demo and paper."""

import os
import sys

from opendr.engine.data import Image
from opendr.perception.object_detection_2d import SingleShotDetectorLearner, draw_bounding_boxes

ssd = SingleShotDetectorLearner(device="cpu")
ssd.download(".", mode="pretrained")
ssd.load("./ssd_default_person", verbose=True)
assert os.path.isfile("ssd_default_person/model.json")
ssd.download(".", mode="images")
img = Image.open("./people.jpg")

boxes = ssd.infer(img, 0.2, False)
drawn = draw_bounding_boxes(img.opencv(), boxes, class_names=ssd.classes, line_thickness=2)
assert drawn.shape == img.opencv().shape and not (drawn == img.opencv()).all()
assert ssd.classes == ["person"] and len(boxes) >= 1
for box in boxes:
    assert ssd.classes[int(box.name)] == "person" and box.confidence >= 0.2
sys.stdout.write(f"{len(boxes)} persons\n")
