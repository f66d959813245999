"""Simulation: built-in environments with Gymnasium's semantics.

    import gymnasium
    import opendr.simulation                      # registers the environments

    env = gymnasium.make("opendr/UavDepthCorridor-v1")
    envs = gymnasium.make_vec("opendr/CartPole-v1", num_envs=64)

``gymnasium.make("opendr.simulation:opendr/UavDepthCorridor-v1")`` needs no import. Gymnasium is optional;
``environments`` and ``render`` work without it.

    opendr.simulation.render("persons", "rendered", frames=1000)      # a labelled data set, as COCO
"""

from __future__ import annotations

from importlib.util import find_spec
from typing import TYPE_CHECKING

from opendr.simulation._registered import environments
from opendr.simulation._rendering import render

if TYPE_CHECKING:
    from opendr.simulation.environment import Environment
    from opendr.simulation.vector_environment import VectorEnvironment

__all__ = ["Environment", "VectorEnvironment", "environments", "render"]

_HOMES = {
    "Environment": "opendr.simulation.environment",
    "VectorEnvironment": "opendr.simulation.vector_environment",
}


# Type checkers use the imports above and report other names as missing.
if not TYPE_CHECKING:

    def __getattr__(name):
        from importlib import import_module

        if name not in _HOMES:
            raise AttributeError(f"module 'opendr.simulation' has no attribute {name!r}")
        try:
            value = globals()[name] = getattr(import_module(_HOMES[name]), name)
        except ModuleNotFoundError as error:
            if error.name != "gymnasium":
                raise
            message = f"opendr.simulation.{name} needs Gymnasium; install the extra opendr-rs[gymnasium]"
            raise ModuleNotFoundError(message, name="gymnasium") from error
        return value


if find_spec("gymnasium") is not None:
    from opendr.simulation._registered import register

    register()
