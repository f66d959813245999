"""Gymnasium's interface to an environment of the toolkit."""

from __future__ import annotations

from typing import Any, Optional

import gymnasium
import numpy as np
from numpy.typing import NDArray

from opendr import _opendr
from opendr._errors import InvalidParam
from opendr.simulation._spaces import reader, shared, space_from_table, writer


class Environment(gymnasium.Env[Any, Any]):
    """An environment of the toolkit.

    It truncates episodes at its own time limit, which a wrapper can shorten but not extend, and raises for an action
    outside its space and for a step after the end of the episode.

    Args:
        id: Name and version, as in ``"CartPole-v1"``; ``opendr.simulation.environments()`` lists them.
        render_mode: ``"rgb_array"``, or None for no images.
        params: Parameters of the environment.

    Raises:
        FileNotFoundError: The environment does not exist.
        ValueError: A parameter is unknown or out of range.
    """

    metadata: dict[str, Any] = {"render_modes": ["rgb_array"], "render_fps": 30}

    def __init__(self, id: str, *, render_mode: Optional[str] = None, **params: Any) -> None:
        check_render_mode(render_mode, self.metadata)
        self._native = _opendr.Environment(id, params)
        table = self._native.spec
        self.render_mode = render_mode
        self.observation_space = space_from_table(table["observation"])
        self.action_space = space_from_table(table["action"])
        self._read = reader(self.observation_space, shared(self._native.observation))
        self._write = writer(self.action_space, shared(self._native.action), "the action")

    def reset(
        self, *, seed: Optional[int] = None, options: Optional[dict[str, Any]] = None
    ) -> tuple[Any, dict[str, Any]]:
        """Begins an episode; the options are those parameters of the environment that can change at a reset."""
        super().reset(seed=seed)
        info = self._native.reset(seed, options)
        return self._read(), info

    def step(self, action: Any) -> tuple[Any, float, bool, bool, dict[str, Any]]:
        """Takes a step. Returns observation, reward, terminated, truncated, info.

        Raises:
            ValueError: The action is not in its space, or the episode is over.
        """
        self._write(action)
        reward, terminated, truncated, info = self._native.step()
        return self._read(), reward, terminated, truncated, info

    def render(self) -> Optional[NDArray[np.uint8]]:
        """Returns an image, ``[height, width, 3]``, or None without a render mode."""
        pixels = None if self.render_mode is None else self._native.render()
        return None if pixels is None else np.ascontiguousarray(np.transpose(np.asarray(pixels), (1, 2, 0)))

    def snapshot(self) -> str:
        """Returns the current state as text, for planning, exact replay and checkpoints."""
        return self._native.snapshot()

    def restore(self, snapshot: str) -> None:
        """Restores a state: the same actions then have the same results, bit for bit."""
        self._native.restore(snapshot)


def check_render_mode(mode: Optional[str], metadata: dict[str, Any]) -> None:
    """Raises for a render mode that does not exist."""
    if mode is not None and mode not in metadata["render_modes"]:
        raise InvalidParam(f"render_mode is {mode!r}; the modes are {metadata['render_modes']} and None")
