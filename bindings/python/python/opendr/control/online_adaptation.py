"""Online fine-tuning: a policy goes on learning while it controls.

    from opendr.control.online_adaptation import OnlineAdapter
    from opendr.control.reinforcement_learning import Td3Learner

    learner = Td3Learner()
    learner.load_pretrained("quad_track")
    adapter = OnlineAdapter(learner, env="QuadTrack-v1")
    action = adapter.act(observation)             # at every control step
    adapter.save("adapted", adapted_on="flight of today")
"""

from __future__ import annotations

import json
import os
from typing import Any, Optional

import numpy as np
from numpy.typing import ArrayLike, NDArray

from opendr import _opendr
from opendr._input_value import PathLike
from opendr._native_learner_rl import NativeLearnerRL

__all__ = ["OnlineAdapter"]


class OnlineAdapter:
    """A loaded policy that is adapted while it controls, within limits that are checked at every step.

    Args:
        learner: A loaded policy whose actions are numbers.
        env: Environment of its training, by name, as an object with Gymnasium's interface or as a function that creates one; it
            must state a tracking task. None uses that of the model's training. The frozen policy is calibrated in it.
        params: Parameters of the adaptation (docs/online_adaptation.md).

    Raises:
        FileNotFoundError: No model is loaded.
        NotImplementedError: The policy or the environment cannot be adapted; the message says why.
        ValueError: A parameter is unknown or out of range.
    """

    def __init__(self, learner: NativeLearnerRL, env: Any = None, **params: Any) -> None:
        self._learner = learner
        self._adapter = _opendr.OnlineAdapter(learner._handle, learner._environments(env, None), params)

    def act(self, observation: ArrayLike) -> NDArray[np.float32]:
        """Returns the action for an observation, and learns from it."""
        return np.asarray(self._adapter.act(np.asarray(observation, np.float32).ravel().tolist()), np.float32)

    def reset(self) -> None:
        """Begins another episode; what was learned stays."""
        self._adapter.reset()

    def restore_base(self) -> None:
        """Forgets what was learned."""
        self._adapter.restore_base()

    def rearm(self) -> None:
        """Switches learning on again after repeated rollbacks."""
        self._adapter.rearm()

    @property
    def steps(self) -> tuple[int, int]:
        """Steps so far, and in how many of them the weights learned."""
        return self._adapter.steps

    @property
    def distance(self) -> float:
        """Norm of the learned weights: about by how much commands were changed."""
        return self._adapter.distance

    @property
    def is_disarmed(self) -> bool:
        """Whether learning was switched off after repeated rollbacks."""
        return self._adapter.is_disarmed

    @property
    def events(self) -> list[dict[str, Any]]:
        """What happened: freezes, rollbacks, snapshots, each with its step."""
        events: list[dict[str, Any]] = json.loads(self._adapter.log())["events"]
        return events

    def save(self, path: PathLike, adapted_on: str) -> None:
        """Saves the adapted policy as a new model with its lineage. Nothing is replaced.

        Args:
            path: Folder of the new model.
            adapted_on: What it was adapted on: an environment, a robot, a recording.
        """
        self._adapter.save(os.fspath(path), adapted_on)

    def load(self, path: PathLike) -> dict[str, Any]:
        """Resumes from a model that was saved from the same base. Returns its lineage."""
        lineage: dict[str, Any] = json.loads(self._adapter.load(os.fspath(path)))
        return lineage

    def eval(
        self,
        env: Any = None,
        *,
        env_params: Optional[dict[str, Any]] = None,
        episodes: int = 100,
        first_seed: int = 1_000_000,
        verbose: bool = False,
    ) -> dict[str, Any]:
        """Compares the frozen policy, a fresh adapter and the conventional controller on the same episodes.

        Returns:
            ``controllers``, each with ``controller``, ``rms_error`` (last third of the episodes) and ``lost``; ``rollbacks``,
            ``disarmed`` and ``episodes``.
        """
        given = self._learner._environments(env, env_params)
        report, text = self._adapter.compare(given, episodes, first_seed, verbose)
        if verbose:
            print(text, end="")
        outcome: dict[str, Any] = json.loads(report)
        return outcome
