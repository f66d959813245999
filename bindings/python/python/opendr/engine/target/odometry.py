"""The pose of a moving camera."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, ClassVar, Optional, SupportsIndex

from opendr.engine._checks import Real, reals, whole
from opendr.engine.target._table import Column, Table, floats
from opendr.engine.target.base_target import Target

if TYPE_CHECKING:
    from numpy.typing import NDArray


class Odometry(Target):
    """The pose of a camera in the frame of its first image: x to the right, y down, z ahead; ``data`` is ``position``.

    Args:
        position: x, y and z in metres; None when the pose is unknown, because tracking begins or is lost.
        orientation: Quaternion x, y, z, w; None when the pose is unknown.
        num_landmarks: Number of landmarks that agree with the pose.

    Raises:
        TypeError: A value is not a number.
        ValueError: A number is not finite, or only one of position and orientation is given.
    """

    _fields: ClassVar[tuple[str, ...]] = ("position", "orientation", "num_landmarks")

    def __init__(
        self,
        position: Optional[Sequence[Real]] = None,
        orientation: Optional[Sequence[Real]] = None,
        num_landmarks: SupportsIndex = 0,
    ) -> None:
        if (position is None) != (orientation is None):
            raise ValueError("a pose has a position and an orientation; give both or none")
        self.position: Optional[tuple[float, ...]] = None if position is None else reals(position, 3, "position")
        self.orientation: Optional[tuple[float, ...]] = None if orientation is None else reals(orientation, 4, "orientation")
        self.num_landmarks = whole(num_landmarks, "num_landmarks")

    @property
    def data(self) -> Optional[tuple[float, ...]]:
        """x, y and z in metres; None when the pose is unknown."""
        return self.position

    @data.setter
    def data(self, data: Optional[Sequence[Real]]) -> None:
        self.position = None if data is None else reals(data, 3, "data")

    @property
    def matrix(self) -> NDArray[Any]:
        """The pose as a ``[4, 4]`` matrix, ``world_from_camera``, float64.

        Raises:
            ValueError: The pose is unknown.
        """
        import numpy as np

        if self.position is None or self.orientation is None:
            raise ValueError("the pose is unknown, because tracking begins or is lost; check that position is not None")
        x, y, z, w = np.array(self.orientation) / np.linalg.norm(self.orientation)
        matrix = np.eye(4)
        matrix[:3, :3] = [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ]
        matrix[:3, 3] = self.position
        return matrix

    def _is_drawn(self) -> bool:
        return True

    def _table(self) -> Table:
        position = self.position or (None,) * 3
        orientation = self.orientation or (None,) * 4
        names = ("x", "y", "z", "qx", "qy", "qz", "qw")
        return {
            **{name: floats([number]) for name, number in zip(names, (*position, *orientation))},
            "num_landmarks": Column([self.num_landmarks], "int64"),
        }
