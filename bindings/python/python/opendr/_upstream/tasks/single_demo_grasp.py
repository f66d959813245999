"""OpenDR's control.single_demo_grasp."""

from __future__ import annotations

from opendr._upstream.rows import Home, Learner

MODULES: dict[str, dict[str, Home]] = {
    "training.single_demo_grasp_learner": {"SingleDemoGraspLearner": "opendr.perception.grasp_detection"},
}

LEARNERS = {
    "SingleDemoGraspLearner": Learner(
        init=(
            "object_name data_directory lr batch_size!regions img_per_step num_workers num_classes!objects iters threshold device"
        ),
        infer="img_data>image",
        fit="dataset",
        mixin="opendr._upstream.learners.grasping:SingleDemo",
        demos="–",
        differs=(
            "A small network of our own is trained, not Keypoint R-CNN; the demonstration is a data set of COCO with one image and "
            "two key points, the jaws",
            "`infer` returns a list of poses with the jaws as key points, empty where OpenDR returns `(0, None, None)`",
        ),
    ),
}
