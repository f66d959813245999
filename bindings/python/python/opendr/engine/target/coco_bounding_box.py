"""Boxes with the outline of their object."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any, ClassVar, SupportsIndex, Union

from opendr.engine._checks import Real, real, whole
from opendr.engine.target.bounding_box import BoundingBox

#: Polygons ``[x0, y0, x1, y1, ...]`` in pixels, or COCO's run lengths ``{"size": [height, width], "counts": ...}``.
Segmentation = Union[list[list[float]], dict[str, Any]]


class CocoBoundingBox(BoundingBox):
    """A box with the outline of its object, as COCO writes it.

    Args:
        name: Class index, or label.
        left: Left edge, pixels.
        top: Upper edge, pixels.
        width: Pixels to the right edge.
        height: Pixels to the lower edge.
        segmentation: Polygons ``[x0, y0, x1, y1, ...]`` in pixels, or run lengths
            ``{"size": [height, width], "counts": ...}`` (packed text or a list of runs).
        area: Square pixels of the object.
        iscrowd: 1 for a crowd: detections inside count neither as right nor as wrong.
        score: Confidence in [0, 1].

    Raises:
        TypeError: Something is of another type.
        ValueError: A number is NaN or infinite.
    """

    _fields: ClassVar[tuple[str, ...]] = (*BoundingBox._fields, "segmentation", "area", "iscrowd")

    def __init__(
        self,
        name: Union[int, str, SupportsIndex],
        left: Real,
        top: Real,
        width: Real,
        height: Real,
        segmentation: Union[Segmentation, Sequence[Sequence[Real]], None] = None,
        area: Real = 0,
        iscrowd: SupportsIndex = 0,
        score: Real = 0,
        *,
        class_name: str = "",
        landmarks: Iterable[Sequence[Real]] = (),
    ) -> None:
        super().__init__(name, left, top, width, height, score, class_name=class_name, landmarks=landmarks)
        self.segmentation: Segmentation = segmentation_of([] if segmentation is None else segmentation)
        self.area: float = real(area, "area")
        self.iscrowd: int = whole(iscrowd, "iscrowd")


def segmentation_of(value: Union[Segmentation, Sequence[Sequence[Real]]]) -> Segmentation:
    """``value`` in plain Python: lists of floats, or a dictionary whose ``counts`` are text or a list of ints.

    Raises:
        TypeError: It is no segmentation.
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
