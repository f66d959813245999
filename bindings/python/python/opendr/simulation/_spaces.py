"""Conversion of spaces between the tables of the native module and Gymnasium, and of their elements to shared arrays."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any, Optional

import numpy as np
from gymnasium import spaces
from numpy.typing import NDArray

from opendr._errors import InvalidInput, Unsupported

Array = NDArray[Any]


def space_from_table(table: dict[str, Any]) -> spaces.Space[Any]:
    """Returns Gymnasium's space of a table of the native module."""
    kind = table["type"]
    if kind == "Box":
        shape, dtype = table["shape"], np.dtype(table["dtype"])
        low, high = (
            np.full(shape, bound) if np.ndim(bound) == 0 else np.reshape(bound, shape)
            for bound in (table["low"], table["high"])
        )
        return spaces.Box(low.astype(dtype), high.astype(dtype), shape, dtype.type)
    if kind == "Discrete":
        return spaces.Discrete(table["n"], start=table["start"])
    if kind == "MultiDiscrete":
        return spaces.MultiDiscrete(table["nvec"])
    if kind == "MultiBinary":
        return spaces.MultiBinary(table["shape"])
    if kind == "Dict":
        return spaces.Dict({name: space_from_table(part) for name, part in table["spaces"].items()})
    return spaces.Tuple([space_from_table(part) for part in table["spaces"]])


def table_from_space(space: spaces.Space[Any]) -> dict[str, Any]:
    """Returns the table of a space of Gymnasium.

    Raises:
        Unsupported: The space is of an unsupported type.
    """
    if isinstance(space, spaces.Box):
        low, high = (np.ravel(bound).tolist() for bound in (space.low, space.high))
        return {"type": "Box", "low": low, "high": high, "shape": space.shape, "dtype": _dtype(space.dtype)}
    if isinstance(space, spaces.Discrete):
        return {"type": "Discrete", "n": int(space.n), "start": int(space.start)}
    if isinstance(space, spaces.MultiDiscrete):
        return {"type": "MultiDiscrete", "nvec": np.ravel(space.nvec).tolist()}
    if isinstance(space, spaces.MultiBinary):
        return {"type": "MultiBinary", "shape": tuple(map(int, space.shape))}
    if isinstance(space, spaces.Dict):
        return {"type": "Dict", "spaces": {name: table_from_space(part) for name, part in space.spaces.items()}}
    if isinstance(space, spaces.Tuple):
        return {"type": "Tuple", "spaces": [table_from_space(part) for part in space.spaces]}
    raise Unsupported(f"the space {space} is not supported; supported are Box, Discrete, MultiDiscrete, MultiBinary, Dict and Tuple")


def _dtype(dtype: np.dtype[Any]) -> str:
    if dtype.kind == "f":
        return "float64" if dtype.itemsize >= 8 else "float32"
    return "uint8" if dtype == np.uint8 else "int64"


def parts_of(space: spaces.Space[Any]) -> Optional[list[tuple[Any, spaces.Space[Any]]]]:
    """Returns keys and parts of a dictionary or tuple, in the order of the native module; None for other spaces."""
    if isinstance(space, spaces.Dict):
        return [(name, space.spaces[name]) for name in sorted(space.spaces)]
    if isinstance(space, spaces.Tuple):
        return list(enumerate(space.spaces))
    return None


def shared(arrays: list[Any]) -> list[Array]:
    """Returns views of arrays of the native module."""
    return [np.asarray(array) for array in arrays]


def reader(space: spaces.Space[Any], arrays: list[Array], copy: bool = True) -> Callable[[], Any]:
    """Returns a function that reads the current element of the arrays, by default as a copy."""
    return _reader(space, iter(arrays), copy)


def _reader(space: spaces.Space[Any], arrays: Iterator[Array], copy: bool) -> Callable[[], Any]:
    parts = parts_of(space)
    if parts is None:
        array = next(arrays)
        if isinstance(space, spaces.Discrete) and array.ndim == 0:
            return lambda: array[()]
        return array.copy if copy else lambda: array
    readers = [(key, _reader(part, arrays, copy)) for key, part in parts]
    if isinstance(space, spaces.Dict):
        return lambda: {key: read() for key, read in readers}
    return lambda: tuple(read() for _, read in readers)


def element(space: spaces.Space[Any], arrays: list[Array], index: int) -> Any:
    """Returns a copy of element ``index`` of arrays of several elements."""
    return reader(space, [array[index] for array in arrays])()


def writer(space: spaces.Space[Any], arrays: list[Array], what: str) -> Callable[[Any], None]:
    """Returns a function that writes an element into the arrays and raises for another shape or non-numeric values."""
    return _writer(space, iter(arrays), what)


def _writer(space: spaces.Space[Any], arrays: Iterator[Array], what: str) -> Callable[[Any], None]:
    parts = parts_of(space)
    if parts is None:
        return _leaf_writer(next(arrays), what)
    writers = [(key, _writer(part, arrays, f"{what}[{key!r}]")) for key, part in parts]

    def write(value: Any) -> None:
        try:
            parts = [value[key] for key, _ in writers]
        except (KeyError, IndexError, TypeError):
            keys = [key for key, _ in writers]
            raise InvalidInput(f"{what} is {value!r}; give the parts {keys}") from None
        for (_, write), part in zip(writers, parts):
            write(part)

    return write


def _leaf_writer(array: Array, what: str) -> Callable[[Any], None]:
    shape = array.shape

    def write(value: Any) -> None:
        given = np.shape(value)
        if given != shape:
            raise InvalidInput(f"{what} has the shape {given}; give {shape}")
        try:
            np.copyto(array, value, casting="same_kind")
        except TypeError:
            raise InvalidInput(f"{what} is {value!r}; give numbers") from None

    return write
