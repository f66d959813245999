"""One car is tracked in lidar scans."""

import os

from opendr.engine.target import TrackingAnnotation3D
from opendr.perception.object_detection_3d import LabeledPointCloudsDatasetIterator
from opendr.perception.object_tracking_3d import ObjectTracking3DVpitLearner

root = os.path.join(os.environ["OPENDR_TEST_DATA"], "data/kitti/object_vis")
learner = ObjectTracking3DVpitLearner(
    "configs/pointpillars_car.proto", device="cpu", backbone="pp", search_type="small"
)
learner.download("pointpillars_car_xyres_16", "./models")
learner.load("./models/pointpillars_car_xyres_16", full=True)
dataset = LabeledPointCloudsDatasetIterator(
    os.path.join(root, "velodyne"), os.path.join(root, "label_2"), os.path.join(root, "calib")
)
point_cloud, boxes = dataset[1]
box = next(box for box in boxes if box.name in ("Car", "Truck", "Cyclist"))
label = TrackingAnnotation3D(
    box.name, box.truncated, box.occluded, box.alpha, box.bbox2d, box.dimensions, box.location, box.rotation_y, id=3
)
learner.init(point_cloud, label)
tracks = learner.infer(point_cloud, 1, 3)
assert len(tracks) == 1 and (tracks[0].id, tracks[0].frame) == (3, 1)
assert abs(tracks[0].location - box.location).max() < 3
