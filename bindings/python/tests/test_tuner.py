"""OpenDR's tuner: arguments, resumed studies, several seeds, pruning, failures."""

import math

import pytest
from opendr.engine.learners import Learner, LearnerRL
from opendr.utils.hyperparameter_tuner import HyperparameterTuner, Study
from opendr.utils.hyperparameter_tuner.hyperparameter_tuner import HyperparameterTuner as ByUpstreamsPath

SPACE = [
    {"name": "lr", "type": "loguniform", "low": 1e-5, "high": 1e-1},
    {"name": "momentum", "type": "discrete_uniform", "low": 0.0, "high": 0.75, "q": 0.25},
    {"name": "optimizer", "type": "categorical", "choices": ["sgd", "adam"]},
    {"name": "size", "type": "int", "low": 2, "high": 64, "log": True},
]


class Bowl(Learner):
    """A learner without training, whose loss is a function of its arguments."""

    def __init__(self, lr, momentum=0.0, optimizer="sgd", size=8, offset=0.0, device="cpu"):
        super().__init__()
        self.worth = (math.log10(lr) + 3) ** 2 + momentum + (optimizer == "sgd") + abs(math.log2(size) - 4) / 4 + offset

    def fit(self, dataset, val_dataset=None, logging_path="", silent=True, verbose=True):
        if dataset == "broken" and self.worth > 1:
            raise ValueError("no such data")
        return {}

    def eval(self, dataset):
        return {"loss": self.worth, "score": -self.worth}

    def infer(self, batch):
        raise NotImplementedError

    save = load = optimize = reset = infer


class Declared(Bowl):
    @staticmethod
    def get_hyperparameters():
        return SPACE

    @staticmethod
    def get_objective_function():
        return lambda results: results["loss"]


class Steps(Bowl):
    """Reports intermediate values during the training."""

    def fit(self, dataset, report=None):
        for step in range(1, 10):
            report(step, {"loss": self.worth + 1 / step})


class Agent(LearnerRL):
    def __init__(self, lr, seed=0):
        super().__init__()
        self.lr, self.seed = lr, seed

    def fit(self, env, val_env=None, logging_path="", silent=True, verbose=True):
        env.append(self.seed)

    def eval(self, env):
        return {"return": self.lr * 1000 + self.seed}

    def infer(self, batch):
        raise NotImplementedError

    save = load = optimize = reset = infer


def loss(results):
    return results["loss"]


DATA = {"fit_arguments": {"dataset": None}, "eval_arguments": {"dataset": None}}


def test_the_best_arguments_are_found_over_the_given_ones():
    assert ByUpstreamsPath is HyperparameterTuner
    tuner = HyperparameterTuner(Bowl)
    best = tuner.optimize(SPACE, {"device": "cuda"}, objective_function=loss, n_trials=60, **DATA)
    assert set(best) == {"device", "lr", "momentum", "optimizer", "size"} and best["device"] == "cuda"
    assert best["optimizer"] == "adam" and isinstance(best["size"], int) and best["momentum"] in (0, 0.25)
    assert Bowl(**best).worth < 0.8
    assert len(tuner.study.trials()) == 60
    assert sum(tuner.study.importance().values()) == pytest.approx(1)


def test_a_learner_may_declare_what_is_tuned():
    assert set(HyperparameterTuner(Declared).optimize(n_trials=3, **DATA)) == {entry["name"] for entry in SPACE}
    with pytest.raises(ValueError, match="give hyperparameters and objective_function"):
        HyperparameterTuner(Bowl).optimize(n_trials=1)
    with pytest.raises(ValueError, match="class of a learner"):
        HyperparameterTuner(Bowl(0.1))


def test_the_direction_of_the_study_is_kept():
    study = Study(direction="maximize")
    best = HyperparameterTuner(Bowl, study).optimize(
        SPACE, objective_function=lambda results: results["score"], n_trials=30, **DATA
    )
    assert study.best()["value"] == max(trial["value"] for trial in study.trials()) == pytest.approx(-Bowl(**best).worth)


