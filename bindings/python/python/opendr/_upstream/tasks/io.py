"""OpenDR's file names."""

from __future__ import annotations

from opendr._upstream.rows import Home

MODULES: dict[str, dict[str, Home]] = {"": {"bump_version": "opendr.utils.io"}}
