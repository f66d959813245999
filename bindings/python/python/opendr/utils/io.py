"""File names, under OpenDR's second module path."""

from __future__ import annotations

from opendr.engine.helper.io import bump_version

__all__ = ["bump_version"]
