"""The environments of the registry, in Gymnasium's."""

from __future__ import annotations

from typing import Any

from opendr import _opendr

NAMESPACE = "opendr"


def environments() -> dict[str, dict[str, Any]]:
    """What there is to know of every environment, by its name.

    An entry has ``observation`` and ``action`` (spaces in plain words), ``max_episode_steps``, ``reward_range``,
    ``reward_threshold`` and ``params``: name, text, default and range of what :class:`Environment` takes.
    """
    return {table["id"]: table for table in _opendr.environments()}


def register() -> None:
    """Puts all environments into Gymnasium's registry, as ``opendr/CartPole-v1``."""
    from gymnasium.envs import registration

    for name, table in environments().items():
        if f"{NAMESPACE}/{name}" in registration.registry:
            continue
        registration.register(
            id=f"{NAMESPACE}/{name}",
            entry_point="opendr.simulation:Environment",
            vector_entry_point="opendr.simulation:VectorEnvironment",
            max_episode_steps=table["max_episode_steps"],
            reward_threshold=table["reward_threshold"],
            kwargs={"id": name},
        )
