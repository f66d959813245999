"""Checks of arguments. NumPy's numbers are accepted like Python's."""

from __future__ import annotations

import operator
from collections.abc import Mapping, Sequence
from typing import Any, SupportsFloat, SupportsIndex, Union

#: A number of Python's or NumPy's.
Real = Union[float, SupportsFloat, SupportsIndex]
#: Maximum number of class names in a list.
_MAX_CLASSES = 1 << 16


def whole(value: SupportsIndex, what: str) -> int:
    """Returns ``value`` as an ``int``.

    Raises:
        TypeError: The value is not an integer.
    """
    try:
        return operator.index(value)
    except TypeError:
        raise TypeError(f"{what} should be an int, not {value!r}") from None


def real(value: Real, what: str) -> float:
    """Returns ``value`` as a finite ``float``.

    Raises:
        TypeError: The value is not a number.
        ValueError: The value is NaN or infinite.
    """
    if type(value) is not float:
        if isinstance(value, (str, bytes, bytearray)):
            raise TypeError(f"{what} should be a number, not {value!r}")
        try:
            value = float(value)
        except TypeError:
            raise TypeError(f"{what} should be a number, not {value!r}") from None
    if value - value != 0.0:
        raise ValueError(f"{what} is {value}; give a finite number")
    return value


def reals(values: Sequence[Real], count: int, what: str) -> tuple[float, ...]:
    """Returns ``values`` as ``count`` finite floats.

    Raises:
        TypeError: The value is not a sequence of numbers.
        ValueError: The length is another, or a number is not finite.
    """
    try:
        numbers = tuple(real(value, what) for value in values)
    except TypeError:
        raise TypeError(f"{what} should be {count} numbers, not {values!r}") from None
    if len(numbers) != count:
        raise ValueError(f"{what} has {len(numbers)} numbers; give {count}")
    return numbers


def class_name_or_index(name: Union[int, str, SupportsIndex]) -> Union[int, str]:
    """Returns the class of a box: an ``int``, or a ``str``.

    Raises:
        TypeError: The value is neither.
    """
    if type(name) is int or type(name) is str:
        return name
    if isinstance(name, str):
        return str(name)
    try:
        return operator.index(name)
    except TypeError:
        raise TypeError(f"name should be a class index (int) or a label (str), not {name!r}") from None


def text(value: str, what: str) -> str:
    """Returns ``value`` if it is a ``str``.

    Raises:
        TypeError: The value is not a ``str``.
    """
    if not isinstance(value, str):
        raise TypeError(f"{what} should be a str, not {value!r}")
    return value


def names_by_index(names: Mapping[Any, str]) -> list[str]:
    """Returns the list of class names by index, with an empty name for missing indices; keys that are not class indices
    are ignored.

    Raises:
        ValueError: An index is too high.
    """
    indices = [key for key in names if isinstance(key, int) and key >= 0]
    count = max(indices, default=-1) + 1
    if count > _MAX_CLASSES:
        raise ValueError(f"class index {count - 1} is too high to have a name; give indices below {_MAX_CLASSES}")
    return [str(names.get(index, "")) for index in range(count)]
