"""Trials: the creation, training and evaluation of a learner."""

from __future__ import annotations

import inspect
import math
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any, Optional

from opendr import InvalidInput


class TrialPruned(Exception):
    """Raised by ``report`` within ``fit`` when the pruner stops the trial."""


@dataclass(frozen=True)
class Job:
    """The common arguments of all trials of a tuning; it can be pickled for other processes."""

    learner_class: Any
    objective_function: Callable[[Any], float]
    init_arguments: dict[str, Any] = field(default_factory=dict)
    fit_arguments: dict[str, Any] = field(default_factory=dict)
    eval_arguments: dict[str, Any] = field(default_factory=dict)
    seeds: tuple[int, ...] = ()

    def run(self, params: dict[str, Any], report: Callable[[int, float], bool]) -> Optional[float]:
        """Returns the value of these parameters, the mean over the seeds; None when the trial is pruned."""
        values: list[float] = []
        for number, seed in enumerate(self.seeds or (None,), 1):
            try:
                # Only the training with the first seed reports; then the running mean over the seeds is reported.
                values.append(self._train(params, seed, report if number == 1 else None))
            except TrialPruned:
                return None
            mean = sum(values) / len(values)
            if len(self.seeds) > number and not self._reports and report(number, mean):
                return None
        return sum(values) / len(values)

    @property
    def _reports(self) -> bool:
        """Whether the learner reports intermediate values during the training."""
        return _takes(self.learner_class.fit, "report")

    def _train(
        self, params: dict[str, Any], seed: Optional[int], report: Optional[Callable[[int, float], bool]]
    ) -> float:
        init, fit = {**self.init_arguments, **params}, dict(self.fit_arguments)
        if seed is not None:
            (init if _takes(self.learner_class, "seed") else fit)["seed"] = seed

        def report_results(step: int, results: Any) -> None:
            if report is not None and report(int(step), self._value(results)):
                raise TrialPruned

        if self._reports:
            fit["report"] = report_results
        learner = self.learner_class(**init)
        learner.fit(**fit)
        return self._value(learner.eval(**self.eval_arguments))

    def _value(self, results: Any) -> float:
        value = float(self.objective_function(results))
        if math.isnan(value):
            raise InvalidInput(f"the objective is not a number for {results!r}")
        return value


def takes_seed(learner_class: type) -> bool:
    """Returns whether a learner's training has a seed."""
    return _takes(learner_class, "seed") or _takes(getattr(learner_class, "fit", None), "seed")


def _takes(function: Any, name: str) -> bool:
    """Returns whether a function has an argument of this name, apart from ``**`` arguments."""
    try:
        return name in inspect.signature(function).parameters
    except (TypeError, ValueError):
        return False
