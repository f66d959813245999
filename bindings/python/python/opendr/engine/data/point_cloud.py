"""Point clouds."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, ClassVar

from opendr.engine._arrays import array_of
from opendr.engine.data.array_data import ArrayData

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray


class PointCloud(ArrayData):
    """A point cloud ``[points, channels]``, float32: x, y, z in metres, then optionally reflectance and colours. A cloud
    may have no points. ``len`` and ``[]`` refer to points."""

    _axes: ClassVar[tuple[str, ...]] = ("points", "channels")
    _title: ClassVar[str] = "Point Cloud"

    def __len__(self) -> int:
        return len(self.data)

    def __getitem__(self, point: int) -> NDArray[Any]:
        return self.data[point]  # type: ignore[no-any-return]

    def __str__(self) -> str:
        return f"Points: {self.data}"

    def _checked(self, data: ArrayLike) -> NDArray[Any]:
        array = array_of(data, "float32", "a PointCloud")
        if array.ndim != 2 or array.shape[1] < 3:
            raise ValueError(
                f"a PointCloud of shape {array.shape} should have the axes [points, channels]; "
                "give x, y and z of each point first"
            )
        return array