def test_a_study_in_a_file_goes_on(tmp_path):
    for _ in range(2):
        study = Study("shared", storage=tmp_path / "study.log", seed=3)
        HyperparameterTuner(Bowl, study).optimize(SPACE, objective_function=loss, n_trials=12, n_jobs=3, **DATA)
    assert [trial["state"] for trial in study.trials()] == ["complete"] * 24
    with pytest.raises(ValueError, match="directions"):
        Study("shared", direction="maximize", storage=tmp_path / "study.log")


def test_agents_count_after_three_seeds():
    seeds, study = [], Study(direction="maximize")
    space = [{"name": "lr", "type": "uniform", "low": 0, "high": 1}]
    arguments = {"fit_arguments": {"env": seeds}, "eval_arguments": {"env": None}}
    reward = {"objective_function": lambda results: results["return"], "n_trials": 5}
    best = HyperparameterTuner(Agent, study).optimize(space, **arguments, **reward)
    assert seeds == [0, 1, 2] * 5
    assert study.best()["value"] == pytest.approx(best["lr"] * 1000 + 1)
    HyperparameterTuner(Agent, Study(direction="maximize")).optimize(space, n_seeds=1, **arguments, **reward)
    assert len(seeds) == 20
    with pytest.raises(ValueError, match="has no argument seed"):
        HyperparameterTuner(Bowl).optimize(SPACE, objective_function=loss, n_trials=1, n_seeds=2)


def test_a_learner_that_reports_is_pruned():
    study = Study(pruner={"name": "asha", "first": 1, "factor": 3})
    HyperparameterTuner(Steps, study).optimize(SPACE, objective_function=loss, n_trials=40, n_jobs=2, **DATA)
    trials = study.trials()
    pruned = [trial for trial in trials if trial["state"] == "pruned"]
    assert 10 < len(pruned) < 40 and {len(trial["reports"]) for trial in pruned} <= {1, 3, 9}
    assert min(trials, key=lambda trial: trial["value"])["value"] <= study.best()["value"]


def test_failures_are_told_and_end_the_study():
    study = Study(sampler="random")
    arguments = {"objective_function": loss, "eval_arguments": {"dataset": None}, "fit_arguments": {"dataset": "broken"}}
    with pytest.raises(ValueError, match="no such data"):
        HyperparameterTuner(Bowl, study).optimize(SPACE, n_trials=200, **arguments)
    failed = [trial for trial in study.trials() if trial["state"] == "failed"]
    assert len(failed) >= 3 and failed[-1]["fail_reason"] == "ValueError: no such data"
    with pytest.raises(ValueError, match="is not a number"):
        HyperparameterTuner(Bowl).optimize(SPACE, objective_function=lambda _: math.nan, n_trials=9, **DATA)
    with pytest.raises(ValueError, match="nobody"):
        HyperparameterTuner(Bowl).optimize(
            [{"name": "lr", "type": "nobody"}], objective_function=loss, n_trials=1, **DATA
        )
    with pytest.raises(ValueError, match="more trials or time"):
        HyperparameterTuner(Bowl).optimize(SPACE, objective_function=loss, timeout=0, **DATA)
    for wrong in ({"direction": "up"}, {"sampler": "guess"}, {"pruner": "shears"}):
        with pytest.raises(ValueError):
            Study(**wrong)


def test_ctrl_c_leaves_the_study_whole():
    study = Study()

    class Interrupted(Bowl):
        def fit(self, dataset):
            if len(study.trials()) == 4:
                raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        HyperparameterTuner(Interrupted, study).optimize(SPACE, objective_function=loss, n_trials=9, **DATA)
    assert [trial["state"] for trial in study.trials()] == ["complete"] * 3 + ["failed"]
    HyperparameterTuner(Bowl, study).optimize(SPACE, objective_function=loss, n_trials=2, **DATA)
    assert len(study.trials()) == 6


def test_a_study_of_optuna_serves_as_well():
    optuna = pytest.importorskip("optuna")
    optuna.logging.set_verbosity(optuna.logging.ERROR)
    study = optuna.create_study(sampler=optuna.samplers.RandomSampler(seed=0))
    best = HyperparameterTuner(Bowl, study).optimize(SPACE, objective_function=loss, n_trials=20, **DATA)
    assert len(study.trials) == 20 and study.best_value == pytest.approx(Bowl(**best).worth)
