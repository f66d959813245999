"""Compares crates/tuning with Optuna 5: files both ways, importance, and how good trials are.

    pip install -r tests/tuning/requirements.txt
    cargo build --release -p opendr-tuning --example study
    OPENDR_TUNING_STUDY=target/release/examples/study pytest tests/tuning/compare_optuna.py -s

Optuna's 120 studies of the last test take a minute; OPENDR_TUNING_BASELINE names a file that keeps them.
"""

import json
import math
import os
import subprocess
from pathlib import Path

import numpy as np
import optuna
import pytest
from optuna.storages.journal import JournalFileBackend, JournalFileOpenLock
from optuna.trial import TrialState
from scipy.stats import mannwhitneyu

ROOT = Path(__file__).resolve().parents[2]
SEEDS, TRIALS = 30, 100
optuna.logging.set_verbosity(optuna.logging.ERROR)


def run(*args):
    program = os.environ.get("OPENDR_TUNING_STUDY")
    command = [program] if program else ["cargo", "run", "-q", "--release", "-p", "opendr-tuning", "--example", "study", "--"]
    done = subprocess.run([*command, *map(str, args)], cwd=ROOT, stdout=subprocess.PIPE, text=True, check=True)
    return [json.loads(line) for line in done.stdout.splitlines()]


def storage(path, lock=None):
    return optuna.storages.JournalStorage(JournalFileBackend(str(path), lock_obj=lock))


def branin(trial):
    x, y = trial.suggest_float("x", -5, 10), trial.suggest_float("y", 0, 15)
    valley = y - 5.1 / (4 * math.pi**2) * x * x + 5 / math.pi * x - 6
    return valley**2 + 10 * (1 - 1 / (8 * math.pi)) * math.cos(x) + 10


WEIGHTS = np.array([1.0, 1.2, 3.0, 3.2])
SCALES = np.array([[10, 3, 17, 3.5, 1.7, 8], [0.05, 10, 17, 0.1, 8, 14], [3, 3.5, 1.7, 10, 17, 8], [17, 8, 0.05, 10, 0.1, 14]])
CENTRES = 1e-4 * np.array(
    [
        [1312, 1696, 5569, 124, 8283, 5886],
        [2329, 4135, 8307, 3736, 1004, 9991],
        [2348, 1451, 3522, 2883, 3047, 6650],
        [4047, 8828, 8732, 5743, 1091, 381],
    ]
)


def hartmann6(trial):
    x = np.array([trial.suggest_float(f"x{i}", 0, 1) for i in range(6)])
    return -float(WEIGHTS @ np.exp(-(SCALES * (x - CENTRES) ** 2).sum(axis=1)))


def rosenbrock5(trial):
    x = [trial.suggest_float(f"x{i}", -2, 2) for i in range(5)]
    return sum(100 * (x[i + 1] - x[i] ** 2) ** 2 + (1 - x[i]) ** 2 for i in range(4))


def mixed(trial):
    lr = trial.suggest_float("lr", 1e-6, 1e-1, log=True)
    batch = trial.suggest_int("batch", 16, 1024, log=True)
    gamma = trial.suggest_float("gamma", 0.8, 0.9999)
    optimizer = trial.suggest_categorical("optimizer", ["sgd", "adam", "rmsprop"])
    bowl = (math.log10(lr) + 3.5) ** 2 + (math.log2(batch) - 8) ** 2 / 4 + (math.log10(1 - gamma) + 2) ** 2
    if optimizer == "sgd":
        return bowl + 1 + trial.suggest_float("momentum", 0, 0.99)
    return bowl if optimizer == "adam" else bowl + 0.5


FUNCTIONS = {function.__name__: function for function in (branin, hartmann6, rosenbrock5, mixed)}


def test_optuna_goes_on_with_our_journal(tmp_path):
    path = tmp_path / "study.log"
    run("mixed", "--trials", 25, "--journal", path, "--name", "ours")
    study = optuna.load_study(study_name="ours", storage=storage(path))
    assert [trial.state for trial in study.trials] == [TrialState.COMPLETE] * 25
    for trial in study.trials:
        assert trial.value == pytest.approx(mixed(optuna.trial.FixedTrial(trial.params)), rel=1e-12)
        assert trial.datetime_start <= trial.datetime_complete
        assert ("momentum" in trial.params) == (trial.params["optimizer"] == "sgd")
    study.optimize(mixed, n_trials=15)
    (best,) = run("mixed", "--trials", 50, "--journal", path, "--name", "ours")
    assert best["trials"] == 50
    study = optuna.load_study(study_name="ours", storage=storage(path))
    assert study.best_value == best["best"] and study.best_params == best["params"]


def test_we_go_on_with_optunas_journal(tmp_path):
    path = tmp_path / "study.log"
    study = optuna.create_study(study_name="theirs", storage=storage(path))
    study.optimize(mixed, n_trials=20)
    study.set_user_attr("note", {"nested": [1, None, "é"]})
    study.enqueue_trial({"lr": 1e-3, "batch": 256, "gamma": 0.99, "optimizer": "sgd", "momentum": 0.5})
    (best,) = run("mixed", "--trials", 40, "--journal", path, "--name", "theirs")
    trials = optuna.load_study(study_name="theirs", storage=storage(path)).trials
    assert len(trials) == 40 == best["trials"]
    queued = trials[20]
    assert queued.state == TrialState.COMPLETE and queued.params["lr"] == 1e-3 and queued.params["momentum"] == 0.5
    assert best["best"] == min(trial.value for trial in trials)


