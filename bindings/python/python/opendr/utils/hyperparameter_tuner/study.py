"""A study: which parameters come next, and what came of those before."""

from __future__ import annotations

import json
import os
from typing import Any, Optional, Protocol, Union

from opendr import InvalidParam, _opendr


class AnyStudy(Protocol):
    """What the tuner asks of a study."""

    def ask(self, hyperparameters: list[dict[str, Any]]) -> tuple[int, dict[str, Any]]:
        """The next trial: its number and its parameters."""
        ...

    def report(self, number: int, step: int, value: float) -> bool:
        """Notes what a trial measured; whether it is to stop."""
        ...

    def tell(self, number: int, value: Optional[float] = None, failed: Optional[str] = None) -> None:
        """Ends a trial: with its value, without one as pruned, or with the reason why it failed."""
        ...

    def best(self) -> Optional[dict[str, Any]]:
        """The best complete trial: ``number``, ``value`` and ``params``."""
        ...

    def table(self, rows: int = 10) -> str:
        """The newest trials, for the terminal."""
        ...


class Study:
    """A search, in memory or in a file that Optuna reads and goes on with.

    Args:
        name: Its name; no other study of the file has it.
        direction: ``"minimize"`` or ``"maximize"`` the objective.
        storage: The file, Optuna's journal. Several processes may work on it at a time, and any may be killed; a study
            that is in it goes on.
        sampler: ``"tpe"``, ``"random"``, ``"quasi_random"`` or ``"cma_es"``.
        seed: What fixes everything random.
        pruner: None, ``"median"``, or a dictionary: ``{"name": "median", "startup_trials", "warmup_steps"}``,
            ``{"name": "asha", "first", "factor"}`` or ``{"name": "hyperband", "first", "last", "factor"}``.

    Raises:
        ValueError: A word is none of these, or the study in the file has another direction.
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
            raise InvalidParam(f'direction {direction!r}: give "minimize" or "maximize"')
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
        """The next trial: its number and its parameters.

        Args:
            hyperparameters: OpenDR's dictionaries, as of ``HyperparameterTuner.optimize``.

        Raises:
            ValueError: A dictionary is wrong, or does not fit what earlier trials had.
        """
        try:
            text = json.dumps(hyperparameters, allow_nan=False)
        except (TypeError, ValueError) as error:
            raise InvalidParam(f"hyperparameters hold numbers, text, bool, None and lists of them: {error}") from error
        number, params = self._study.ask(text)
        return number, json.loads(params)

    def enqueue(self, params: dict[str, Any]) -> None:
        """Has these parameters tried next; those that are missing are chosen."""
        self._study.enqueue(json.dumps(params))

    def report(self, number: int, step: int, value: float) -> bool:
        """Notes what a trial measured; whether it is to stop.

        Learners of Python cannot be paused: what could go on later is stopped.
        """
        return self._study.report(number, step, value) != "continue"

    def note(self, number: int, key: str, value: Any) -> None:
        """Notes something that JSON has about a running trial."""
        self._study.note(number, key, json.dumps(value))

    def tell(self, number: int, value: Optional[float] = None, failed: Optional[str] = None) -> None:
        """Ends a trial: with its value, without one as pruned, or with the reason why it failed."""
        self._study.tell(number, value, failed)

    def refresh(self) -> None:
        """Reads what other processes have written."""
        self._study.refresh()

    def trials(self) -> list[dict[str, Any]]:
        """All trials: ``number``, ``state``, ``params``, ``value``, ``reports``, ``notes``, ``fail_reason``."""
        trials: list[dict[str, Any]] = json.loads(self._study.trials())
        return trials

    def best(self) -> Optional[dict[str, Any]]:
        """The best complete trial."""
        best = self._study.best()
        return None if best is None else json.loads(best)

    def table(self, rows: int = 10) -> str:
        """How many trials there are, the best, and the newest, for the terminal."""
        return self._study.table(rows)

    def importance(self) -> dict[str, float]:
        """How much each parameter had to do with good values (PED-ANOVA), the most important first."""
        return dict(self._study.importance())
