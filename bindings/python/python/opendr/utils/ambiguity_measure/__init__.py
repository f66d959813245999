"""Ambiguity of the best position in a map of values."""

from __future__ import annotations

from opendr.utils.ambiguity_measure.ambiguity_measure import AmbiguityMeasure

__all__ = ["AmbiguityMeasure"]
