"""Compatibility with OpenDR 3.0: its module paths, names and arguments.

``tasks`` is the table, with a module for each of OpenDR's packages. The rest is derived from it: module paths without
files (``opendr.perception.object_detection_2d.ssd.ssd_learner``), placeholders of missing classes, arguments in OpenDR's
order, and the tables of docs/python.md.
"""

from __future__ import annotations

# True for type checkers. The module `typing` takes ten times as long to import as the rest.
TYPE_CHECKING = False
if TYPE_CHECKING:
    from importlib.machinery import ModuleSpec
    from typing import Any, Optional


class Finder:
    """Import finder for OpenDR's module paths without files."""

    @staticmethod
    def find_spec(fullname: str, path: Any = None, target: Any = None) -> Optional[ModuleSpec]:
        """Returns the spec of a module in the table."""
        if not fullname.startswith("opendr.") or fullname.startswith("opendr._"):
            return None
        from opendr._upstream.modules import spec_of

        return spec_of(fullname)
