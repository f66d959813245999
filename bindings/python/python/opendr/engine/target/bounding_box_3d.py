"""3D bounding boxes."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Any, ClassVar, Optional, SupportsIndex, Union

from opendr import _opendr
from opendr.engine._checks import Real, class_name_or_index, real, reals, text, whole
from opendr.engine.target._kitti import arrays_from_columns, columns_from_arrays
from opendr.engine.target._table import Table, box_3d_columns
from opendr.engine.target.base_target import Target
from opendr.engine.target.target_list import NamedTargetList

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import ArrayLike, NDArray


class BoundingBox3D(Target):
    """A 3D box in the camera frame of KITTI: x right, y down, z forward.

    Args:
        name: Class index, or label.
        truncated: Fraction of the object outside the image, 0 to 1; -1 when unknown.
        occluded: 0 visible, 1 partly occluded, 2 largely occluded, 3 or -1 unknown.
        alpha: Observation angle of the object, radians in [-pi, pi].
        bbox2d: The object in the image, corners ``[x0, y0, x1, y1]`` in pixels.
        dimensions: Length, height and width in metres: OpenDR's order, not that of KITTI's files.
        location: x, y, z of the centre of the bottom face, metres.
        rotation_y: Rotation about the vertical axis, radians in [-pi, pi]; 0 faces along x.
        score: Confidence.
        class_name: Name of the class index, where the learner has one.

    Raises:
        TypeError: An argument is of another type.
        ValueError: A number is not finite, or an array has another length.
    """

    _fields: ClassVar[tuple[str, ...]] = (
        *("name", "truncated", "occluded", "alpha", "bbox2d", "dimensions", "location", "rotation_y"),
        *("confidence", "class_name"),
    )

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
        score: Real = 0,
        *,
        class_name: str = "",
    ) -> None:
        self._data = {
            "name": class_name_or_index(name),
            "truncated": real(truncated, "truncated"),
            "occluded": _level(occluded),
            "alpha": real(alpha, "alpha"),
            "bbox2d": _row(bbox2d, 4, "bbox2d"),
            "dimensions": _row(dimensions, 3, "dimensions"),
            "location": _row(location, 3, "location"),
            "rotation_y": real(rotation_y, "rotation_y"),
        }
        self._confidence = real(score, "score")
        self.class_name: str = text(class_name, "class_name")

    @property
    def name(self) -> Union[int, str]:
        """Class index, or label."""
        name: Union[int, str] = self._data["name"]
        return name

    @property
    def truncated(self) -> float:
        """Fraction of the object outside the image, 0 to 1; -1 when unknown."""
        return float(self._data["truncated"])

    @property
    def occluded(self) -> int:
        """0 visible, 1 partly occluded, 2 largely occluded, 3 or -1 unknown."""
        return int(self._data["occluded"])

    @property
    def alpha(self) -> float:
        """Observation angle of the object, radians."""
        return float(self._data["alpha"])

    @property
    def bbox2d(self) -> NDArray[np.float64]:
        """Corners ``[x0, y0, x1, y1]`` in the image, pixels."""
        bbox2d: NDArray[np.float64] = self._data["bbox2d"]
        return bbox2d

    @property
    def dimensions(self) -> NDArray[np.float64]:
        """Length, height and width, metres."""
        dimensions: NDArray[np.float64] = self._data["dimensions"]
        return dimensions

    @property
    def location(self) -> NDArray[np.float64]:
        """x, y, z of the centre of the bottom face, metres."""
        location: NDArray[np.float64] = self._data["location"]
        return location

    @property
    def rotation_y(self) -> float:
        """Rotation about the vertical axis, radians."""
        return float(self._data["rotation_y"])

    def kitti(self) -> dict[str, NDArray[Any]]:
        """Returns the box as arrays of one element: ``name``, ``truncated``, ``occluded``, ``alpha``, ``bbox`` ``[1, 4]``,
        ``dimensions`` ``[1, 3]``, ``location`` ``[1, 3]``, ``rotation_y``, ``score``, ``index``, ``group_ids``."""
        return arrays_from_columns(_opendr.kitti(self, False))


class BoundingBox3DList(NamedTargetList[BoundingBox3D]):
    """The 3D boxes of one point cloud or image.

    Args:
        bounding_boxes_3d: The boxes.
        classes: Names of the class indices: ``classes[0]`` is class 0.

    Raises:
        TypeError: An item is not a :class:`BoundingBox3D`.
    """

    _item = BoundingBox3D

    def __init__(
        self, bounding_boxes_3d: Optional[Iterable[BoundingBox3D]] = None, *, classes: Iterable[str] = ()
    ) -> None:
        super().__init__(bounding_boxes_3d, classes=classes)

    def add_box(self, box: BoundingBox3D) -> None:
        """Adds a box at the end.

        Raises:
            TypeError: The item is not a :class:`BoundingBox3D`.
        """
        self.append(box)

    def kitti(self) -> dict[str, NDArray[Any]]:
        """Returns the boxes as one array per field, those of :meth:`BoundingBox3D.kitti`.

        ``index`` numbers the boxes that are not ``DontCare`` and ends with a -1 for each box that is; it and
        ``group_ids`` are int32.
        """
        return arrays_from_columns(_opendr.kitti(self, False))

    @staticmethod
    def from_kitti(boxes_kitti: Mapping[str, ArrayLike]) -> BoundingBox3DList:
        """Returns the boxes of the arrays of :meth:`kitti`.

        Raises:
            ValueError: An array is missing, or their lengths differ.
        """
        boxes: BoundingBox3DList = _opendr.from_kitti(columns_from_arrays(boxes_kitti), None, None)
        return boxes

    def _table(self) -> Table:
        return box_3d_columns(self.data, self.classes)


def _level(occluded: Union[SupportsIndex, float]) -> int:
    # OpenDR's reader returns integers; some data sets write them as floats.
    if isinstance(occluded, float) and occluded.is_integer():
        return int(occluded)
    return whole(occluded, "occluded")  # type: ignore[arg-type]


def _row(values: Any, count: int, what: str) -> NDArray[np.float64]:
    import numpy as np

    return np.array(reals(values, count, what), dtype=np.float64)
