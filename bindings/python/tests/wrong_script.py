"""Errors that type checkers report, one in each marked line."""

from opendr import Source, learner_by_name  # wrong: no such name
from opendr.engine.data import Image
from opendr.engine.target import BoundingBox, BoundingBoxList, Pose
from opendr.perception.object_detection_2d import NanodetLearner, draw_bounding_boxes

NanodetLearner(treshold=0.5)  # wrong: keyword
NanodetLearner(threshold="high")  # wrong: type
NanodetLearner(suppression="strict")  # wrong: none of the choices
detector = NanodetLearner(device="cpu", threshold=0.4)
detector.infer()  # wrong: no input
detector.infer(7)  # wrong: type of the input
detector.infer("street.jpg", device="cpu")  # wrong: fixed while running
detector.threshold = None  # wrong: not optional
detector.load(variant=3)  # wrong: type

found = detector.infer("street.jpg")
found.keypoints  # wrong: boxes have none
found.add_box("person")  # wrong: type of the item
found[0].left.upper()  # wrong: a number
count: str = len(found)  # wrong: an int
found.plot(7)  # wrong: no image
found.save()  # wrong: no path
found.plot().to_pandas()  # wrong: an image is no table
detector.infer(["street.jpg"], progress="no")  # wrong: type
poses: Pose = detector.infer("street.jpg")  # wrong: boxes
one: BoundingBoxList = detector.infer(["street.jpg", "park.jpg"])  # wrong: a list of them
for frame in Source("street.mp4"):
    frame.timestamp + "s"  # wrong: nanoseconds, or None
BoundingBox(name=0, left=1, top=2, width=3)  # wrong: no height
draw_bounding_boxes(Image.open("street.jpg"), [0, 0, 10, 10])  # wrong: no BoundingBoxList