def everything(study):
    """Trials of every state, with numbers that JSON does not have, and old distributions."""

    def objective(trial):
        trial.suggest_float("x", 0.1, 0.7, step=0.1)
        trial.suggest_int("whole", 2, 63, step=2)
        trial.suggest_categorical("choice", ["a", None, 2.5, True])
        trial.report(math.nan if trial.number == 1 else 0.5, 3)
        trial.set_user_attr("path", f"run/{trial.number}")
        if trial.number == 2:
            raise optuna.TrialPruned
        if trial.number == 3:
            raise ValueError
        return math.inf if trial.number == 4 else trial.number / 3

    study.optimize(objective, n_trials=6, catch=ValueError)
    study.enqueue_trial({"x": 0.4})


def shown_as_optuna_says(shown, study):
    states = {"FAIL": "Failed"}
    assert shown["name"] == study.study_name
    assert len(shown["trials"]) == len(study.trials)
    for ours, theirs in zip(shown["trials"], study.trials):
        assert ours["state"] == states.get(theirs.state.name, theirs.state.name.capitalize())
        assert ours["params"] == theirs.params
        assert [float(value) for value in ours["values"]] == (theirs.values or [])
        reports = {int(step): float(value) for step, value in ours["reports"].items()}
        assert reports == pytest.approx(theirs.intermediate_values, nan_ok=True)
        assert ours["user"] == theirs.user_attrs


def test_every_kind_of_trial_is_read(tmp_path):
    journal, sqlite, copy = tmp_path / "study.log", tmp_path / "study.db", tmp_path / "copy.log"
    for place in (storage(journal, JournalFileOpenLock(str(journal))), f"sqlite:///{sqlite}"):
        everything(optuna.create_study(study_name="all", storage=place, direction="maximize"))
    study = optuna.load_study(study_name="all", storage=storage(journal))
    shown_as_optuna_says(run("show", "--journal", journal)[0], study)
    study = optuna.load_study(study_name="all", storage=f"sqlite:///{sqlite}")
    shown_as_optuna_says(run("show", "--sqlite", sqlite, "--into", copy)[0], study)
    copied = optuna.load_study(study_name="all", storage=storage(copy))
    for ours, theirs in zip(copied.trials, study.trials, strict=True):
        assert (ours.state, ours.params, ours.distributions) == (theirs.state, theirs.params, theirs.distributions)
        assert (ours.values, ours.user_attrs) == (theirs.values, theirs.user_attrs)
        assert ours.intermediate_values == pytest.approx(theirs.intermediate_values, nan_ok=True)


def test_both_write_one_journal_at_a_time(tmp_path):
    path = tmp_path / "study.log"
    optuna.create_study(study_name="both", storage=storage(path))
    script = (
        "import optuna, sys; sys.path.insert(0, sys.argv[1]); import compare_optuna as c;"
        "optuna.load_study(study_name='both', storage=c.storage(sys.argv[2])).optimize(c.branin, n_trials=20)"
    )
    folder = Path(__file__).parent
    optunas = [subprocess.Popen([os.sys.executable, "-c", script, str(folder), str(path)]) for _ in range(2)]
    run("branin", "--trials", 30, "--journal", path, "--name", "both", "--threads", 3)
    assert [process.wait() for process in optunas] == [0, 0]
    trials = optuna.load_study(study_name="both", storage=storage(path)).trials
    assert len(trials) >= 40 and all(trial.state == TrialState.COMPLETE for trial in trials)
    assert len(run("show", "--journal", path)[0]["trials"]) == len(trials)


def test_importance_is_optunas(tmp_path):
    for function in FUNCTIONS:
        path = tmp_path / f"{function}.log"
        (ours,) = run(function, "--trials", 80, "--journal", path, "--name", function)
        study = optuna.load_study(study_name=function, storage=storage(path))
        theirs = optuna.importance.get_param_importances(study)
        assert dict(ours["importance"]) == pytest.approx(theirs, abs=1e-6), function


def baseline():
    cache = os.environ.get("OPENDR_TUNING_BASELINE")
    if cache and Path(cache).exists():
        return json.loads(Path(cache).read_text())
    best = {}
    for name, function in FUNCTIONS.items():
        studies = [optuna.create_study(sampler=optuna.samplers.TPESampler(seed=seed)) for seed in range(SEEDS)]
        for study in studies:
            study.optimize(function, n_trials=TRIALS)
        best[name] = [study.best_value for study in studies]
    if cache:
        Path(cache).write_text(json.dumps(best))
    return best


def test_trials_are_as_good_as_optunas():
    theirs = baseline()
    failures = []
    for name in FUNCTIONS:
        ours = [line["best"] for line in run(name, "--trials", TRIALS, "--seeds", f"0..{SEEDS}")]
        p = mannwhitneyu(ours, theirs[name], alternative="two-sided").pvalue
        quartiles = ["{1:.4f} [{0:.4f}, {2:.4f}]".format(*np.percentile(best, [25, 50, 75])) for best in (ours, theirs[name])]
        print(f"{name:12} ours {quartiles[0]}   Optuna {quartiles[1]}   p = {p:.3f}")
        if p <= 0.05 and np.median(ours) > np.median(theirs[name]):
            failures.append(name)
        if name == "mixed":
            assert np.percentile(ours, 75) <= 0.1, "a quarter of the seeds are locked in a wrong choice"
    assert not failures
