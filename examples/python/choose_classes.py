"""Detects only persons, with a higher threshold than the default. Input: street.jpg, any photograph."""

import opendr
from opendr.engine.target import BoundingBoxList

detector = opendr.learner("yolox", threshold=0.5)
boxes = detector.infer("street.jpg")
persons = [box for box in boxes if box.class_name == "person"]
print(f"{len(persons)} of {len(boxes)} boxes are persons")
BoundingBoxList(persons, classes=detector.classes).plot("street.jpg").save("choose_classes.png")
