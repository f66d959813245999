"""Names of files; OpenDR's other place of them."""

from __future__ import annotations

from opendr.engine.helper.io import bump_version

__all__ = ["bump_version"]
