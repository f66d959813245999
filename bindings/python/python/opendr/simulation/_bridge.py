"""Environments of Gymnasium for the learners of the toolkit."""

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
    """Connects an environment to the native module: writes observations into its arrays and reads actions from them.

    Args:
        env: An environment with Gymnasium's interface.

    Raises:
        Unsupported: A space is of an unsupported type.
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
        """Sets the shared arrays; called once."""
        self._write = writer(self.env.observation_space, shared(observation), "the observation")
        self._action = shared(action)

    def reset(self, seed: Optional[int], options: Optional[dict[str, Any]]) -> dict[str, float]:
        """Begins an episode."""
        observation, info = self.env.reset(seed=seed, options=options)
        self._write_observation(observation)
        return _numbers(info)

    def step(self) -> tuple[float, bool, bool, dict[str, float]]:
        """Takes a step."""
        step = self.env.step(_element(self.env.action_space, iter(self._action)))
        if len(step) != 5:
            raise InvalidInput(
                f"step() returned {len(step)} values; Gymnasium 1.x returns 5, with terminated and truncated"
            )
        observation, reward, terminated, truncated, info = step
        self._write_observation(observation)
        return float(reward), bool(terminated), bool(truncated), _numbers(info)

    def render(self) -> Optional[NDArray[np.uint8]]:
        """Returns an image if the render mode is ``"rgb_array"``, else None."""
        if self.env.render_mode != "rgb_array":
            return None
        image = self.env.render()
        return np.ascontiguousarray(image, np.uint8) if isinstance(image, np.ndarray) else None

    def _write_observation(self, observation: Any) -> None:
        self._write(_from_zero(self.env.observation_space, observation))


def _from_zero(space: spaces.Space[Any], value: Any) -> Any:
    """Returns an element with ``MultiDiscrete`` values flattened and counted from 0."""
    parts = parts_of(space)
    if parts is not None:
        return {key: _from_zero(part, value[key]) for key, part in parts}
    if isinstance(space, spaces.MultiDiscrete):
        return np.ravel(np.asarray(value) - space.start)
    return value


def _element(space: spaces.Space[Any], arrays: Iterator[Array]) -> Any:
    """Returns the element that the arrays contain, in the space's own types."""
    parts = parts_of(space)
    if parts is not None:
        elements = {key: _element(part, arrays) for key, part in parts}
        return elements if isinstance(space, spaces.Dict) else tuple(elements[key] for key, _ in parts)
    array = next(arrays)
    if isinstance(space, spaces.Box):
        value = array.astype(space.dtype)
        # A float64 bound may be exceeded by its rounded float32 value.
        return value if space.dtype == np.float32 else np.clip(value, space.low, space.high)
    if isinstance(space, spaces.MultiDiscrete):
        return array.reshape(space.shape).astype(space.dtype) + space.start
    assert space.dtype is not None
    return array.astype(space.dtype)[()]


def _numbers(info: dict[str, Any]) -> dict[str, float]:
    """Returns the numeric values of ``info``, with ``is_success`` also as ``success``."""
    numbers = {key: float(value) for key, value in info.items() if isinstance(value, _NUMBERS) and isinstance(key, str)}
    if "is_success" in numbers:
        numbers.setdefault("success", numbers["is_success"])
    return numbers


_NUMBERS = (bool, int, float, np.bool_, np.integer, np.floating)
