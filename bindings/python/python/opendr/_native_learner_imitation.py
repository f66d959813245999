"""The base class of the native policies that learn from demonstrations."""

from __future__ import annotations

import json
from typing import Any, Optional

from opendr._input_value import PathLike
from opendr._native_learner_rl import NativeLearnerRL
from opendr.engine.datasets import Dataset


class NativeLearnerImitation(NativeLearnerRL):
    """A policy that imitates demonstrations: of a controller in an environment, or of a data set of LeRobot."""

    def fit(
        self,
        env: Any = None,
        val_env: Any = None,
        logging_path: PathLike = "",
        silent: bool = False,
        verbose: bool = True,
        *,
        dataset: Optional[Dataset] = None,
        val_dataset: Optional[Dataset] = None,
        env_params: Optional[dict[str, Any]] = None,
        out: Optional[PathLike] = None,
        resume: bool = False,
        **fit_params: Any,
    ) -> dict[str, Any]:
        """Trains the policy, from the loaded model if there is one, and loads the result.

        Ctrl-C saves a checkpoint and raises ``KeyboardInterrupt``; ``resume`` continues from it.

        Args:
            env: Environment in which the controller ``demonstration_prior`` demonstrates; omit it for a data set.
            val_env: Environment of the evaluation after the training; None creates another of ``env``.
            logging_path: Folder for TensorBoard's event files and curves; empty: none.
            silent: Whether to print nothing at all.
            verbose: Whether to print the outcome.
            dataset: Demonstrations: ``ExternalDataset(folder, "lerobot")``.
            val_dataset: Demonstrations on which the error of the predicted actions is measured after the training.
            env_params: Parameters of an environment that is given by name.
            out: Folder for checkpoints, report and, in ``model``, the trained container; by default ``temp_path`` or
                else ``runs/NAME-DATE``.
            resume: Whether to resume from the last checkpoint in ``out``, or in the last run of this learner.
            fit_params: Parameters of the training (docs/learners.md); by default those of the constructor.

        Returns:
            The curves (a list each, e.g. ``"loss"``) and scalars by name, and under ``"report"`` the whole report.

        Raises:
            ValueError: Environment, data set and parameters do not fit together.
            RuntimeError: The environment raised an exception; the last checkpoint is kept.
        """
        if dataset is None:
            if val_dataset is not None:
                raise ValueError("val_dataset belongs to a data set; give one as dataset, or val_env for env")
            return super().fit(
                env, val_env, logging_path, silent, verbose, env_params=env_params, out=out, resume=resume, **fit_params
            )
        if env is not None or val_env is not None:
            raise ValueError("env and dataset are two sources of demonstrations; give one of them")
        options = self._training(out, logging_path, resume, fit_params)
        report, text = self._handle.fit(dataset, val_dataset, None, json.dumps(options), silent)
        return self._trained(report, text, verbose and not silent)
