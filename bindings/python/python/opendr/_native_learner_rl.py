"""The base class of the native policies, which are trained in environments."""

from __future__ import annotations

import json
import os
from typing import Any, Optional, Union

from opendr._errors import Unsupported
from opendr._input_value import PathLike
from opendr._native_base import NativeBase
from opendr._older_names import under_older_name
from opendr.engine.learners import LearnerRL


class NativeLearnerRL(NativeBase, LearnerRL):
    """A policy of the registry; ``infer`` returns the action for an observation.

    An environment is given as a name (``"CartPole-v1"``; ``opendr.simulation.environments()`` lists them), an environment
    with Gymnasium's interface, or a function that creates one. The function is necessary where ``n_envs`` is above 1 or
    the evaluation needs an environment of its own.
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
        """Trains the policy, from the loaded model if there is one, and loads the best one by evaluation.

        Ctrl-C saves a checkpoint and raises ``KeyboardInterrupt``; ``resume`` continues from it.

        Args:
            env: Environment of the training; None uses that of the constructor, or of the loaded model's training.
            val_env: Environment of the evaluations during the training; None creates others of ``env``.
            logging_path: Folder for TensorBoard's event files and curves; empty: none.
            silent: Whether to print nothing at all.
            verbose: Whether to print the outcome.
            env_params: Parameters of an environment that is given by name.
            out: Folder for checkpoints, report and, in ``model``, the trained container; by default ``temp_path`` or
                else ``runs/NAME-DATE``.
            resume: Whether to resume from the last checkpoint in ``out``, or in the last run of this learner.
            fit_params: Parameters of the training (docs/learners.md); by default those of the constructor.

        Returns:
            The curves (a list each, e.g. ``"val_return"``) and scalars by name, and under ``"report"`` the whole report.

        Raises:
            ValueError: Environment, policy and parameters do not fit together.
            RuntimeError: The environment raised an exception; the last checkpoint is kept.
        """
        options = self._training(out, logging_path, resume, fit_params)
        training, evaluation = self._environments(env, env_params), None
        if val_env is not None:
            evaluation = self._environments(val_env, env_params)
        report, text = self._handle.fit_in(training, evaluation, json.dumps(options), silent)
        return self._trained(report, text, verbose and not silent)

    def eval(
        self,
        env: Any = None,
        *,
        env_params: Optional[dict[str, Any]] = None,
        episodes: int = 100,
        first_seed: int = 1_000_000,
        verbose: bool = False,
        ray: Union[bool, str] = False,
        ray_options: Optional[dict[str, Any]] = None,
    ) -> dict[str, Any]:
        """Evaluates the policy on episodes with fixed seeds.

        Args:
            env: Environment of the episodes; None uses that of the loaded model's training.
            env_params: Parameters of an environment that is given by name.
            episodes: Number of episodes; episode ``i`` has the seed ``first_seed + i``.
            first_seed: Seed of the first episode.
            verbose: Whether to show progress.
            ray: Whether episodes run on a Ray cluster: True for the connected one or one of this machine, or an address
                (``"auto"`` for the running one). An environment of yours is a function that can be pickled.
            ray_options: Resources of a task on Ray, such as ``{"num_cpus": 2}``; by default one core.

        Returns:
            ``mean_return``, ``std_return``, ``mean_length``, ``episodes``, and, if the environment reports success,
            ``success_rate`` with its 95 % interval, ``success_rate_low`` and ``success_rate_high``; for each other number that
            the environment reports with the last step of an episode, its mean, as ``final_spl``. A policy with a prior or a
            shield also has ``controllers``: the same of prior, policy and both on the same episodes, each with its ``name``
            and, under a shield, the share of ``shielded`` steps.

        Raises:
            FileNotFoundError: No model is loaded.
            ValueError: The environment has other spaces than the policy.
        """
        given = self._environments(env, env_params)
        if ray:
            from opendr import _cluster

            joined, _ = _cluster.evaluate_policy(self, given, episodes, first_seed, ray, ray_options, verbose)
            report = json.loads(joined)
        else:
            report = json.loads(self._handle.eval_in(given, episodes, first_seed, verbose))
        numbers: dict[str, Any] = report["scalars"]
        if "controllers" in report:
            numbers["controllers"] = report["controllers"]
        return numbers

    def _training(
        self, out: Optional[PathLike], logging_path: PathLike, resume: bool, fit_params: dict[str, Any]
    ) -> dict[str, Any]:
        """Returns the options of a training."""
        place = under_older_name(out, "out", fit_params, "output") or self.temp_path or None
        return {
            "params": self._fit_params(fit_params),
            "out": None if place is None else os.fspath(place),
            "logging_path": os.fspath(logging_path) if logging_path else None,
            "resume": resume or self.checkpoint_load_iter > 0,
        }

    def _trained(self, report: str, text: str, is_printed: bool) -> dict[str, Any]:
        """Returns the outcome of a training from its report."""
        vars(self).update(self._handle.params())
        if is_printed:
            print(text, end="")
        outcome = json.loads(report)
        return {**outcome.get("curves", {}), **outcome.get("scalars", {}), "report": outcome}

    def _environments(self, env: Any, params: Optional[dict[str, Any]]) -> Any:
        """Converts an environment to the argument of the native module: a name with parameters, or a function that creates
        bridges."""
        if env is None:
            env = self._handle.trained_in
            if env is None:
                raise ValueError('no environment is given; give one, e.g. env="CartPole-v1"')
        if isinstance(env, str):
            return env, params or {}
        if params:
            raise ValueError("env_params apply only to an environment given by name; pass them to your own environment")
        from opendr.simulation._bridge import Bridge

        if not hasattr(env, "step"):
            return lambda: Bridge(env())
        unused = [env]

        def single() -> Bridge:
            if not unused:
                raise Unsupported(
                    "one environment is given and several are needed; give a function that creates them, "
                    'e.g. env=lambda: gymnasium.make("Hopper-v5")'
                )
            return Bridge(unused.pop())

        return single
