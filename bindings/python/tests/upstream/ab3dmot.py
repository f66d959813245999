"""Tracks of 3D boxes."""

from opendr.engine.target import BoundingBox3D, BoundingBox3DList
from opendr.perception.object_tracking_3d import ObjectTracking3DAb3dmotLearner
from opendr.perception.object_tracking_3d.ab3dmot.object_tracking_3d_ab3dmot_learner import (
    ObjectTracking3DAb3dmotLearner as Same,
)

assert Same is ObjectTracking3DAb3dmotLearner
learner = ObjectTracking3DAb3dmotLearner("cpu", 2, 1)
for step in range(4):
    car = BoundingBox3D("Car", 0, 0, 0.0, [0, 0, 1, 1], [4.0, 1.5, 1.8], [5 + 0.2 * step, 1.6, 20], 0.0, 0.9)
    tracks = learner.infer(BoundingBox3DList([car]))
assert len(tracks) == 1 and tracks[0].id >= 0
assert tracks.kitti(True)["id"].tolist() == [tracks[0].id]
assert tracks.bounding_box_3d_list()[0].name == "Car"
learner.reset()
