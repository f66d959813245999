"""Learners of other packages: the entry-point group ``opendr.learners``."""

from __future__ import annotations

import sys
import warnings
from importlib import metadata

GROUP = "opendr.learners"


def learner_entry_points() -> list[metadata.EntryPoint]:
    """Returns the entry points of the group, sorted by name, without importing them."""
    if sys.version_info >= (3, 10):
        found = list(metadata.entry_points(group=GROUP))
    else:
        found = list(metadata.entry_points().get(GROUP, ()))
    # One installation may be listed by several folders of the path.
    return sorted({(point.name, point.value): point for point in found}.values(), key=lambda point: point.name)


def warn(point: metadata.EntryPoint, error: Exception) -> None:
    """Warns that the learner of ``point`` is skipped."""
    kind = type(error).__name__
    warnings.warn(
        f"the learner {point.name!r} ({point.value}) is skipped: {kind}: {error}; fix or uninstall its package",
        RuntimeWarning,
        stacklevel=3,
    )
