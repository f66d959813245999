"""OpenDR's hyperparameter tuner."""

from __future__ import annotations

from opendr._upstream.rows import Absent, Home

_HERE = "opendr.utils.hyperparameter_tuner"

MODULES: dict[str, dict[str, Home]] = {
    "": {"HyperparameterTuner": _HERE},
    "dummy_learner": {
        "DummyLearner": Absent("any class with get_hyperparameters() can be tuned; docs/tuning.md has one")
    },
    "hyperparameter_tuner": {"HyperparameterTuner": _HERE},
}
