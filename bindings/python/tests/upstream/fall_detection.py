"""Falls, from the poses of a pose estimator and from given poses."""

import csv
import os

from opendr.engine.data import Image
from opendr.engine.datasets import ExternalDataset
from opendr.engine.target import Category, Pose
from opendr.perception.fall_detection import FallDetectorLearner, URFallDatasetIterator
from opendr.perception.pose_estimation import LightweightOpenPoseLearner, draw, get_bbox

pose_estimator = LightweightOpenPoseLearner(device="cpu")
pose_estimator.download(path=".", verbose=True)
pose_estimator.load("openpose_default")
fall_detector = FallDetectorLearner(pose_estimator)
img = Image.open(os.path.join(os.environ["OPENDR_TEST_DATA"], "data/photos/bus.jpg"))
detections = fall_detector.infer(img)
assert len(detections) >= 1
frame = img.opencv()
for detection in detections:
    fallen, pose = detection[0].data, detection[1]
    assert fallen in (1, -1, 0)
    draw(frame, pose)
    x, y, w, h = get_bbox(pose)
assert any(category.data == -1 for category, _ in detections)

# Lying on the side: neck, hips, knees and ankles in a line.
lying = [[-1.0, -1.0]] * 18
for joint, x in ((1, 10), (8, 60), (11, 62), (9, 90), (12, 92), (10, 120), (13, 122)):
    lying[joint] = [float(x), 100.0]
((category, pose),) = fall_detector.infer([Pose(lying, 0.9)])
assert category.data == 1 and category.description == "fallen"
((category, _),) = FallDetectorLearner().infer([Pose([[y, x] if x >= 0 else [-1, -1] for x, y in lying], 0.9)])
assert category.data == -1

os.makedirs("test_images")
for name in ("fallen", "standing", "no_person"):
    (img if name != "no_person" else Image(img.opencv()[:40, :40])).save(f"test_images/{name}.png")
with open("test_images/annotations.csv", "w", newline="") as file:
    csv.writer(file).writerows([["test", "fallen", 1], ["test", "standing", -1], ["test", "no_person", 0]])
r = fall_detector.eval(dataset=ExternalDataset(path="./test_images", dataset_type="test"), verbose=False)
assert r["specificity"] == 1 and r["sensitivity"] == 0 and r["accuracy"] == 0.5 and r["no_detections"] == 0
assert fall_detector.eval(URFallDatasetIterator([img], [Category(-1)]))["accuracy"] == 1
