"""Scans with boxes and tracks in KITTI's format."""

import os
import shutil

from opendr.engine.data import PointCloudWithCalibration
from opendr.perception.object_detection_3d import KittiDataset, LabeledPointCloudsDatasetIterator
from opendr.perception.object_tracking_3d import KittiTrackingDatasetIterator, ObjectTracking3DAb3dmotLearner
from opendr.perception.object_tracking_3d.datasets.kitti_tracking import LabeledTrackingPointCloudsDatasetIterator

root = os.path.join(os.environ["OPENDR_TEST_DATA"], "data/kitti/object_vis")
folders = [os.path.join(root, name) for name in ("velodyne", "label_2", "calib", "image_2")]
dataset = LabeledPointCloudsDatasetIterator(*folders)
point_cloud, boxes = dataset[0]
assert isinstance(point_cloud, PointCloudWithCalibration) and len(point_cloud) > 1000
assert set(point_cloud.calib) >= {"P2", "R0_rect", "Tr_velo_to_cam"} and min(point_cloud.image_shape) > 300
native = KittiDataset(root).open(target="BoundingBox3DList")
assert [box.name for box in boxes] == [
    native.classes[box.name] if isinstance(box.name, int) else box.name for box in native[0][1]
] or len(boxes) >= len(native[0][1])
assert boxes.kitti()["dimensions"].shape == (len(boxes), 3)

line = "0 0 -1.57 599.41 156.40 629.75 189.25 2.85 2.63 12.34 0.47 1.49 69.44 -1.56"
for folder in ("detections", "labels", "scans"):
    os.makedirs(folder)
with open("detections/0000.txt", "w") as file:
    file.write(f"0 Car {line} 0.9\n1 Car {line} 0.8\n")
with open("labels/0000.txt", "w") as file:
    file.write(f"0 5 Car {line}\n1 5 Car {line}\n")
(inputs, truths), *_ = KittiTrackingDatasetIterator("detections", "labels", "detection")
assert [len(found) for found in inputs] == [1, 1] and truths[1][0].id == 5 and truths[1][0].frame == 1
assert inputs[0][0].dimensions.tolist() == [12.34, 2.85, 2.63]
learner = ObjectTracking3DAb3dmotLearner(device="cpu", min_updates=1)
assert [len(learner.infer(bounding_boxes_3d_list=found)) for found in inputs] == [1, 1]

for frame in (0, 1):
    shutil.copy(os.path.join(root, "velodyne/000000.bin"), f"scans/00000{frame}.bin")
recording = LabeledTrackingPointCloudsDatasetIterator(
    "scans", "labels/0000.txt", os.path.join(root, "calib/000000.txt")
)
cloud, tracks = recording[1]
assert len(recording) == 2 and tracks[0].id == 5
try:
    KittiDataset.download_nano_kitti("./data", True)
except NotImplementedError as error:
    assert "KITTI" in str(error)
