"""OpenDR's control.single_demo_grasp."""

from __future__ import annotations

from opendr._upstream.rows import Absent, Home

_NAMES: dict[str, Home] = {
    "SingleDemoGraspLearner": Absent(
        "use GrConvNetLearner of perception.grasp_detection, which predicts grasps of any object"
    )
}

MODULES: dict[str, dict[str, Home]] = {
    "training.single_demo_grasp_learner": _NAMES,
}
