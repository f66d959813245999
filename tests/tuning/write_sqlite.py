"""Writes the database that the tests of crates/tuning read, with Optuna 5.0:

    python tests/tuning/write_sqlite.py fuzz/corpus/optuna_sqlite/study.db
"""

import math
import sys

import optuna
from optuna.trial import TrialState

storage = optuna.storages.RDBStorage(f"sqlite:///{sys.argv[1]}")
sampler = optuna.samplers.RandomSampler(seed=1)
study = optuna.create_study(storage=storage, study_name="everything", sampler=sampler)
study.set_user_attr("note", "n" * 20_000)
for number in range(59):
    trial = study.ask()
    x = trial.suggest_float("x", 1e-3, 1.0, log=True)
    trial.suggest_int("whole", 2, 64, step=2)
    trial.suggest_categorical("choice", ["a", None, 2.5, True])
    if number == 1:
        trial.report(math.nan, 0)
        trial.report(-math.inf, 1)
    else:
        trial.report(float(number), 0)
        trial.report(number + 0.5, 1)
    trial.set_user_attr("number", number)
    if number == 58:
        study.tell(trial, state=TrialState.FAIL)
    elif number % 7 == 3:
        study.tell(trial, state=TrialState.PRUNED)
    else:
        study.tell(trial, math.inf if number == 0 else 2 * x)
study.enqueue_trial({"x": 0.5})
two = optuna.create_study(storage=storage, study_name="two", directions=["minimize", "maximize"])
two.tell(two.ask(), [1.0, 2.0])
