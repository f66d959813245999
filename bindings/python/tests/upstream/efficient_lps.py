"""Panoptic segmentation of a scan."""

import os

from opendr.engine.datasets import PointCloudsDatasetIterator
from opendr.perception.panoptic_segmentation import EfficientLpsLearner, SemanticKittiDataset

scans = os.path.join(os.environ["OPENDR_TEST_DATA"], "data/kitti/object_vis/velodyne")
EfficientLpsLearner.download("data", mode="model", trained_on="semantickitti")
learner = EfficientLpsLearner(config_file="singlegpu_semantickitti.py", device="cpu")
learner.load("data/model_semantickitti.pth")
cloud = PointCloudsDatasetIterator(scans)[0]
instance, semantic, depth = learner.infer(cloud, False, True)
assert instance.numpy().shape == semantic.numpy().shape

os.makedirs("kitti/sequences/08/velodyne")
with open("kitti/sequences/08/velodyne/000000.bin", "wb") as file:
    file.write(cloud.numpy()[:100].astype("<f4").tobytes())
dataset = SemanticKittiDataset("kitti", split="valid")
assert len(SemanticKittiDataset.load_point_cloud("kitti/sequences/08/velodyne/000000.bin")) == 100
assert len(dataset) == 1 and len(dataset[0][0]) == 100 and dataset[0][1] is None
