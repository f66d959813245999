"""Hyperparameter search for every learner.

    from opendr.utils.hyperparameter_tuner import HyperparameterTuner

    tuner = HyperparameterTuner(MyLearner)
    best = tuner.optimize(
        hyperparameters=[{"name": "lr", "type": "float", "low": 1e-5, "high": 1e-2, "log": True}],
        fit_arguments={"dataset": dataset},
        eval_arguments={"dataset": dataset},
        objective_function=lambda results: results["loss"],
        n_trials=50,
    )
    learner = MyLearner(**best)
"""

from __future__ import annotations

from opendr.utils.hyperparameter_tuner.hyperparameter_tuner import HyperparameterTuner
from opendr.utils.hyperparameter_tuner.study import Study
from opendr.utils.hyperparameter_tuner.trial import TrialPruned

__all__ = ["HyperparameterTuner", "Study", "TrialPruned"]
