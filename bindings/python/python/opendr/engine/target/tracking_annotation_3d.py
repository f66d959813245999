"""3D tracks: 3D bounding boxes with an identity."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Any, ClassVar, Optional, SupportsIndex, Union

from opendr import _opendr
from opendr.engine._checks import Real, whole
from opendr.engine.target._kitti import arrays_from_columns, columns_from_arrays
from opendr.engine.target._table import Table, box_3d_columns, ints
from opendr.engine.target.bounding_box_3d import BoundingBox3D, BoundingBox3DList
from opendr.engine.target.target_list import NamedTargetList

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray


class TrackingAnnotation3D(BoundingBox3D):
    """The 3D box of a tracked object at one time, in the camera frame of KITTI.

    Args:
        name: Class index, or label.
        truncated: Fraction of the object outside the image, 0 to 1; -1 when unknown.
        occluded: 0 visible, 1 partly occluded, 2 largely occluded, 3 or -1 unknown.
        alpha: Observation angle of the object, radians in [-pi, pi].
        bbox2d: The object in the image, corners ``[x0, y0, x1, y1]`` in pixels.
        dimensions: Length, height and width in metres.
        location: x, y, z of the centre of the bottom face, metres.
        rotation_y: Rotation about the vertical axis, radians in [-pi, pi].
        id: Identity of the object, the same at every time; -1 when unknown.
        score: Confidence.
        frame: Index of the cloud in its recording; -1 when it has none.
        class_name: Name of the class index, where the learner has one.

    Raises:
        TypeError: An argument is of another type.
        ValueError: A number is not finite, or an array has another length.
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
        """Identity of the object."""
        return int(self._data["id"])

    @property
    def frame(self) -> int:
        """Index of the cloud in its recording; -1 when it has none."""
        return int(self._data["frame"])

    def kitti(self, with_tracking_info: bool = True) -> dict[str, NDArray[Any]]:
        """Returns the object as arrays of one element, those of :meth:`BoundingBox3D.kitti` without ``index`` and
        ``group_ids``.

        Args:
            with_tracking_info: Adds ``id`` and ``frame``.
        """
        return arrays_from_columns(_opendr.kitti(self, with_tracking_info))

    def bounding_box_3d(self) -> BoundingBox3D:
        """Returns the box without its identity."""
        fields = {name: value for name, value in self._data.items() if name not in ("id", "frame")}
        return self._with_header_in(BoundingBox3D(**fields, score=self.confidence, class_name=self.class_name))


class TrackingAnnotation3DList(NamedTargetList[TrackingAnnotation3D]):
    """The tracked objects of one point cloud, or of a whole recording.

    Args:
        annotations_3d: The objects.
        classes: Names of the class indices: ``classes[0]`` is class 0.

    Raises:
        TypeError: An item is not a :class:`TrackingAnnotation3D`.
    """

    _item = TrackingAnnotation3D

    def __init__(
        self, annotations_3d: Optional[Iterable[TrackingAnnotation3D]] = None, *, classes: Iterable[str] = ()
    ) -> None:
        super().__init__(annotations_3d, classes=classes)

    def add_annotation(self, annotation: TrackingAnnotation3D) -> None:
        """Adds an object at the end.

        Raises:
            TypeError: The item is not a :class:`TrackingAnnotation3D`.
        """
        self.append(annotation)

    def kitti(self, with_tracking_info: bool = True) -> dict[str, NDArray[Any]]:
        """Returns the objects as one array per field, those of :meth:`TrackingAnnotation3D.kitti`."""
        return arrays_from_columns(_opendr.kitti(self, with_tracking_info))

    @staticmethod
    def from_kitti(
        boxes_kitti: Mapping[str, ArrayLike],
        ids: Iterable[SupportsIndex],
        frames: Optional[Iterable[SupportsIndex]] = None,
    ) -> TrackingAnnotation3DList:
        """Returns the objects of the arrays of :meth:`kitti`.

        Args:
            boxes_kitti: An array per field.
            ids: Identity of each object.
            frames: Index of the cloud of each object; by default none has one.

        Raises:
            ValueError: An array is missing, or their lengths differ.
        """
        id_list = [whole(id, "an id") for id in ids]
        frame_list = None if frames is None else [whole(frame, "a frame") for frame in frames]
        tracks: TrackingAnnotation3DList = _opendr.from_kitti(columns_from_arrays(boxes_kitti), id_list, frame_list)
        return tracks

    def bounding_box_3d_list(self) -> BoundingBox3DList:
        """Returns the boxes without their identities."""
        boxes = BoundingBox3DList([track.bounding_box_3d() for track in self.data], classes=self.classes)
        return self._with_header_in(boxes)

    def _table(self) -> Table:
        identity = {name: ints(getattr(track, name) for track in self.data) for name in ("frame", "id")}
        return {**identity, **box_3d_columns(self.data, self.classes)}
