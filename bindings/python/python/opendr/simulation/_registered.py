"""Registration of the environments with Gymnasium."""

from __future__ import annotations

from typing import Any

from opendr import _opendr

NAMESPACE = "opendr"


def environments() -> dict[str, dict[str, Any]]:
    """Returns the table of every environment by its name.

    A table has ``observation`` and ``action`` (spaces as plain dictionaries), ``max_episode_steps``, ``reward_range``,
    ``reward_threshold`` and ``params``: name, description, default and range of the parameters of :class:`Environment`.
    """
    return {table["id"]: table for table in _opendr.environments()}


def register() -> None:
    """Adds all environments to Gymnasium's registry, under names such as ``opendr/CartPole-v1``."""
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
