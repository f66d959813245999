"""Spaces in plain words, as the native half has them, and Gymnasium's; elements in arrays shared with the native half."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any, Optional

import numpy as np
from gymnasium import spaces
from numpy.typing import NDArray

from opendr._errors import InvalidInput, Unsupported

Array = NDArray[Any]


def space_from_table(table: dict[str, Any]) -> spaces.Space[Any]:
    """Gymnasium's space of a table of the native half."""
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
    """The table of one of Gymnasium's spaces.

    Raises:
        Unsupported: No learner takes such a space.
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
    raise Unsupported(f"no learner takes {space}; there are Box, Discrete, MultiDiscrete, MultiBinary, Dict and Tuple")


def _dtype(dtype: np.dtype[Any]) -> str:
    if dtype.kind == "f":
        return "float64" if dtype.itemsize >= 8 else "float32"
    return "uint8" if dtype == np.uint8 else "int64"


def parts_of(space: spaces.Space[Any]) -> Optional[list[tuple[Any, spaces.Space[Any]]]]:
    """Keys and parts of a dictionary or tuple, in the order of the native half; None for what has no parts."""
    if isinstance(space, spaces.Dict):
        return [(name, space.spaces[name]) for name in sorted(space.spaces)]
    if isinstance(space, spaces.Tuple):
        return list(enumerate(space.spaces))
    return None


def shared(arrays: list[Any]) -> list[Array]:
    """Arrays of the native half, seen without a copy."""
    return [np.asarray(array) for array in arrays]


def reader(space: spaces.Space[Any], arrays: list[Array], copy: bool = True) -> Callable[[], Any]:
    """A function that gives the elements which the arrays hold now, by default as copies."""
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
    """A copy of element number ``index`` of arrays that hold many."""
    return reader(space, [array[index] for array in arrays])()


def writer(space: spaces.Space[Any], arrays: list[Array], what: str) -> Callable[[Any], None]:
    """A function that puts an element into the arrays; it refuses what has another shape or is no number."""
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
