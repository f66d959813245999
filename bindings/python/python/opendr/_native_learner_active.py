"""The base class of the native learners of active perception."""

from __future__ import annotations

import json
from typing import Any, Optional, Union

from opendr import _opendr
from opendr._errors import Unsupported
from opendr._input_value import DatasetLike, PathLike
from opendr._native_learner_rl import NativeLearnerRL


class NativeLearnerActive(NativeLearnerRL):
    """A learner of active perception; ``infer`` returns a category whose ``action`` moves the camera to the next view.

    ``fit`` trains the recogniser on a data set or on views of an environment, and the camera policy in the environment. The learner
    moves a rig with ``opendr.active.Active``.
    """

    def fit(
        self,
        env: Any = None,
        val_env: Any = None,
        logging_path: PathLike = "",
        silent: bool = False,
        verbose: bool = True,
        *,
        dataset: Optional[DatasetLike] = None,
        split: Optional[str] = None,
        limit: Optional[int] = None,
        env_params: Optional[dict[str, Any]] = None,
        out: Optional[PathLike] = None,
        resume: bool = False,
        **fit_params: Any,
    ) -> dict[str, Any]:
        """Trains recogniser and camera policy, from the loaded model if there is one, and loads the result.

        Args:
            env: Environment of the camera's motions; None uses that of the constructor, or of the loaded model's training.
            val_env: Not supported: the result is measured in ``env``, on episodes that the training does not use.
            logging_path: Folder for TensorBoard's event files and curves; empty: none.
            silent: Whether to print nothing at all.
            verbose: Whether to print the outcome.
            dataset: Data set that trains the recogniser, instead of views of ``env``: an ``ExternalDataset``, or any
                ``DatasetIterator`` of pairs of image and ``Category``. Class indices are those of the environment.
            split: Split of an ``ExternalDataset`` to train on; by default its training split.
            limit: Maximum number of samples, from the first on.
            env_params: Parameters of an environment that is given by name.
            out: Folder for the report and, in ``model``, the trained container; by default ``temp_path`` or else
                ``runs/NAME-DATE``.
            resume: Not supported: a training takes minutes.
            fit_params: Parameters of the training (docs/learners.md); by default those of the constructor.

        Returns:
            Scalars by name, such as ``"policy_accuracy"``, and under ``"report"`` the whole report.

        Raises:
            ValueError: Data set, environment and parameters do not fit together.
            opendr.Unsupported: An argument is not supported.
            RuntimeError: The environment raised an exception.
        """
        if val_env is not None:
            raise Unsupported("val_env is not supported: camera policies are measured in env, on other episodes; omit it")
        if dataset is None:
            if split is not None or limit is not None:
                raise ValueError("split and limit are for a data set; give one as dataset")
            return super().fit(
                env, None, logging_path, silent, verbose, env_params=env_params, out=out, resume=resume, **fit_params
            )
        options = {**self._training(out, logging_path, resume, fit_params), "split": split, "limit": limit}
        environments = self._environments(env, env_params)
        report, text = _opendr.fit_active(self._handle, dataset, environments, json.dumps(options), silent)
        return self._trained(report, text, verbose and not silent)

    def eval(
        self,
        env: Any = None,
        *,
        env_params: Optional[dict[str, Any]] = None,
        episodes: int = 500,
        first_seed: int = 5_000_000,
        verbose: bool = False,
        ray: Union[bool, str] = False,
        ray_options: Optional[dict[str, Any]] = None,
    ) -> dict[str, Any]:
        """Evaluates the camera policy beside baselines on episodes with fixed seeds.

        Args:
            env: Environment of the episodes; None uses that of the loaded model's training.
            env_params: Parameters of an environment that is given by name.
            episodes: Number of episodes; episode ``i`` has the seed ``first_seed + i``.
            first_seed: Seed of the first episode.
            verbose: Whether to show progress.
            ray: Not supported by camera policies.
            ray_options: Not supported by camera policies.

        Returns:
            For each of ``static``, ``random``, ``orbit``, ``greedy``, ``policy`` and ``oracle`` a dictionary with ``accuracy``
            (value and 95 % interval), ``calibration_error``, ``median_views``, ``mean_views`` and ``episodes``.

        Raises:
            FileNotFoundError: No model is loaded.
            ValueError: The environment has other spaces.
            opendr.Unsupported: ``ray`` is given.
        """
        if ray or ray_options:
            raise Unsupported("camera policies are evaluated on one machine, not on Ray")
        given = self._environments(env, env_params)
        report = json.loads(self._handle.eval_active(given, episodes, first_seed, verbose))
        return {row.pop("camera_policy"): row for row in report["rows"]}
