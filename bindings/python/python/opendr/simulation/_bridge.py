"""Any environment of Gymnasium, for the learners of the toolkit."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, Optional

import gymnasium
import numpy as np
from gymnasium import spaces
from numpy.typing import NDArray

from opendr._errors import InvalidInput
from opendr.simulation._spaces import Array, parts_of, shared, table_from_space, writer


class Bridge:
    """Puts observations into arrays of the native half, and takes actions from there.

    Args:
        env: An environment with Gymnasium's interface.

    Raises:
        Unsupported: No learner takes one of its spaces.
    """

    def __init__(self, env: gymnasium.Env[Any, Any]) -> None:
        self.env = env
        spec = env.spec
        self.spec = {
            "id": type(env.unwrapped).__name__ if spec is None else spec.id,
            "observation": table_from_space(env.observation_space),
            "action": table_from_space(env.action_space),
            "max_episode_steps": None if spec is None else spec.max_episode_steps,
            "reward_threshold": None if spec is None else spec.reward_threshold,
        }

    def share(self, observation: list[Any], action: list[Any]) -> None:
        """Takes the arrays; called once."""
        self._write = writer(self.env.observation_space, shared(observation), "the observation")
        self._action = shared(action)

    def reset(self, seed: Optional[int], options: Optional[dict[str, Any]]) -> dict[str, float]:
        """Begins an episode."""
        observation, info = self.env.reset(seed=seed, options=options)
        self._see(observation)
        return _numbers(info)

    def step(self) -> tuple[float, bool, bool, dict[str, float]]:
        """Takes a step."""
        answer = self.env.step(_element(self.env.action_space, iter(self._action)))
        if len(answer) != 5:
            raise InvalidInput(f"step() gave {len(answer)} values; Gymnasium 1.x gives 5, with terminated and truncated")
        observation, reward, terminated, truncated, info = answer
        self._see(observation)
        return float(reward), bool(terminated), bool(truncated), _numbers(info)

    def render(self) -> Optional[NDArray[np.uint8]]:
        """A picture, where it was made to draw some."""
        if self.env.render_mode != "rgb_array":
            return None
        picture = self.env.render()
        return np.ascontiguousarray(picture, np.uint8) if isinstance(picture, np.ndarray) else None

    def _see(self, observation: Any) -> None:
        self._write(_from_zero(self.env.observation_space, observation))


def _from_zero(space: spaces.Space[Any], value: Any) -> Any:
    """An element whose choices lie in a row and count from 0."""
    parts = parts_of(space)
    if parts is not None:
        return {key: _from_zero(part, value[key]) for key, part in parts}
    if isinstance(space, spaces.MultiDiscrete):
        return np.ravel(np.asarray(value) - space.start)
    return value


def _element(space: spaces.Space[Any], arrays: Iterator[Array]) -> Any:
    """The element whose numbers lie in the arrays, in the space's own types."""
    parts = parts_of(space)
    if parts is not None:
        found = {key: _element(part, arrays) for key, part in parts}
        return found if isinstance(space, spaces.Dict) else tuple(found[key] for key, _ in parts)
    array = next(arrays)
    if isinstance(space, spaces.Box):
        value = array.astype(space.dtype)
        # A bound of more digits than the arrays have may lie beside the number that stands for it.
        return value if space.dtype == np.float32 else np.clip(value, space.low, space.high)
    if isinstance(space, spaces.MultiDiscrete):
        return array.reshape(space.shape).astype(space.dtype) + space.start
    assert space.dtype is not None
    return array.astype(space.dtype)[()]


def _numbers(info: dict[str, Any]) -> dict[str, float]:
    """The numbers among what else is known; success under our name for it, too."""
    numbers = {key: float(value) for key, value in info.items() if isinstance(value, _NUMBERS) and isinstance(key, str)}
    if "is_success" in numbers:
        numbers.setdefault("success", numbers["is_success"])
    return numbers


_NUMBERS = (bool, int, float, np.bool_, np.integer, np.floating)
