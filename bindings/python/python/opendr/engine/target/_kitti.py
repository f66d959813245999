"""Conversion between OpenDR's dictionary of arrays of 3D boxes and plain lists."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

_COLUMNS = ("name", "truncated", "occluded", "alpha", "bbox", "dimensions", "location", "rotation_y", "score")
_FLOATS = ("truncated", "alpha", "bbox", "dimensions", "location", "rotation_y", "score")
_WIDTHS = {"bbox": 4, "dimensions": 3, "location": 3}


def arrays_from_columns(columns: Mapping[str, Sequence[Any]]) -> dict[str, NDArray[Any]]:
    """Returns an array per column: floats are float64, ``index`` and ``group_ids`` int32, other integers int64."""
    import numpy as np

    arrays = {}
    for name, values in columns.items():
        if name in _FLOATS:
            array = np.array(values, dtype=np.float64)
        elif name in ("index", "group_ids"):
            array = np.array(values, dtype=np.int32)
        elif name == "name" and any(isinstance(value, str) for value in values):
            array = np.array([str(value) for value in values])
        else:
            array = np.array(values, dtype=np.int64)
        arrays[name] = array.reshape(-1, _WIDTHS[name]) if name in _WIDTHS else array
    return arrays


def columns_from_arrays(arrays: Mapping[str, ArrayLike]) -> dict[str, list[Any]]:
    """Returns a list per array; arrays that are not fields of boxes are ignored.

    Raises:
        ValueError: An array is missing.
    """
    import numpy as np

    missing = [name for name in _COLUMNS if name not in arrays]
    if missing:
        raise ValueError(f"{', '.join(missing)} is missing among {', '.join(arrays)}; give an array per field of the boxes")
    columns: dict[str, list[Any]] = {name: np.asarray(arrays[name]).tolist() for name in _COLUMNS}
    columns["occluded"] = [int(level) for level in columns["occluded"]]
    return columns
