"""OpenDR's ambiguity measure."""

from __future__ import annotations

from opendr._upstream.rows import Home

_HERE = "opendr.utils.ambiguity_measure"

MODULES: dict[str, dict[str, Home]] = {
    "": {"AmbiguityMeasure": _HERE},
    "ambiguity_measure": {"AmbiguityMeasure": _HERE},
}
