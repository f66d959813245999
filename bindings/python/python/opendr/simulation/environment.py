"""An environment of the toolkit as Gymnasium has them."""

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

    It ends episodes by its own time limit, which a wrapper can make shorter, not longer, and refuses wrong use: an action
    outside its space, a step after the end.

    Args:
        id: Name and version, as in ``"CartPole-v1"``; ``opendr.simulation.environments()`` has them.
        render_mode: ``"rgb_array"``, or None for no pictures.
        params: What can be set of this environment.

    Raises:
        FileNotFoundError: There is no such environment.
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
        """Begins an episode; the options are those of the environment's parameters that a reset can choose."""
        super().reset(seed=seed)
        info = self._native.reset(seed, options)
        return self._read(), info

    def step(self, action: Any) -> tuple[Any, float, bool, bool, dict[str, Any]]:
        """Takes a step: observation, reward, terminated, truncated, info.

        Raises:
            ValueError: The action is none of its space, or the episode is over.
        """
        self._write(action)
        reward, terminated, truncated, info = self._native.step()
        return self._read(), reward, terminated, truncated, info

    def render(self) -> Optional[NDArray[np.uint8]]:
        """A picture, ``[height, width, 3]``, where the render mode asks for one."""
        pixels = None if self.render_mode is None else self._native.render()
        return None if pixels is None else np.ascontiguousarray(np.transpose(np.asarray(pixels), (1, 2, 0)))

    def snapshot(self) -> str:
        """The state of now as a text to keep: for planning, exact replay, checkpoints."""
        return self._native.snapshot()

    def restore(self, snapshot: str) -> None:
        """Goes back to a state: the same actions then have the same outcome, bit for bit."""
        self._native.restore(snapshot)


def check_render_mode(mode: Optional[str], metadata: dict[str, Any]) -> None:
    """Refuses a render mode that is not there."""
    if mode is not None and mode not in metadata["render_modes"]:
        raise InvalidParam(f"render_mode is {mode!r}; there are {metadata['render_modes']} and None")
