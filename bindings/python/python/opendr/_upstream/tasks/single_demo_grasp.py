"""OpenDR's control.single_demo_grasp."""

from __future__ import annotations

from opendr._upstream.rows import HERE, Home, Learner

_NAMES: dict[str, Home] = {"SingleDemoGraspLearner": HERE}

MODULES: dict[str, dict[str, Home]] = {
    "training.single_demo_grasp_learner": _NAMES,
}

LEARNERS = {
    "SingleDemoGraspLearner": Learner(
        init="object_name!object data_directory!path lr batch_size!regions img_per_step>batch_size num_workers num_classes!object"
        " iters threshold device",
        demos="–",
        differs=(
            "`fit` takes the data set as argument, one image with one pose of two key points, instead of `object_name` and "
            "`data_directory`",
            "`infer` returns a pose list whose key points are the jaws, empty instead of `(0, None, None)`",
            "the network has 0.2 million parameters and runs on the CPU; weights of OpenDR's Keypoint R-CNN are not read",
        ),
    ),
}
