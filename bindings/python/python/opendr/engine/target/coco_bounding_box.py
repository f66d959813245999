"""Bounding boxes with a mask."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import ClassVar, SupportsIndex, Union

from opendr.engine._checks import Real, real, whole
from opendr.engine.target._segmentation import Segmentation, segmentation_of
from opendr.engine.target.bounding_box import BoundingBox


class CocoBoundingBox(BoundingBox):
    """A box with the mask of its object, in COCO's form.

    Args:
        name: Class index, or label.
        left: Left edge, pixels.
        top: Upper edge, pixels.
        width: Pixels to the right edge.
        height: Pixels to the lower edge.
        segmentation: Polygons ``[x0, y0, x1, y1, ...]`` in pixels, or run lengths
            ``{"size": [height, width], "counts": ...}`` (compressed str or a list of runs).
        area: Area of the object in square pixels.
        iscrowd: 1 for a crowd: detections inside are neither true nor false positives.
        score: Confidence in [0, 1].

    Raises:
        TypeError: An argument is of another type.
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
