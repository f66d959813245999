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

#: So many trials that fail in a row end the tuning: the fault is then not that of the parameters.
_MOST_FAILURES = 3


class HyperparameterTuner:
    """Searches the arguments of a learner's constructor with which ``eval`` comes out best.

    Args:
        learner_class: The class of the learner.
        study: Where to search: a :class:`Study` or a study of Optuna's. A new one in memory, that minimises, without.
    """

    def __init__(self, learner_class: type[Any], study: Optional[Any] = None) -> None:
        if not isinstance(learner_class, type):
            raise InvalidParam(f"learner_class is {learner_class!r}: give the class of a learner, not a learner")
        self._learner_class = learner_class
        self._study = Study() if study is None else study
        self._asked: AnyStudy = self._study if hasattr(self._study, "table") else OptunaStudy(self._study)

    @property
    def study(self) -> Any:
        """The study, as it was given."""
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
        """Carries out trials; the best parameters over ``init_arguments``, as the constructor takes them.

        A learner whose ``fit`` has an argument ``report`` is given a function ``report(step, results)``, to call where
        it evaluates itself: the study's pruner may then end the training there, by raising :class:`TrialPruned`. No
        training is ever cut into pieces for the tuner's sake.

        Args:
            hyperparameters: A dictionary each: ``name`` (of an argument of the constructor), ``type`` and what goes
                with it: ``categorical`` (choices), ``float`` (low, high, step, log), ``int`` (low, high, step, log),
                ``discrete_uniform`` (low, high, q), ``loguniform`` and ``uniform`` (low, high). The learner's
                ``get_hyperparameters()`` without.
            init_arguments: Other arguments of the constructor.
            fit_arguments: Arguments of ``fit``.
            eval_arguments: Arguments of ``eval``.
            objective_function: From what ``eval`` returns to a number, which the study minimises or maximises. The
                learner's ``get_objective_function()`` without.
            n_trials: So many trials are carried out; without, and without a timeout, until Ctrl-C.
            timeout: Seconds after which no trial is begun.
            n_jobs: So many trials at a time; -1 for as many as there are processors, here or on the
                cluster.
            show_progress_bar: Whether a line on the terminal says how far it is.
            verbose: Whether the table of trials is printed after each.
            n_seeds: With so many seeds each configuration is trained; its value is the mean. By default 3 for learners
                of reinforcement learning that take a ``seed``, else 1, with the learner's own.
            ray: Whether trials run on Ray: True for a cluster of this machine (or the one that is connected already),
                or the address of one.
            ray_options: What a trial takes there, such as ``{"num_cpus": 2, "num_gpus": 0.5}``.

        Raises:
            ValueError: An argument is missing or wrong; no trial came to its end.
            Exception: What a learner raised, when three trials in a row failed. The study keeps them all.
        """
        hyperparameters = hyperparameters or self._learner_class.get_hyperparameters()
        objective_function = objective_function or self._learner_class.get_objective_function()
        if not hyperparameters or objective_function is None:
            name = self._learner_class.__name__
            raise InvalidParam(f"{name} does not say what to tune: give hyperparameters and objective_function")
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
            trials = ThreadTrials(job, n_jobs or 1, self._asked.report)
        end = None if timeout is None else time.monotonic() + timeout
        try:
            self._carry_out(trials, hyperparameters, n_trials, end, bool(show_progress_bar), bool(verbose))
        finally:
            for number in trials.close():
                self._asked.tell(number, failed="the tuning was interrupted")
        best = self._asked.best()
        if best is None:
            raise InvalidParam("no trial came to its end: allow more trials or time")
        return {**(init_arguments or {}), **best["params"]}

    def _seeds(self, count: Optional[int]) -> tuple[int, ...]:
        able = takes_seed(self._learner_class)
        if count is None:
            count = 3 if able and issubclass(self._learner_class, LearnerRL) else 0
        elif count > 0 and not able:
            raise InvalidParam(f"{self._learner_class.__name__} takes no seed: leave n_seeds out")
        return tuple(range(count))

    def _carry_out(
        self,
        trials: Union[RayTrials, ThreadTrials],
        hyperparameters: list[dict[str, Any]],
        n_trials: Optional[int],
        end: Optional[float],
        bar: bool,
        verbose: bool,
    ) -> None:
        begun = done = failed = 0
        while True:
            while (n_trials is None or begun < n_trials) and begun - done < trials.slots and not _is_over(end):
                trials.begin(*self._asked.ask(hyperparameters))
                begun += 1
                if trials.slots == 1:
                    break
            if begun == done:
                return
            # Before what has ended is told: those, too, have reported.
            ended = list(trials.ended())
            for number, step, value in trials.reports():
                if self._asked.report(number, step, value):
                    trials.stop(number)
            for number, outcome, error in ended:
                done += 1
                failed = 0 if error is None else failed + 1
                reason = None if error is None else f"{type(error).__name__}: {error}"
                self._asked.tell(number, outcome, reason)
                self._show(done, n_trials, bar, verbose)
                if error is not None and failed >= _MOST_FAILURES:
                    raise error

    def _show(self, done: int, n_trials: Optional[int], bar: bool, verbose: bool) -> None:
        if verbose:
            print(self._asked.table())
        if bar:
            best = self._asked.best()
            value = "none yet" if best is None else f"{best['value']:.6g}"
            of = "" if n_trials is None else f" of {n_trials}"
            print(f"\r{done}{of} trials, best {value}", end="", file=sys.stderr, flush=True)


def _is_over(end: Optional[float]) -> bool:
    return end is not None and time.monotonic() >= end
