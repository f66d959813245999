"""The mask of an object."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Union

from opendr.engine._checks import Real, real, whole

#: Polygons ``[x0, y0, x1, y1, ...]`` in pixels, or COCO's run lengths ``{"size": [height, width], "counts": ...}``.
Segmentation = Union[list[list[float]], dict[str, Any]]


def segmentation_of(value: Union[Segmentation, Sequence[Sequence[Real]]]) -> Segmentation:
    """Returns ``value`` as plain Python objects: lists of floats, or a dictionary whose ``counts`` are a str or a list of ints.

    Raises:
        TypeError: The value is not a segmentation.
        ValueError: A number is not finite, or the dictionary lacks a key.
    """
    if isinstance(value, dict):
        try:
            height, width = (whole(side, "size") for side in value["size"])
            counts = value["counts"]
        except (KeyError, ValueError):
            raise ValueError(
                f"a segmentation by runs has 'size' [height, width] and 'counts', not {value!r:.200}"
            ) from None
        if isinstance(counts, bytes):
            counts = counts.decode("ascii", "replace")
        if not isinstance(counts, str):
            counts = [whole(run, "a run in counts") for run in counts]
        return {"size": [height, width], "counts": counts}
    if isinstance(value, (str, bytes)):
        raise TypeError(f"a segmentation is a list of polygons or a dictionary of runs, not {value!r:.200}")
    return [[real(number, "a polygon's coordinate") for number in polygon] for polygon in value]
