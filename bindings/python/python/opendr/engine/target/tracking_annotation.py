"""Tracks: bounding boxes with an identity."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, ClassVar, Optional, SupportsIndex, Union

from opendr import _opendr
from opendr.engine._checks import Real, class_name_or_index, real, reals, text, whole
from opendr.engine.target._segmentation import Segmentation, segmentation_of
from opendr.engine.target._table import Table, box_columns, ints
from opendr.engine.target.base_target import Target
from opendr.engine.target.bounding_box import BoundingBox, BoundingBoxList
from opendr.engine.target.coco_bounding_box import CocoBoundingBox
from opendr.engine.target.target_list import NamedTargetList

if TYPE_CHECKING:
    import numpy as np
    import supervision
    from numpy.typing import NDArray


class TrackingAnnotation(Target):
    """The box of a tracked object in one frame: top-left corner and size in pixels.

    Args:
        name: Class index, or label.
        left: Left edge, pixels.
        top: Upper edge, pixels.
        width: Pixels to the right edge.
        height: Pixels to the lower edge.
        id: Identity of the object, the same in every frame; -1 when unknown.
        score: Confidence in [0, 1].
        frame: Index of the frame in its video; -1 when it has none.
        class_name: Name of the class index, where the learner has one.
        landmarks: Points of the object, ``[x, y]`` in pixels.
        segmentation: Mask of the object as in :class:`CocoBoundingBox`; None when unknown.
        area: Area of the object in square pixels.
        iscrowd: 1 for a crowd.

    Raises:
        TypeError: A coordinate is not a number, an id is not an int, or the name is neither int nor str.
        ValueError: A number is NaN or infinite.
    """

    _fields: ClassVar[tuple[str, ...]] = (
        *("name", "left", "top", "width", "height", "id", "confidence", "frame"),
        *("class_name", "landmarks", "segmentation", "area", "iscrowd"),
    )

    def __init__(
        self,
        name: Union[int, str, SupportsIndex],
        left: Real,
        top: Real,
        width: Real,
        height: Real,
        id: SupportsIndex,
        score: Real = 0,
        frame: SupportsIndex = -1,
        *,
        class_name: str = "",
        landmarks: Iterable[Sequence[Real]] = (),
        segmentation: Union[Segmentation, Sequence[Sequence[Real]], None] = None,
        area: Real = 0,
        iscrowd: SupportsIndex = 0,
    ) -> None:
        self.name: Union[int, str] = class_name_or_index(name)
        self.left: float = real(left, "left")
        self.top: float = real(top, "top")
        self.width: float = real(width, "width")
        self.height: float = real(height, "height")
        self.id: int = whole(id, "id")
        self._confidence = real(score, "score")
        self.frame: int = whole(frame, "frame")
        self.class_name: str = text(class_name, "class_name")
        self.landmarks: list[tuple[float, ...]] = [reals(point, 2, "a landmark") for point in landmarks]
        self.segmentation: Optional[Segmentation] = None if segmentation is None else segmentation_of(segmentation)
        self.area: float = real(area, "area")
        self.iscrowd: int = whole(iscrowd, "iscrowd")

    def mot(self, with_confidence: bool = True) -> NDArray[np.float32]:
        """Returns ``[frame, id, left, top, width, height, confidence]``, float32; ``confidence`` only
        ``with_confidence``."""
        import numpy as np

        return np.array(_opendr.mot(self, with_confidence, self.frame)[0], dtype=np.float32)

    @staticmethod
    def from_mot(data: Sequence[Real]) -> TrackingAnnotation:
        """Reads ``[frame, id, left, top, width, height]``, optionally with a confidence (1 by default).

        The class is 0.

        Raises:
            ValueError: There are fewer than 6 or more than 10 numbers, or one is not finite.
        """
        return TrackingAnnotationList.from_mot([data])[0]

    def bounding_box(self) -> BoundingBox:
        """Returns the box without its identity; a :class:`CocoBoundingBox` when it has a mask."""
        place = (self.name, self.left, self.top, self.width, self.height)
        box: BoundingBox
        if self.segmentation is None:
            box = BoundingBox(*place, self.confidence, class_name=self.class_name, landmarks=self.landmarks)
        else:
            outline = (self.segmentation, self.area, self.iscrowd, self.confidence)
            box = CocoBoundingBox(*place, *outline, class_name=self.class_name, landmarks=self.landmarks)
        return self._with_header_in(box)


class TrackingAnnotationList(NamedTargetList[TrackingAnnotation]):
    """The tracked objects of one frame, or of a whole video.

    Args:
        annotations: The objects.
        classes: Names of the class indices: ``classes[0]`` is class 0.

    Raises:
        TypeError: An item is not a :class:`TrackingAnnotation`.
    """

    _item = TrackingAnnotation

    def __init__(
        self, annotations: Optional[Iterable[TrackingAnnotation]] = None, *, classes: Iterable[str] = ()
    ) -> None:
        super().__init__(annotations, classes=classes)

    def add_annotation(self, annotation: TrackingAnnotation) -> None:
        """Adds an object at the end.

        Raises:
            TypeError: The item is not a :class:`TrackingAnnotation`.
        """
        self.append(annotation)

    def mot(self, with_confidence: bool = True) -> NDArray[np.float32]:
        """Returns ``[objects, 7]`` (``[objects, 6]`` without confidence), float32; rows as of
        :meth:`TrackingAnnotation.mot`."""
        import numpy as np

        rows = _opendr.mot(self, with_confidence, -1)
        return np.array(rows, dtype=np.float32).reshape(-1, 7 if with_confidence else 6)

    @staticmethod
    def from_mot(data: Iterable[Sequence[Real]]) -> TrackingAnnotationList:
        """Reads rows in the form of :meth:`TrackingAnnotation.from_mot`, e.g. an array ``[objects, 7]``.

        Raises:
            TypeError: A row has values that are not numbers.
            ValueError: A row has another length, or a number that is not finite.
        """
        rows = [[real(number, "a number of a MOT row") for number in row] for row in data]
        tracks: TrackingAnnotationList = _opendr.from_mot(rows)
        return tracks

    def bounding_box_list(self) -> BoundingBoxList:
        """Returns the boxes without their identities."""
        boxes = BoundingBoxList([track.bounding_box() for track in self.data], classes=self.classes)
        return self._with_header_in(boxes)

    def to_supervision(self, image_size: Optional[tuple[int, int]] = None) -> supervision.Detections:
        """Returns the objects as ``supervision.Detections`` with ``tracker_id``; otherwise as
        :meth:`BoundingBoxList.to_supervision`.

        Raises:
            ImportError: The package supervision is not installed.
            opendr.InvalidInput: The masks are polygons, and ``image_size`` is missing; or they have different sizes.
        """
        from opendr.engine.target._supervision import detections

        return detections(self, image_size)

    def _is_drawn(self) -> bool:
        return True

    def _table(self) -> Table:
        identity = {name: ints(getattr(track, name) for track in self.data) for name in ("frame", "id")}
        return {**identity, **box_columns(self.data, self.classes)}
