"""Non-maximum suppression of OpenDR, within a detector and on arrays."""

import os

import numpy as np
from opendr.engine.data import Image
from opendr.engine.target import BoundingBox, BoundingBoxList
from opendr.perception.object_detection_2d import ClusterNMS, FastNMS, SingleShotDetectorLearner, SoftNMS
from opendr.perception.object_detection_2d.nms.cluster_nms.cluster_nms import ClusterNMS as SameClusterNMS
from opendr.perception.object_detection_2d.nms.utils import NMSCustom

assert SameClusterNMS is ClusterNMS
ssd = SingleShotDetectorLearner(device="cpu")
ssd.download(".", mode="pretrained")
ssd.load("./ssd_default_person", verbose=True)
img = Image.open(os.path.join(os.environ["OPENDR_TEST_DATA"], "data/photos/bus.jpg"))
usual = ssd.infer(img, threshold=0.3)
cluster_nms = ClusterNMS(device="cpu", nms_type="default", cross_class=True)
boxes = ssd.infer(img, threshold=0.3, custom_nms=cluster_nms)
# Cluster-NMS converges to the result of greedy suppression.
assert sorted(box.left for box in boxes) == sorted(box.left for box in usual)
assert boxes[0].class_name == "person" and boxes.classes == ["person"]
for other in (FastNMS(device="cpu"), SoftNMS("gaussian", "cpu"), ClusterNMS("diou", False, "cpu", 0.5, 200, 20)):
    assert len(ssd.infer(img, threshold=0.3, custom_nms=other)) >= 1


class OnlyTheBest(NMSCustom):
    def run_nms(self, boxes=None, scores=None, threshold=0.2, img=None):
        best = int(np.argmax(scores.max(axis=1)))
        left, top, right, bottom = boxes[best]
        box = BoundingBox(0, left, top, right - left, bottom - top, scores[best].max())
        return BoundingBoxList([box]), None


assert [box.confidence for box in ssd.infer(img, custom_nms=OnlyTheBest())] == [max(box.confidence for box in usual)]

corners = np.array([[0, 0, 10, 10], [1, 0, 11, 10], [30, 30, 40, 40]], dtype=np.float32)
scores = np.array([[0.9, 0.0], [0.8, 0.0], [0.0, 0.7]])
found, (kept, classes, values) = ClusterNMS("default", True, "cpu", 0.45).run_nms(corners, scores, None, 0.2)
assert kept.tolist() == corners[[0, 2]].tolist() and classes.tolist() == [0, 1] and len(found) == 2
found, (_, _, values) = SoftNMS("linear", "cpu").run_nms(boxes=corners, scores=scores, threshold=0.0)
overlap = 90 / 110
assert np.allclose(sorted(values), sorted([0.9, 0.8 * (1 - overlap), 0.7]))
