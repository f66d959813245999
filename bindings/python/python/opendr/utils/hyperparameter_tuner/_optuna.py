"""Adapter for studies of Optuna."""

from __future__ import annotations

from typing import Any, Optional


class OptunaStudy:
    """A study of Optuna with the interface of :class:`AnyStudy`."""

    def __init__(self, study: Any) -> None:
        self._study = study
        self._trials: dict[int, Any] = {}

    def ask(self, hyperparameters: list[dict[str, Any]]) -> tuple[int, dict[str, Any]]:
        trial = self._study.ask()
        self._trials[trial.number] = trial
        return trial.number, {entry["name"]: _suggestion(trial, entry) for entry in hyperparameters}

    def report(self, number: int, step: int, value: float) -> bool:
        trial = self._trials[number]
        trial.report(value, step)
        return bool(trial.should_prune())

    def tell(self, number: int, value: Optional[float] = None, failed: Optional[str] = None) -> None:
        from optuna.trial import TrialState  # type: ignore[import-not-found,unused-ignore]

        trial = self._trials.pop(number)
        if failed is not None:
            trial.set_user_attr("fail_reason", failed)
            self._study.tell(trial, state=TrialState.FAIL)
        elif value is None:
            self._study.tell(trial, state=TrialState.PRUNED)
        else:
            self._study.tell(trial, value)

    def best(self) -> Optional[dict[str, Any]]:
        try:
            best = self._study.best_trial
        except ValueError:
            return None
        return {"number": best.number, "value": best.value, "params": best.params}

    def table(self, rows: int = 10) -> str:
        newest = self._study.trials[-rows:]
        return "\n".join(f"{trial.number}  {trial.state.name}  {trial.values}  {trial.params}" for trial in newest)


def _suggestion(trial: Any, entry: dict[str, Any]) -> Any:
    """Returns the trial's suggestion for OpenDR's dictionary; the three older types are floats."""
    kind = entry["type"].lower()
    options = {key: value for key, value in entry.items() if key not in ("type", "name", "q")}
    if kind == "categorical":
        return trial.suggest_categorical(entry["name"], entry["choices"])
    if kind == "int":
        return trial.suggest_int(entry["name"], **options)
    if kind == "discrete_uniform":
        options["step"] = entry["q"]
    elif kind == "loguniform":
        options["log"] = True
    return trial.suggest_float(entry["name"], **options)
