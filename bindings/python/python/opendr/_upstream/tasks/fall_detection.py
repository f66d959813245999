"""OpenDR's perception.fall_detection."""

from __future__ import annotations

from opendr._upstream.rows import HERE, Home, Learner

MODULES: dict[str, dict[str, Home]] = {
    "fall_detector_learner": {
        "FallDetectorLearner": HERE,
        "URFallDatasetIterator": "opendr._upstream.pose_datasets",
    },
}

LEARNERS = {
    "FallDetectorLearner": Learner(
        init="pose_estimator",
        infer="input_>image",
        eval="dataset verbose",
        methods={"initialize": ""},
        mixin="opendr._upstream.learners.people:FallDetector",
        demos="inference, eval",
        differs=(
            "without a pose estimator, it detects persons itself and returns boxes of the classes `unknown`, `fallen`, "
            "`standing`, and poses",
            "with one, a lying leg alone is not a fall when the torso is upright",
            "there is no `test_data`; `eval` of an estimator's falls takes URFallDatasetIterator",
        ),
    ),
}
