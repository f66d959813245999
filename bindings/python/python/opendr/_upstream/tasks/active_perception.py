"""OpenDR's perception.active_perception."""

from __future__ import annotations

from opendr._upstream.rows import HERE, Home, Learner

_NAMES: dict[str, Home] = {"ActiveFaceRecognitionLearner": HERE}

MODULES: dict[str, dict[str, Home]] = {
    "active_face_recognition": _NAMES,
    "active_face_recognition.active_face_recognition_learner": _NAMES,
}

LEARNERS = {
    "ActiveFaceRecognitionLearner": Learner(
        demos="–",
        differs=(
            "`fit` takes the environment as argument (`env=\"SphereView-Face-v1\"`) instead of starting Webots",
            "`infer` takes an image, and returns a category whose `action` has an azimuth, an elevation and a distance, instead of "
            "one of ten discrete actions",
            "`eval` returns the accuracy of the camera policy and of baselines, not `rewards_collected`",
        ),
    ),
}
