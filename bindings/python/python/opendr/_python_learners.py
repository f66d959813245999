"""The learners written in Python that this process has registered."""

from __future__ import annotations

from typing import Optional

from opendr.engine.learners import BaseLearner

#: The classes by their names in the registry.
PYTHON_LEARNERS: dict[str, type[BaseLearner]] = {}


def registered_name(cls: type) -> Optional[str]:
    """Returns the name under which a class was registered, or None."""
    return next((name for name, other in PYTHON_LEARNERS.items() if other is cls), None)
