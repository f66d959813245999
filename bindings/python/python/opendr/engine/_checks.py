"""Checks of plain values that users hand in. NumPy's numbers count as Python's."""

from __future__ import annotations

import operator
from collections.abc import Mapping, Sequence
from typing import Any, SupportsFloat, SupportsIndex, Union

#: A number of Python's or NumPy's.
Real = Union[float, SupportsFloat, SupportsIndex]
#: Class numbers that names can be listed for.
_MAX_CLASSES = 1 << 16


def whole(value: SupportsIndex, what: str) -> int:
    """``value`` as an ``int``.

    Raises:
        TypeError: It is no whole number.
    """
    try:
        return operator.index(value)
    except TypeError:
        raise TypeError(f"{what} should be an int, not {value!r}") from None


def real(value: Real, what: str) -> float:
    """``value`` as a finite ``float``.

    Raises:
        TypeError: It is no number.
        ValueError: It is NaN or infinite.
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
    """``values`` as ``count`` finite floats.

    Raises:
        TypeError: It is no sequence of numbers.
        ValueError: There are more or fewer, or one is not finite.
    """
    try:
        numbers = tuple(real(value, what) for value in values)
    except TypeError:
        raise TypeError(f"{what} should be {count} numbers, not {values!r}") from None
    if len(numbers) != count:
        raise ValueError(f"{what} has {len(numbers)} numbers; give {count}")
    return numbers


def class_name_or_index(name: Union[int, str, SupportsIndex]) -> Union[int, str]:
    """The class of a box: an ``int``, or a ``str``.

    Raises:
        TypeError: It is neither.
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
    """``value`` when it is a ``str``.

    Raises:
        TypeError: It is none.
    """
    if not isinstance(value, str):
        raise TypeError(f"{what} should be a str, not {value!r}")
    return value


def names_by_number(names: Mapping[Any, str]) -> list[str]:
    """The names of classes in the order of their numbers, empty where one has none; keys that are no class numbers are
    left out.

    Raises:
        ValueError: A number is too high for a list.
    """
    numbers = [key for key in names if isinstance(key, int) and key >= 0]
    count = max(numbers, default=-1) + 1
    if count > _MAX_CLASSES:
        raise ValueError(f"class number {count - 1} is too high to name; give numbers below {_MAX_CLASSES}")
    return [str(names.get(number, "")) for number in range(count)]
