"""Bounding boxes in an image."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Any, ClassVar, Optional, SupportsIndex, Union

from opendr import _opendr
from opendr.engine._checks import Real, class_name_or_index, real, reals, text, whole
from opendr.engine.target._coco import boxes_from_entries, entries_from_boxes
from opendr.engine.target._table import Table, box_columns
from opendr.engine.target.base_target import Target
from opendr.engine.target.target_list import NamedTargetList

if TYPE_CHECKING:
    import numpy as np
    import supervision
    from numpy.typing import NDArray


class BoundingBox(Target):
    """A box in an image: top-left corner and size in pixels.

    Args:
        name: Class index, or label.
        left: Left edge, pixels.
        top: Upper edge, pixels.
        width: Pixels to the right edge.
        height: Pixels to the lower edge.
        score: Confidence in [0, 1].
        class_name: Name of the class index, for reading, where the learner has one; ``classes`` of lists has the names
            of all class indices.
        landmarks: Points of the object (eyes, nose, corners of the mouth of a face), ``[x, y]`` in pixels.

    Raises:
        TypeError: A coordinate is not a number, or the name neither int nor str.
        ValueError: A number is NaN or infinite.
    """

    _fields: ClassVar[tuple[str, ...]] = (
        *("name", "left", "top", "width", "height", "confidence"),
        *("class_name", "landmarks"),
    )

    def __init__(
        self,
        name: Union[int, str, SupportsIndex],
        left: Real,
        top: Real,
        width: Real,
        height: Real,
        score: Real = 0,
        *,
        class_name: str = "",
        landmarks: Iterable[Sequence[Real]] = (),
    ) -> None:
        self.name: Union[int, str] = class_name_or_index(name)
        self.left: float = real(left, "left")
        self.top: float = real(top, "top")
        self.width: float = real(width, "width")
        self.height: float = real(height, "height")
        self._confidence = real(score, "score")
        self.class_name: str = text(class_name, "class_name")
        self.landmarks: list[tuple[float, ...]] = [reals(point, 2, "a landmark") for point in landmarks]

    def mot(self, with_confidence: bool = True, frame: int = -1) -> NDArray[np.float32]:
        """Returns ``[frame, left, top, width, height, confidence]``, float32; ``confidence`` only ``with_confidence``."""
        import numpy as np

        return np.array(_opendr.mot(self, with_confidence, frame)[0], dtype=np.float32)

    def coco(self, with_confidence: bool = True) -> dict[str, Any]:
        """Returns the box as an entry of a COCO file: ``bbox``, ``category_id``, ``area`` in square pixels, and, only
        ``with_confidence``, ``confidence``."""
        return entries_from_boxes(self, with_confidence)[0]


class BoundingBoxList(NamedTargetList[BoundingBox]):
    """The boxes of one image, in descending order of score.

    Args:
        boxes: The boxes.
        image_id: The image's id in its data set; -1 when it has none.
        classes: Names of the class indices: ``classes[0]`` is class 0.

    Raises:
        TypeError: An item is not a :class:`BoundingBox`.
    """

    _item = BoundingBox
    _fields: ClassVar[tuple[str, ...]] = ("data", "classes", "image_id")

    def __init__(
        self,
        boxes: Optional[Iterable[BoundingBox]] = None,
        image_id: SupportsIndex = -1,
        *,
        classes: Iterable[str] = (),
    ) -> None:
        super().__init__(boxes, classes=classes)
        self.image_id: int = whole(image_id, "image_id")

    def add_box(self, box: BoundingBox) -> None:
        """Adds a box at the end.

        Raises:
            TypeError: The item is not a :class:`BoundingBox`.
        """
        self.append(box)

    def mot(self, with_confidence: bool = True, frame: int = -1) -> NDArray[np.float32]:
        """Returns ``[boxes, 6]`` (``[boxes, 5]`` without confidence), float32; rows as of :meth:`BoundingBox.mot`."""
        import numpy as np

        rows = _opendr.mot(self, with_confidence, frame)
        return np.array(rows, dtype=np.float32).reshape(-1, 6 if with_confidence else 5)

    def coco(self, with_confidence: bool = True) -> list[dict[str, Any]]:
        """Returns an entry of a COCO file per box, each with ``image_id`` where the list has one."""
        return entries_from_boxes(self, with_confidence)

    @staticmethod
    def from_coco(boxes_coco: Iterable[dict[str, Any]], image_id: SupportsIndex = 0) -> BoundingBoxList:
        """Returns the boxes of entries of a COCO file; entries with a segmentation become ``CocoBoundingBox``.

        Args:
            boxes_coco: Dictionaries with ``bbox``, ``category_id`` and, optionally, ``area``, ``segmentation``,
                ``iscrowd`` and ``confidence`` (or ``score``).
            image_id: The image's id.

        Raises:
            ValueError: A dictionary is not a COCO entry.
        """
        return boxes_from_entries(boxes_coco, whole(image_id, "image_id"))

    def to_supervision(self, image_size: Optional[tuple[int, int]] = None) -> supervision.Detections:
        """Returns the boxes as ``supervision.Detections``, with their masks where one of them has a mask; a box without is empty in
        ``mask``.

        Args:
            image_size: Height and width of the image, for masks that are polygons.

        Raises:
            ImportError: The package supervision is not installed.
            opendr.InvalidInput: The masks are polygons, and ``image_size`` is missing; or they have different sizes.
        """
        from opendr.engine.target._supervision import detections

        return detections(self, image_size)

    def _is_drawn(self) -> bool:
        return True

    def _table(self) -> Table:
        return box_columns(self.data, self.classes)
