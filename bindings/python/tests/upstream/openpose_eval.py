"""Poses are evaluated on COCO's annotations, also with OpenDR's data set class."""

import os

from opendr.engine.datasets import ExternalDataset
from opendr.perception.pose_estimation import LightweightOpenPoseLearner
from opendr.perception.pose_estimation.lightweight_open_pose.algorithm.datasets.coco import (
    CocoTrainDataset,
    CocoValDataset,
)

root = os.path.join(os.environ["OPENDR_TEST_DATA"], "data/tiny_coco")
pose_estimator = LightweightOpenPoseLearner(device="cpu", temp_path="./parent_dir")
pose_estimator.download(path=".", verbose=True)
pose_estimator.load("openpose_default")
results = pose_estimator.eval(
    ExternalDataset(path=root, dataset_type="COCO"), use_subset=True, subset_size=2, silent=True,
    images_folder_name="train2017", annotations_filename="person_keypoints_train2017.json",
)  # fmt: skip
assert results["map50"] > 0.3 and results["report"]["samples"] == 2

labels = os.path.join(root, "annotations/person_keypoints_train2017.json")
for dataset in (
    CocoValDataset(labels, os.path.join(root, "train2017")),
    CocoTrainDataset(labels, os.path.join(root, "train2017"), 8, 7, 1),
):
    image, poses = dataset[0]
    assert len(dataset) == 50 and image.width > 0 and type(poses).__name__ == "PoseList"
