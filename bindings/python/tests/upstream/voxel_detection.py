"""Cars in the scans of a lidar."""

import os

from opendr.engine.data import PointCloud
from opendr.engine.datasets import PointCloudsDatasetIterator
from opendr.perception.object_detection_3d import KittiDataset, VoxelObjectDetection3DLearner

root = os.path.join(os.environ["OPENDR_TEST_DATA"], "data/kitti/object_vis")
learner = VoxelObjectDetection3DLearner(
    model_config_path="configs/pointpillars_car.proto", device="cpu", temp_path="temp", batch_size=2,
    optimizer="adam_optimizer", lr_schedule="exponential_decay_learning_rate", checkpoint_after_iter=10,
)  # fmt: skip
VoxelObjectDetection3DLearner.download("pointpillars_car_xyres_16", "./models")
learner.load("./models/pointpillars_car_xyres_16", verbose=True)
clouds = PointCloudsDatasetIterator(os.path.join(root, "velodyne"))
found = learner.infer(clouds[1])
assert type(found).__name__ == "BoundingBox3DList"
assert len(learner.infer([clouds[0], PointCloud(clouds[1].data)])) == 2
results = learner.eval(KittiDataset(root), verbose=False, count=2)
assert results["report"]["samples"] == 2
