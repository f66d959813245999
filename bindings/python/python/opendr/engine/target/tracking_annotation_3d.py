"""Boxes in space with an identity."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Any, ClassVar, Optional, SupportsIndex, Union

from opendr import _opendr
from opendr.engine._checks import Real, whole
from opendr.engine.target._kitti import arrays_from_columns, columns_from_arrays
from opendr.engine.target.bounding_box_3d import BoundingBox3D, BoundingBox3DList
from opendr.engine.target.target_list import NamedTargetList

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray


class TrackingAnnotation3D(BoundingBox3D):
    """A box of one object that is followed through space, in the camera frame of KITTI.

    Args:
        name: Class index, or label.
        truncated: How much of the object lies outside the picture, 0 to 1; -1 when it is not known.
        occluded: 0 visible, 1 partly hidden, 2 mostly hidden, 3 or -1 not known.
        alpha: Angle under which the object is seen, radians in [-pi, pi].
        bbox2d: The object in the picture, corners ``[x0, y0, x1, y1]`` in pixels.
        dimensions: Length, height and width in metres.
        location: x, y, z of the middle of its floor, metres.
        rotation_y: Turn about the vertical axis, radians in [-pi, pi].
        id: The object's number, the same at every time; -1 when it is not known.
        score: Confidence.
        frame: Number of the cloud in its recording; -1 when it has none.
        class_name: The label of a class index, where the learner knows it.

    Raises:
        TypeError: Something is of another type.
        ValueError: A number is not finite, or there are too many or too few.
    """

    _fields: ClassVar[tuple[str, ...]] = (*BoundingBox3D._fields, "id", "frame")

    def __init__(
        self,
        name: Union[int, str, SupportsIndex],
        truncated: Real,
        occluded: SupportsIndex,
        alpha: Real,
        bbox2d: ArrayLike,
        dimensions: ArrayLike,
        location: ArrayLike,
        rotation_y: Real,
        id: SupportsIndex,
        score: Real = 0,
        frame: SupportsIndex = -1,
        *,
        class_name: str = "",
    ) -> None:
        super().__init__(
            *(name, truncated, occluded, alpha, bbox2d, dimensions, location, rotation_y, score),
            class_name=class_name,
        )
        self._data |= {"id": whole(id, "id"), "frame": whole(frame, "frame")}

    @property
    def id(self) -> int:
        """The object's number."""
        return int(self._data["id"])

    @property
    def frame(self) -> int:
        """Number of the cloud in its recording; -1 when it has none."""
        return int(self._data["frame"])

    def kitti(self, with_tracking_info: bool = True) -> dict[str, NDArray[Any]]:
        """The object as arrays of one element, as :meth:`BoundingBox3D.kitti` without ``index`` and ``group_ids``.

        Args:
            with_tracking_info: Adds ``id`` and ``frame``.
        """
        return arrays_from_columns(_opendr.kitti(self, with_tracking_info))

    def bounding_box_3d(self) -> BoundingBox3D:
        """The box without its identity."""
        fields = {name: value for name, value in self._data.items() if name not in ("id", "frame")}
        return self._with_header_in(BoundingBox3D(**fields, score=self.confidence, class_name=self.class_name))


class TrackingAnnotation3DList(NamedTargetList[TrackingAnnotation3D]):
    """The followed objects of one cloud, or of a whole recording.

    Args:
        annotations_3d: The objects.
        classes: What class indices mean: ``classes[0]`` is class 0.

    Raises:
        TypeError: Something else than a :class:`TrackingAnnotation3D` is among them.
    """

    _item = TrackingAnnotation3D

    def __init__(
        self, annotations_3d: Optional[Iterable[TrackingAnnotation3D]] = None, *, classes: Iterable[str] = ()
    ) -> None:
        super().__init__(annotations_3d, classes=classes)

    def add_annotation(self, annotation: TrackingAnnotation3D) -> None:
        """Adds an object at the end.

        Raises:
            TypeError: It is no :class:`TrackingAnnotation3D`.
        """
        self.append(annotation)

    def kitti(self, with_tracking_info: bool = True) -> dict[str, NDArray[Any]]:
        """The objects, one array per field, as :meth:`TrackingAnnotation3D.kitti`."""
        return arrays_from_columns(_opendr.kitti(self, with_tracking_info))

    @staticmethod
    def from_kitti(
        boxes_kitti: Mapping[str, ArrayLike],
        ids: Iterable[SupportsIndex],
        frames: Optional[Iterable[SupportsIndex]] = None,
    ) -> TrackingAnnotation3DList:
        """Reads what :meth:`kitti` gives.

        Args:
            boxes_kitti: An array per field.
            ids: The object's number of each box.
            frames: The cloud's number of each box; none has one when it is left out.

        Raises:
            ValueError: An array is missing, or they differ in length.
        """
        id_list = [whole(id, "an id") for id in ids]
        frame_list = None if frames is None else [whole(frame, "a frame") for frame in frames]
        tracks: TrackingAnnotation3DList = _opendr.from_kitti(columns_from_arrays(boxes_kitti), id_list, frame_list)
        return tracks

    def bounding_box_3d_list(self) -> BoundingBox3DList:
        """The boxes without their identities."""
        boxes = BoundingBox3DList([track.bounding_box_3d() for track in self.data], classes=self.classes)
        return self._with_header_in(boxes)
