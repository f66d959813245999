"""OpenDR's control.multi_object_search."""

from __future__ import annotations

from opendr._upstream.rows import Absent, Home

MODULES: dict[str, dict[str, Home]] = {
    "multi_object_search_learner": {
        "MultiObjectSearchRLLearner": Absent("use PpoLearner of control.reinforcement_learning, the method behind it")
    },
}
