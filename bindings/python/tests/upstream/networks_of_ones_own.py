"""Detectors that are trained in other tools."""

import os

import numpy as np
from opendr.perception.object_detection_2d import DetrLearner, YOLOv3DetectorLearner, YOLOv5DetectorLearner

network = os.path.join(os.environ["OPENDR_TEST_DATA"], "models/found/yolox_nano.onnx")
image = np.zeros((64, 96, 3), np.uint8)
detectors = [
    YOLOv5DetectorLearner(model_name="custom", path=network, device="cpu", temp_path=".", force_reload=False),
    YOLOv3DetectorLearner(lr=0.001, backbone="darknet53", img_size=416, device="cpu", temp_path="temp"),
    DetrLearner(iters=10, backbone="resnet50", threshold=0.7, num_classes=91, device="cpu"),
]
for detector in detectors:
    detector.load(network)
    assert len(detector.infer(image)) == 0
assert len(detectors[1].infer(image, 0.1, keep_size=False)) == 0
