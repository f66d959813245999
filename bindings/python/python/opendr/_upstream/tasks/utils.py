"""OpenDR's utils."""

from __future__ import annotations

from opendr._upstream.rows import Absent, Home

_TUNER = "opendr.utils.hyperparameter_tuner"
_AMBIGUITY = "opendr.utils.ambiguity_measure"

MODULES: dict[str, dict[str, Home]] = {
    "ambiguity_measure": {"AmbiguityMeasure": _AMBIGUITY},
    "ambiguity_measure.ambiguity_measure": {"AmbiguityMeasure": _AMBIGUITY},
    "hyperparameter_tuner": {"HyperparameterTuner": _TUNER},
    "hyperparameter_tuner.dummy_learner": {
        "DummyLearner": Absent("any class with get_hyperparameters() can be tuned; docs/tuning.md has one")
    },
    "hyperparameter_tuner.hyperparameter_tuner": {"HyperparameterTuner": _TUNER},
    "io": {"bump_version": "opendr.utils.io"},
}
