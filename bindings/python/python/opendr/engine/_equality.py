"""Equality of values that may contain NumPy arrays."""

from __future__ import annotations

import sys
from typing import Any


def is_array(value: object) -> bool:
    """Returns whether ``value`` is a NumPy array, without importing NumPy: no array exists before it is imported."""
    numpy = sys.modules.get("numpy")
    return numpy is not None and isinstance(value, numpy.ndarray)


def equal(one: Any, other: Any) -> bool:
    """Returns ``one == other``, with arrays compared by ``numpy.array_equal``, also in lists, tuples and dictionaries."""
    if one is other:
        return True
    if is_array(one) or is_array(other):
        import numpy as np

        return is_array(one) and is_array(other) and bool(np.array_equal(one, other))
    if isinstance(one, dict) and isinstance(other, dict):
        return one.keys() == other.keys() and all(equal(one[key], other[key]) for key in one)
    if isinstance(one, (list, tuple)) and isinstance(other, (list, tuple)):
        same_kind = isinstance(one, list) == isinstance(other, list)
        return same_kind and len(one) == len(other) and all(map(equal, one, other))
    return bool(one == other)
