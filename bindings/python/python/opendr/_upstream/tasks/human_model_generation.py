"""OpenDR's simulation.human_model_generation."""

from __future__ import annotations

from opendr._upstream.rows import Absent, Home

MODULES: dict[str, dict[str, Home]] = {
    "pifu_generator_learner": {
        "PIFuGeneratorLearner": Absent(
            "there is no learner of 3D body models; BlazePoseLearner predicts joints in an image"
        )
    },
}
