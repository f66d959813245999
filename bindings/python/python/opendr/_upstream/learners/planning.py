"""Planning policies."""

from __future__ import annotations

from typing import Any

from opendr._input_value import PathLike
from opendr._native_learner_rl import NativeLearnerRL
from opendr._upstream.arguments import by_name


class Planner(NativeLearnerRL):
    """A policy whose constructor has an argument for the environment."""

    def __init__(self, *given: Any, **named: Any) -> None:
        found = by_name(type(self).__name__, self._positional, given, named, stacklevel=3)
        #: The environment of ``fit`` and ``eval`` unless another is given.
        self.env: Any = found.pop("env", None)
        super().__init__(**found)

    def fit(
        self,
        env: Any = None,
        val_env: Any = None,
        logging_path: PathLike = "",
        silent: bool = False,
        verbose: bool = True,
        **options: Any,
    ) -> dict[str, Any]:
        """Trains as ``fit`` of every policy, by default in the environment of the constructor."""
        return super().fit(self.env if env is None else env, val_env, logging_path, silent, verbose, **options)

    def eval(self, env: Any = None, **options: Any) -> dict[str, Any]:
        """Evaluates as ``eval`` of every policy, by default in the environment of the constructor."""
        return super().eval(self.env if env is None else env, **options)
