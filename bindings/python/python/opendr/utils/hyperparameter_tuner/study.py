"""Studies: the trials of a hyperparameter search."""

from __future__ import annotations

import json
import os
from typing import Any, Optional, Protocol, Union

from opendr import InvalidParam, _opendr


class AnyStudy(Protocol):
    """The interface of studies that the tuner uses."""

    def ask(self, hyperparameters: list[dict[str, Any]]) -> tuple[int, dict[str, Any]]:
        """Suggests the next trial. Returns its number and its parameters."""
        ...

    def report(self, number: int, step: int, value: float) -> bool:
        """Reports an intermediate value of a trial. Returns whether it is to stop."""
        ...

    def tell(self, number: int, value: Optional[float] = None, failed: Optional[str] = None) -> None:
        """Finishes a trial: with its value, as pruned without one, or as failed with the reason."""
        ...

    def best(self) -> Optional[dict[str, Any]]:
        """Returns the best complete trial: ``number``, ``value`` and ``params``."""
        ...

    def table(self, rows: int = 10) -> str:
        """Returns a table of the newest trials, for the terminal."""
        ...


class Study:
    """A hyperparameter search, in memory or in a journal file that Optuna reads and can continue.

    Args:
        name: Name of the study, unique in its file.
        direction: ``"minimize"`` or ``"maximize"`` the objective.
        storage: Path of the file, in Optuna's journal format. Several processes may share it, and any may be killed; an
            existing study is continued.
        sampler: ``"tpe"``, ``"random"``, ``"quasi_random"`` or ``"cma_es"``.
        seed: Seed of the sampler.
        pruner: None, ``"median"``, or a dictionary: ``{"name": "median", "startup_trials", "warmup_steps"}``,
            ``{"name": "asha", "first", "factor"}`` or ``{"name": "hyperband", "first", "last", "factor"}``.

    Raises:
        ValueError: An argument has another value, or the study in the file has another direction.
        OSError: The file cannot be read or written.
    """

    def __init__(
        self,
        name: str = "study",
        direction: str = "minimize",
        storage: Optional[Union[str, os.PathLike[str]]] = None,
        sampler: str = "tpe",
        seed: int = 0,
        pruner: Optional[Union[str, dict[str, Any]]] = None,
    ) -> None:
        if direction not in ("minimize", "maximize"):
            raise InvalidParam(f'unknown direction {direction!r}; give "minimize" or "maximize"')
        if isinstance(pruner, str):
            pruner = {"name": pruner}
        if pruner is not None and pruner.get("name") == "median":
            pruner = {"startup_trials": 5, "warmup_steps": 0, **pruner}
        options = {
            "maximize": direction == "maximize",
            "storage": None if storage is None else os.fspath(storage),
            "sampler": sampler,
            "seed": seed,
            "pruner": pruner,
        }
        self._study = _opendr.Study(name, json.dumps(options))
        self.name = name
        self.direction = direction

    def ask(self, hyperparameters: list[dict[str, Any]]) -> tuple[int, dict[str, Any]]:
        """Suggests the next trial. Returns its number and its parameters.

        Args:
            hyperparameters: OpenDR's dictionaries, those of ``HyperparameterTuner.optimize``.

        Raises:
            ValueError: A dictionary is invalid, or does not match the search space of earlier trials.
        """
        try:
            text = json.dumps(hyperparameters, allow_nan=False)
        except (TypeError, ValueError) as error:
            raise InvalidParam(f"hyperparameters must be numbers, str, bool, None and lists of these: {error}") from error
        number, params = self._study.ask(text)
        return number, json.loads(params)

    def enqueue(self, params: dict[str, Any]) -> None:
        """Enqueues these parameters for the next trial; the sampler suggests missing ones."""
        self._study.enqueue(json.dumps(params))

    def report(self, number: int, step: int, value: float) -> bool:
        """Reports an intermediate value of a trial. Returns whether it is to stop.

        Learners of Python cannot be paused: a trial that the pruner pauses is stopped.
        """
        return self._study.report(number, step, value) != "continue"

    def note(self, number: int, key: str, value: Any) -> None:
        """Sets a user attribute of a running trial; the value must be serialisable as JSON."""
        self._study.note(number, key, json.dumps(value))

    def tell(self, number: int, value: Optional[float] = None, failed: Optional[str] = None) -> None:
        """Finishes a trial: with its value, as pruned without one, or as failed with the reason."""
        self._study.tell(number, value, failed)

    def refresh(self) -> None:
        """Reads the entries that other processes have written."""
        self._study.refresh()

    def trials(self) -> list[dict[str, Any]]:
        """Returns all trials: ``number``, ``state``, ``params``, ``value``, ``reports``, ``notes``, ``fail_reason``."""
        trials: list[dict[str, Any]] = json.loads(self._study.trials())
        return trials

    def best(self) -> Optional[dict[str, Any]]:
        """Returns the best complete trial."""
        best = self._study.best()
        return None if best is None else json.loads(best)

    def table(self, rows: int = 10) -> str:
        """Returns the number of trials, the best and the newest ones as a table for the terminal."""
        return self._study.table(rows)

    def importance(self) -> dict[str, float]:
        """Returns the importance of each parameter (PED-ANOVA), the most important first."""
        return dict(self._study.importance())
