"""OpenDR 3.0's module paths, names and arguments, and where each of them is here.

``tasks`` has the table, a module for each of OpenDR's packages; everything else follows from it: module paths that are
no files (``opendr.perception.object_detection_2d.ssd.ssd_learner``), classes that stand in for those that are not here,
arguments in OpenDR's order, and the tables of docs/python.md.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Optional

if TYPE_CHECKING:
    from importlib.machinery import ModuleSpec


class Finder:
    """Finds OpenDR's module paths that are no files here."""

    @staticmethod
    def find_spec(fullname: str, path: Any = None, target: Any = None) -> Optional[ModuleSpec]:
        """Returns the spec of a module of the table."""
        if not fullname.startswith("opendr.") or fullname.startswith("opendr._"):
            return None
        from opendr._upstream.modules import spec_of

        return spec_of(fullname)
