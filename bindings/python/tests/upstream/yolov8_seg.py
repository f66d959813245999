"""A network that segments objects is exported by another tool."""

import os

import numpy as np
from opendr.engine.data import Image
from opendr.perception.semantic_segmentation import YOLOv8SegLearner

network = os.path.join(os.environ["OPENDR_TEST_DATA"], "models/found/yolox_nano.onnx")
yolo = YOLOv8SegLearner(model_name="yolov8s-seg", model_path=network, device="cpu", temp_path=".")
heatmap = yolo.infer(Image(np.zeros((64, 96, 3), np.uint8)), conf_thres=0.25, iou_thres=0.7, verbose=True, show=False)
assert heatmap.data.shape == (64, 96) and not heatmap.data.any()
assert len(yolo.get_bboxes()) == 0 and yolo.get_classes()[0] == "background"
