"""Names of arguments from before 0.1, which are accepted until 1.0."""

from __future__ import annotations

import warnings
from typing import Any


def under_older_name(value: Any, name: str, given: dict[str, Any], older: str) -> Any:
    """Returns the argument ``name``, whose value may be in ``given`` under its older name.

    Raises:
        TypeError: Both are given.
    """
    if older not in given:
        return value
    if value is not None:
        raise TypeError(f"{name} and {older} are the same argument; give only {name}")
    return given.pop(older)


def renamed(value: Any, name: str, given: dict[str, Any], former: str) -> Any:
    """As :func:`under_older_name`, with a ``DeprecationWarning`` for the former name."""
    if former in given:
        warnings.warn(f"{former} is called {name}", DeprecationWarning, stacklevel=3)
    return under_older_name(value, name, given, former)
