"""The class that all compiled policies come from: they learn by acting in environments."""

from __future__ import annotations

import json
import os
from typing import Any, Optional

from opendr._errors import Unsupported
from opendr._native_learner import NativeBase, PathLike
from opendr._older_names import under_older_name
from opendr.engine.learners import LearnerRL


class NativeLearnerRL(NativeBase, LearnerRL):
    """A policy of the registry; ``infer`` takes an observation and gives the action.

    An environment is a name (``"CartPole-v1"``, ``opendr.simulation.environments()`` has them), an environment with
    Gymnasium's interface, or a function that makes such ones: several are wanted where ``n_envs`` is above 1, and another
    one to measure in.
    """

    def fit(
        self,
        env: Any = None,
        val_env: Any = None,
        logging_path: PathLike = "",
        silent: bool = False,
        verbose: bool = True,
        *,
        env_params: Optional[dict[str, Any]] = None,
        out: Optional[PathLike] = None,
        resume: bool = False,
        **fit_params: Any,
    ) -> dict[str, Any]:
        """Trains the policy, from the loaded model where there is one, and loads the best that was measured.

        Ctrl-C saves what was done and raises ``KeyboardInterrupt``; ``resume`` goes on from there.

        Args:
            env: Where to act; None takes what the constructor was given, or the loaded model was trained in.
            val_env: Where to measure on the way; None takes others of ``env``.
            logging_path: Folder of TensorBoard's event files and of curves; empty: none.
            silent: Whether to show nothing at all.
            verbose: Whether to print the outcome.
            env_params: Parameters of an environment that is named.
            out: Folder of checkpoints, report and, in ``model``, the trained container; by default ``temp_path`` or
                else ``runs/NAME-DATE``.
            resume: Whether to go on from the last checkpoint in ``out``, or in the last run of this learner.
            fit_params: Parameters of the training (docs/learners.md); by default those the constructor was given.

        Returns:
            The curves (a list each, e.g. ``"val_return"``) and numbers by name, and under ``"report"`` all there is.

        Raises:
            ValueError: Environment, policy and parameters do not fit together.
            RuntimeError: The environment raised; what was learnt up to the last checkpoint is kept.
        """
        place = under_older_name(out, "out", fit_params, "output") or self.temp_path or None
        options = {
            "params": self._fit_params(fit_params),
            "out": None if place is None else os.fspath(place),
            "logging_path": os.fspath(logging_path) if logging_path else None,
            "resume": resume or self.checkpoint_load_iter > 0,
        }
        acting, measuring = self._environments(env, env_params), None
        if val_env is not None:
            measuring = self._environments(val_env, env_params)
        report, text = self._handle.fit_in(acting, measuring, json.dumps(options), silent)
        vars(self).update(self._handle.params())
        if verbose and not silent:
            print(text, end="")
        outcome = json.loads(report)
        return {**outcome.get("curves", {}), **outcome.get("scalars", {}), "report": outcome}

    def eval(
        self,
        env: Any = None,
        *,
        env_params: Optional[dict[str, Any]] = None,
        episodes: int = 100,
        first_seed: int = 1_000_000,
        verbose: bool = False,
    ) -> dict[str, Any]:
        """Measures the policy on episodes that are always the same.

        Args:
            env: Where to act; None takes what the loaded model was trained in.
            env_params: Parameters of an environment that is named.
            episodes: How many; episode ``i`` begins with the seed ``first_seed + i``.
            first_seed: The seed of the first.
            verbose: Whether to show progress.

        Returns:
            ``mean_return``, ``std_return``, ``mean_length``, ``episodes``, and where the environment tells it
            ``success_rate`` with its 95 % interval, ``success_rate_low`` and ``success_rate_high``.

        Raises:
            FileNotFoundError: Nothing is loaded.
            ValueError: The environment is one of other spaces.
        """
        given = self._environments(env, env_params)
        numbers: dict[str, Any] = json.loads(self._handle.eval_in(given, episodes, first_seed, verbose))
        return numbers

    def _environments(self, env: Any, params: Optional[dict[str, Any]]) -> Any:
        """An environment as the native half takes it: a name with parameters, or a function that makes bridges."""
        if env is None:
            env = self._handle.trained_in
            if env is None:
                raise ValueError('no environment; give one, e.g. env="CartPole-v1"')
        if isinstance(env, str):
            return env, params or {}
        if params:
            raise ValueError("env_params are for an environment that is named; give them to yours")
        from opendr.simulation._bridge import Bridge

        if not hasattr(env, "step"):
            return lambda: Bridge(env())
        left = [env]

        def only_one() -> Bridge:
            if not left:
                raise Unsupported(
                    "one environment was given and several are wanted; give a function that makes them, "
                    'e.g. env=lambda: gymnasium.make("Hopper-v5")'
                )
            return Bridge(left.pop())

        return only_one
