"""The tuner and the measure of ambiguity."""

import numpy as np
from opendr.engine.learners import Learner
from opendr.utils.ambiguity_measure import AmbiguityMeasure
from opendr.utils.ambiguity_measure.ambiguity_measure import AmbiguityMeasure as Same
from opendr.utils.hyperparameter_tuner import HyperparameterTuner

assert Same is AmbiguityMeasure


class Parabola(Learner):
    def __init__(self, lr=0.001, iters=10):
        super().__init__(lr=lr, iters=iters)

    def fit(self, dataset, val_dataset=None, logging_path="", silent=True, verbose=True):
        return {}

    def eval(self, dataset):
        return {"loss": (self.lr - 0.5) ** 2}

    def infer(self, batch):
        return []

    @staticmethod
    def get_hyperparameters():
        return [{"name": "lr", "type": "float", "low": 0.0, "high": 1.0}]

    @staticmethod
    def get_objective_function():
        return lambda results: results["loss"]


best = HyperparameterTuner(Parabola).optimize(
    fit_arguments={"dataset": None}, eval_arguments={"dataset": None}, n_trials=20
)
assert abs(best["lr"] - 0.5) < 0.3

heatmap = np.zeros((32, 32))
heatmap[8, 8], heatmap[24, 24] = 10.0, 9.9
am = AmbiguityMeasure(threshold=0.1)
ambiguous, locs, maxima, probs = am.get_ambiguity_measure(heatmap)
assert ambiguous and locs[0].tolist() == [8, 8] and len(maxima) == len(probs)
