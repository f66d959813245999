"""Gymnasium's vector interface to environments of the toolkit."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Optional, Union

import numpy as np
from gymnasium.vector import AutoresetMode, VectorEnv
from gymnasium.vector.utils import batch_space
from numpy.typing import NDArray

from opendr import _opendr
from opendr._errors import InvalidInput, InvalidParam, Unsupported
from opendr.simulation._spaces import element, reader, shared, space_from_table, writer

Flags = NDArray[np.bool_]


class VectorEnvironment(VectorEnv[Any, Any, NDArray[Any]]):
    """Environments of one kind that are stepped together by native threads, without Python code per environment.

    Args:
        id: Name and version, as in ``"CartPole-v1"``.
        num_envs: Number of environments.
        threads: Number of threads, which does not change any result. Environments too small to gain from threads use one.
        autoreset_mode: When an environment whose episode ended begins the next one.
        copy: Whether observations, rewards, terminations and truncations are copies. If not, they are the same read-only
            arrays from step to step.
        max_episode_steps: The environment's own limit; other values raise.
        render_mode: Only None is supported.
        params: Parameters of the environments.

    Raises:
        FileNotFoundError: The environment does not exist.
        ValueError: An argument is unknown or out of range.
    """

    def __init__(
        self,
        id: str,
        num_envs: int = 1,
        *,
        threads: int = 1,
        autoreset_mode: Union[AutoresetMode, str] = AutoresetMode.NEXT_STEP,
        copy: bool = True,
        max_episode_steps: Optional[int] = None,
        render_mode: Optional[str] = None,
        **params: Any,
    ) -> None:
        if render_mode is not None:
            raise Unsupported("a VectorEnvironment cannot render; use opendr.simulation.Environment")
        try:
            mode = AutoresetMode(autoreset_mode)
        except ValueError:
            modes = [mode.value for mode in AutoresetMode]
            raise InvalidParam(f"autoreset_mode is {autoreset_mode!r}; the modes are {modes}") from None
        native = self._native = _opendr.VectorEnvironment(id, params, num_envs, threads, mode.value)
        table = native.spec
        if max_episode_steps not in (None, table["max_episode_steps"]):
            own = table["max_episode_steps"]
            raise InvalidParam(f"max_episode_steps is {max_episode_steps}; a VectorEnvironment of {id} supports only its own limit, {own}")
        self.num_envs = num_envs
        self.metadata = {"render_modes": [], "autoreset_mode": mode}
        self.single_observation_space = space_from_table(table["observation"])
        self.single_action_space = space_from_table(table["action"])
        self.observation_space = batch_space(self.single_observation_space, num_envs)
        self.action_space = batch_space(self.single_action_space, num_envs)
        self._read = reader(self.single_observation_space, shared(native.observations), copy)
        self._write = writer(self.single_action_space, shared(native.actions), "the actions")
        arrays = shared([native.rewards, native.terminations, native.truncations])
        self._rewards, self._terminations, self._truncations = arrays
        self._final_observations = shared(native.final_observations)
        self._copy = copy

    def reset(
        self,
        *,
        seed: Union[int, Sequence[Optional[int]], None] = None,
        options: Optional[dict[str, Any]] = None,
    ) -> tuple[Any, dict[str, Any]]:
        """Begins an episode in every environment, or in those where ``options["reset_mask"]`` is true."""
        options = dict(options or {})
        mask = options.pop("reset_mask", None)
        if mask is not None and (not isinstance(mask, np.ndarray) or mask.dtype != np.bool_ or mask.ndim != 1):
            raise InvalidInput(f"options['reset_mask'] is {mask!r}; give a bool array of shape ({self.num_envs},)")
        single = None if seed is None or isinstance(seed, Sequence) else int(seed)
        super().reset(seed=single)
        seeds = list(seed) if isinstance(seed, Sequence) else None
        infos = self._native.reset(single, seeds, options, None if mask is None else mask.tolist())
        return self._read(), self._infos(infos)

    def step(self, actions: Any) -> tuple[Any, NDArray[np.float64], Flags, Flags, dict[str, Any]]:
        """Takes a step in every environment. Returns observations, rewards, terminations, truncations, infos.

        Raises:
            ValueError: An action is not in its space, or an episode is over and the autoreset mode is ``DISABLED``.
        """
        self._write(actions)
        native_infos, native_ends = self._native.step()
        infos = self._infos(native_infos) if native_infos else {}
        if native_ends is not None:
            over = self._terminations | self._truncations
            infos.update(self._ends(over, native_ends))
        if not self._copy:
            return self._read(), self._rewards, self._terminations, self._truncations, infos
        return self._read(), self._rewards.copy(), self._terminations.copy(), self._truncations.copy(), infos

    def snapshot(self) -> str:
        """Returns the state of all environments as text, without the last observations."""
        return self._native.snapshot()

    def restore(self, snapshot: str) -> None:
        """Restores a state: the same actions then have the same results, bit for bit."""
        self._native.restore(snapshot)

    def _infos(self, infos: dict[str, tuple[Any, Any]]) -> dict[str, Any]:
        """Converts infos to Gymnasium's form: the values under the name, their mask under the name with an underscore."""
        written: dict[str, Any] = {}
        for key, (numbers, has) in infos.items():
            written[key], written[f"_{key}"] = shared([numbers, has])
        return written

    def _ends(self, over: Flags, infos: dict[str, tuple[Any, Any]]) -> dict[str, Any]:
        last = np.full(self.num_envs, None, dtype=object)
        for index in np.flatnonzero(over):
            last[index] = element(self.single_observation_space, self._final_observations, int(index))
        return {
            "final_obs": last,
            "_final_obs": over,
            "final_info": self._infos(infos),
            "_final_info": over.copy(),
        }
