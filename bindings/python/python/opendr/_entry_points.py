"""Learners of other packages: the entry-point group ``opendr.learners``."""

from __future__ import annotations

import sys
import warnings
from importlib import metadata
from typing import Any

GROUP = "opendr.learners"


def learner_entry_points() -> list[metadata.EntryPoint]:
    """The entry points of the group, by name; nothing is imported."""
    if sys.version_info >= (3, 10):
        found = list(metadata.entry_points(group=GROUP))
    else:
        found = list(metadata.entry_points().get(GROUP, ()))
    # One installation may be seen through several folders of the path.
    return sorted({point.name: point for point in reversed(found)}.values(), key=lambda point: point.name)


def learner_classes() -> list[tuple[str, Any]]:
    """Name and class of each entry point. One that cannot be imported is warned of and left out."""
    classes = []
    for point in learner_entry_points():
        try:
            classes.append((point.name, point.load()))
        except Exception as error:
            warn(point, error)
    return classes


def warn(point: metadata.EntryPoint, error: Exception) -> None:
    """Warns that the learner of ``point`` is left out."""
    kind = type(error).__name__
    warnings.warn(
        f"the learner {point.name!r} ({point.value}) is left out: {kind}: {error}; mend or uninstall its package",
        RuntimeWarning,
        stacklevel=3,
    )
