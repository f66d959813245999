"""OpenDR's perception.gesture_recognition."""

from __future__ import annotations

from opendr._upstream.rows import Absent, Home

MODULES: dict[str, dict[str, Home]] = {
    "gesture_recognition_learner": {
        "GestureRecognitionLearner": Absent(
            "use HandGestureLearner, which detects hands and classifies their gestures, or train NanodetLearner on HaGRID"
        )
    },
}
