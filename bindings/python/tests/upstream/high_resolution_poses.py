"""Poses of a large image in two passes."""

import os

from opendr.engine.data import Image
from opendr.perception.pose_estimation import HighResolutionPoseEstimationLearner, draw

pose_estimator = HighResolutionPoseEstimationLearner(
    device="cpu", num_refinement_stages=2, mobilenet_use_stride=False, half_precision=False,
    first_pass_height=240, second_pass_height=320, method="adaptive",
)  # fmt: skip
pose_estimator.download(path=".", verbose=True)
pose_estimator.load("openpose_default")
img = Image.open(os.path.join(os.environ["OPENDR_TEST_DATA"], "data/photos/zidane.jpg"))
poses = pose_estimator.infer(img, 4, 8, False, False, False)
assert len(pose_estimator.infer_adaptive(img)) >= 1
frame = img.opencv()
for pose in poses:
    draw(frame, pose)
assert len(poses) >= 1
