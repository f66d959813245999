"""Trials on a real Ray cluster of this machine."""

import os
import signal
import sys

import pytest
from opendr.engine.learners import Learner
from opendr.utils.hyperparameter_tuner import HyperparameterTuner, Study

ray = pytest.importorskip("ray")

SPACE = [{"name": "x", "type": "uniform", "low": -1.0, "high": 1.0}]


@pytest.fixture(scope="module")
def cluster():
    paths = {"env_vars": {"PYTHONPATH": os.pathsep.join(sys.path)}}
    context = ray.init(num_cpus=2, include_dashboard=False, log_to_driver=False, runtime_env=paths)
    yield context.address_info["address"]
    ray.shutdown()


class Square(Learner):
    def __init__(self, x):
        super().__init__()
        self.x = x

    def fit(self, dataset, report=None):
        if dataset == "killed" and self.x == 0.5:
            os.kill(os.getpid(), signal.SIGKILL)
        for step in range(1, 4):
            report(step, {"loss": self.x**2 + 1 / step, "process": os.getpid()})

    def eval(self, dataset):
        return {"loss": self.x**2, "process": os.getpid()}

    def infer(self, batch):
        raise NotImplementedError

    save = load = optimize = reset = infer


def arguments(dataset=None):
    return {"fit_arguments": {"dataset": dataset}, "eval_arguments": {"dataset": None}}


def test_trials_run_on_the_cluster(cluster, tmp_path):
    study, here = Study("ray", storage=tmp_path / "study.log"), os.getpid()

    def objective(results):
        assert results["process"] != here
        return results["loss"]

    best = HyperparameterTuner(Square, study).optimize(
        SPACE, objective_function=objective, n_trials=16, n_jobs=-1, ray=True, **arguments()
    )
    trials = study.trials()
    assert [trial["state"] for trial in trials] == ["complete"] * 16
    assert all(set(trial["reports"]) == {"1", "2", "3"} for trial in trials)
    assert study.best()["value"] == pytest.approx(best["x"] ** 2) and abs(best["x"]) < 0.3
    assert ray.is_initialized(), "a cluster that was there is left alone"


def test_a_killed_worker_loses_its_one_trial_only(cluster):
    study = Study(sampler="random")
    study.enqueue({"x": 0.5})
    HyperparameterTuner(Square, study).optimize(
        SPACE, objective_function=lambda results: results["loss"], n_trials=5, n_jobs=2, ray=True, **arguments("killed")
    )
    states = {trial["number"]: trial["state"] for trial in study.trials()}
    assert states == {0: "failed", 1: "complete", 2: "complete", 3: "complete", 4: "complete"}


def test_what_a_learner_raises_there_is_raised_here(cluster):
    def objective(results):
        raise ValueError("no such number")

    study = Study()
    with pytest.raises(ValueError, match="no such number"):
        HyperparameterTuner(Square, study).optimize(
            SPACE, objective_function=objective, n_trials=9, n_jobs=2, ray=True, **arguments()
        )
    assert all(trial["state"] == "failed" for trial in study.trials()), "none is left running"
