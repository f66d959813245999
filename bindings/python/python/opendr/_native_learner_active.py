"""The base class of the native learners of active perception."""

from __future__ import annotations

import json
from typing import Any, Optional

from opendr._native_learner_rl import NativeLearnerRL


class NativeLearnerActive(NativeLearnerRL):
    """A learner of active perception; ``infer`` returns a category whose ``action`` moves the camera to the next view.

    It trains the recogniser and the camera policy in an environment, as ``fit`` of a policy does.
    """

    def eval(
        self,
        env: Any = None,
        *,
        env_params: Optional[dict[str, Any]] = None,
        episodes: int = 500,
        first_seed: int = 5_000_000,
        verbose: bool = False,
    ) -> dict[str, Any]:
        """Evaluates the camera policy beside baselines on episodes with fixed seeds.

        Args:
            env: Environment of the episodes; None uses that of the loaded model's training.
            env_params: Parameters of an environment that is given by name.
            episodes: Number of episodes; episode ``i`` has the seed ``first_seed + i``.
            first_seed: Seed of the first episode.
            verbose: Whether to show progress.

        Returns:
            For each of ``static``, ``random``, ``orbit``, ``greedy``, ``policy`` and ``oracle`` a dictionary with ``accuracy``
            (value and 95 % interval), ``calibration_error``, ``median_views``, ``mean_views`` and ``episodes``.

        Raises:
            FileNotFoundError: No model is loaded.
            ValueError: The environment has other spaces.
        """
        given = self._environments(env, env_params)
        report = json.loads(self._handle.eval_active(given, episodes, first_seed, verbose))
        return {row.pop("camera_policy"): row for row in report["rows"]}
