"""Without a pose estimator the fall detector detects persons itself."""

import os

from opendr.engine.data import Image
from opendr.perception.fall_detection.fall_detector_learner import FallDetectorLearner

detector = FallDetectorLearner()
detector.download()
detector.load()
img = Image.open(os.path.join(os.environ["OPENDR_TEST_DATA"], "data/photos/bus.jpg"))
falls, poses = detector.infer(img)
assert len(falls) == len(poses) >= 1 and set(detector.classes) == {"unknown", "fallen", "standing"}
# The rules in Python and in the native module agree on the same poses.
detector.hold = 0.0
detector.reset()
falls, poses = detector.infer(img)
assert [category.description for category, _ in detector.infer(poses)] == [box.class_name for box in falls]
