"""Estimates the poses of several persons. Input: people.jpg, a photograph with persons."""

import opendr

estimator = opendr.learner("movenet/multipose")
poses = estimator.infer("people.jpg")
for pose in poses:
    nose = pose["nose"]
    print(f"nose at {nose.x:.0f}, {nose.y:.0f}, score {pose.confidence:.2f}")
poses.save("estimate_poses.png")
