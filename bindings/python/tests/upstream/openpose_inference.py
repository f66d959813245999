"""Poses, drawn, with the boxes around them."""

import os

from opendr.engine.data import Image
from opendr.perception.pose_estimation import LightweightOpenPoseLearner, draw, get_bbox
from opendr.perception.pose_estimation.lightweight_open_pose.utilities import draw as same_draw

assert same_draw is draw
pose_estimator = LightweightOpenPoseLearner(
    device="cpu", num_refinement_stages=2, mobilenet_use_stride=False, half_precision=False
)
pose_estimator.download(path=".", verbose=True)
pose_estimator.load("openpose_default")
img = Image.open(os.path.join(os.environ["OPENDR_TEST_DATA"], "data/photos/zidane.jpg"))
poses = pose_estimator.infer(img, 4, False, False)
assert len(poses) >= 1
img_cv = img.opencv()
for pose in poses:
    draw(img_cv, pose)
    x, y, w, h = get_bbox(pose)
    assert w > 0 and h > 0 and pose["neck"][0] == pose[1].x
    assert "Keypoints name-position:" in str(pose)
assert not (img_cv == img.opencv()).all()
