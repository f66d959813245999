"""OpenDR's HyperparameterTuner."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable
from typing import Any, Optional, Union

from opendr import InvalidParam
from opendr.engine.learners import LearnerRL
from opendr.utils.hyperparameter_tuner._optuna import OptunaStudy
from opendr.utils.hyperparameter_tuner._ray import RayTrials
from opendr.utils.hyperparameter_tuner._threads import ThreadTrials
from opendr.utils.hyperparameter_tuner.study import AnyStudy, Study
from opendr.utils.hyperparameter_tuner.trial import Job, takes_seed

#: Number of consecutive failed trials that ends the tuning, since the parameters are then not the cause.
_MAX_FAILURES = 3


class HyperparameterTuner:
    """Searches the arguments of a learner's constructor that optimise the result of ``eval``.

    Args:
        learner_class: The class of the learner.
        study: A :class:`Study` or a study of Optuna; by default a new one in memory that minimises.
    """

    def __init__(self, learner_class: type[Any], study: Optional[Any] = None) -> None:
        if not isinstance(learner_class, type):
            raise InvalidParam(f"learner_class is {learner_class!r}: give the class of a learner, not a learner")
        self._learner_class = learner_class
        self._study = Study() if study is None else study
        self._adapter: AnyStudy = self._study if hasattr(self._study, "table") else OptunaStudy(self._study)

    @property
    def study(self) -> Any:
        """The study."""
        return self._study

    def optimize(
        self,
        hyperparameters: Optional[list[dict[str, Any]]] = None,
        init_arguments: Optional[dict[str, Any]] = None,
        fit_arguments: Optional[dict[str, Any]] = None,
        eval_arguments: Optional[dict[str, Any]] = None,
        objective_function: Optional[Callable[[Any], float]] = None,
        n_trials: Optional[int] = None,
        timeout: Optional[float] = None,
        n_jobs: Optional[int] = 1,
        show_progress_bar: Optional[bool] = False,
        verbose: Optional[bool] = False,
        *,
        n_seeds: Optional[int] = None,
        ray: Union[bool, str] = False,
        ray_options: Optional[dict[str, Any]] = None,
    ) -> dict[str, Any]:
        """Runs trials and returns ``init_arguments`` updated with the best parameters, for the constructor.

        If ``fit`` of the learner has an argument ``report``, it receives a function ``report(step, results)`` to call after
        each evaluation during the training; the study's pruner may end the training there, by raising
        :class:`TrialPruned`. A training is never interrupted otherwise.

        Args:
            hyperparameters: One dictionary per hyperparameter: ``name`` (an argument of the constructor), ``type`` and its
                settings: ``categorical`` (choices), ``float`` (low, high, step, log), ``int`` (low, high, step, log),
                ``discrete_uniform`` (low, high, q), ``loguniform`` and ``uniform`` (low, high). By default the learner's
                ``get_hyperparameters()``.
            init_arguments: Other arguments of the constructor.
            fit_arguments: Arguments of ``fit``.
            eval_arguments: Arguments of ``eval``.
            objective_function: Function from the result of ``eval`` to the number that the study minimises or maximises. By
                default the learner's ``get_objective_function()``.
            n_trials: Number of trials; without it, and without a timeout, trials run until Ctrl-C.
            timeout: Seconds after which no trial is started.
            n_jobs: Number of trials that run at a time; -1 for the number of CPUs of the machine or the cluster.
            show_progress_bar: Whether to show the progress in a line on the terminal.
            verbose: Whether to print the table of trials after each trial.
            n_seeds: Number of seeds with which each configuration is trained; its value is the mean. By default 3 for
                learners of reinforcement learning that have a ``seed``, else 1, with the learner's own seed.
            ray: Whether trials run on Ray: True for a cluster on this machine (or the connected one), or the address of a
                cluster.
            ray_options: Resources of a trial on Ray, such as ``{"num_cpus": 2, "num_gpus": 0.5}``.

        Raises:
            ValueError: An argument is missing or invalid, or no trial is complete.
            Exception: The exception of a learner, after three failed trials in a row. The study keeps all trials.
        """
        hyperparameters = hyperparameters or self._learner_class.get_hyperparameters()
        objective_function = objective_function or self._learner_class.get_objective_function()
        if not hyperparameters or objective_function is None:
            name = self._learner_class.__name__
            raise InvalidParam(f"{name} defines no hyperparameters or objective; give hyperparameters and objective_function")
        job = Job(
            self._learner_class,
            objective_function,
            dict(init_arguments or {}),
            dict(fit_arguments or {}),
            dict(eval_arguments or {}),
            self._seeds(n_seeds),
        )
        trials: Union[RayTrials, ThreadTrials]
        if ray:
            trials = RayTrials(job, n_jobs or 1, ray, ray_options)
        else:
            trials = ThreadTrials(job, n_jobs or 1, self._adapter.report)
        end = None if timeout is None else time.monotonic() + timeout
        try:
            self._run(trials, hyperparameters, n_trials, end, bool(show_progress_bar), bool(verbose))
        finally:
            for number in trials.close():
                self._adapter.tell(number, failed="the tuning was interrupted")
        best = self._adapter.best()
        if best is None:
            raise InvalidParam("no trial is complete; allow more trials or time")
        return {**(init_arguments or {}), **best["params"]}

    def _seeds(self, count: Optional[int]) -> tuple[int, ...]:
        able = takes_seed(self._learner_class)
        if count is None:
            count = 3 if able and issubclass(self._learner_class, LearnerRL) else 0
        elif count > 0 and not able:
            raise InvalidParam(f"{self._learner_class.__name__} has no argument seed; omit n_seeds")
        return tuple(range(count))

    def _run(
        self,
        trials: Union[RayTrials, ThreadTrials],
        hyperparameters: list[dict[str, Any]],
        n_trials: Optional[int],
        end: Optional[float],
        bar: bool,
        verbose: bool,
    ) -> None:
        started = done = failed = 0
        while True:
            while (n_trials is None or started < n_trials) and started - done < trials.slots and not _is_over(end):
                trials.begin(*self._adapter.ask(hyperparameters))
                started += 1
                if trials.slots == 1:
                    break
            if started == done:
                return
            # Reports first: trials that have ended may have reported, too.
            ended = list(trials.ended())
            for number, step, value in trials.reports():
                if self._adapter.report(number, step, value):
                    trials.stop(number)
            for number, outcome, error in ended:
                done += 1
                failed = 0 if error is None else failed + 1
                reason = None if error is None else f"{type(error).__name__}: {error}"
                self._adapter.tell(number, outcome, reason)
                self._show(done, n_trials, bar, verbose)
                if error is not None and failed >= _MAX_FAILURES:
                    raise error

    def _show(self, done: int, n_trials: Optional[int], bar: bool, verbose: bool) -> None:
        if verbose:
            print(self._adapter.table())
        if bar:
            best = self._adapter.best()
            value = "none yet" if best is None else f"{best['value']:.6g}"
            of = "" if n_trials is None else f" of {n_trials}"
            print(f"\r{done}{of} trials, best {value}", end="", file=sys.stderr, flush=True)


def _is_over(end: Optional[float]) -> bool:
    return end is not None and time.monotonic() >= end
