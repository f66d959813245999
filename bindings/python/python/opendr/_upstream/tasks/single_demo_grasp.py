"""OpenDR's control.single_demo_grasp."""

from __future__ import annotations

from opendr._upstream.rows import Absent, Home

_NAMES: dict[str, Home] = {
    "SingleDemoGraspLearner": Absent(
        "use SingleDemoGraspLearner of perception.grasp_detection, whose fit takes the demonstration as a data set"
    )
}

MODULES: dict[str, dict[str, Home]] = {
    "training.single_demo_grasp_learner": _NAMES,
}
