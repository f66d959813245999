"""Prior controllers that policies start from, learn from, or are shielded by (docs/priors.md).

    from opendr import priors
    from opendr.control.reinforcement_learning import ResidualSacLearner

    priors.register("mine", 1, lambda seen: [-2.0 * seen[1] - 0.5 * seen[2]], "damps the pendulum of Pendulum-v1")
    learner = ResidualSacLearner()
    learner.fit("Pendulum-v1", prior="mine", total_timesteps=5000)

A policy names its prior with the version: register the same one before the policy is loaded.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import NamedTuple

from opendr import _opendr

__all__ = ["Prior", "names", "priors", "register"]


class Prior(NamedTuple):
    """A prior of this process.

    Attributes:
        name: Name, the value of the parameter ``prior``.
        version: Version, from 1; policies name it, too.
        about: What it does and where.
    """

    name: str
    version: int
    about: str


def register(name: str, version: int, act: Callable[[list[float]], Iterable[float]], about: str = "") -> None:
    """Makes a function a prior of this process.

    Args:
        name: Name, the value of the parameter ``prior``.
        version: Version, from 1; a change of the actions needs a new one.
        act: Function without state, from the numbers of an observation to those of an action.
        about: What it does and where, in one sentence.

    Raises:
        ValueError: Another prior has this name and version.
    """
    if not callable(act):
        raise TypeError(f"act is a {type(act).__name__}; give a function from an observation to an action")
    _opendr.register_prior(name, version, act, about)


def priors() -> list[Prior]:
    """Returns all priors of this process: the built-in ones, then those that were registered."""
    return [Prior(*row) for row in _opendr.priors()]


def names() -> list[str]:
    """Returns the names of all priors."""
    return [prior.name for prior in priors()]
