"""OpenDR's control.mobile_manipulation."""

from __future__ import annotations

from opendr._upstream.rows import Absent, Home

MODULES: dict[str, dict[str, Home]] = {
    "mobile_manipulation_learner": {
        "MobileRLLearner": Absent("use SacLearner of control.reinforcement_learning, the method behind it")
    },
}
