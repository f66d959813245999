"""OpenDR's perception.active_perception."""

from __future__ import annotations

from opendr._upstream.rows import Absent, Home

_TEXT = Absent("train PpoLearner of control.reinforcement_learning in an environment of your own")
_NAMES: dict[str, Home] = {"ActiveFaceRecognitionLearner": _TEXT}

MODULES: dict[str, dict[str, Home]] = {
    "active_face_recognition": _NAMES,
    "active_face_recognition.active_face_recognition_learner": _NAMES,
}
