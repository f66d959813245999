"""Names of arguments from before 0.1, which go on working until 1.0."""

from __future__ import annotations

from typing import Any


def under_older_name(value: Any, name: str, given: dict[str, Any], older: str) -> Any:
    """Returns the argument ``name``, whose value may stand in ``given`` under its older name.

    Raises:
        TypeError: Both are given.
    """
    if older not in given:
        return value
    if value is not None:
        raise TypeError(f"{name} and {older} are one argument; give {name}")
    return given.pop(older)
