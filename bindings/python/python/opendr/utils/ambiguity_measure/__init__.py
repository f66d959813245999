"""Whether a map of values leaves a doubt where its best place is."""

from __future__ import annotations

from opendr.utils.ambiguity_measure.ambiguity_measure import AmbiguityMeasure

__all__ = ["AmbiguityMeasure"]
