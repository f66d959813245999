"""Calibration of a lidar and a camera in KITTI's form."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, ClassVar

from opendr.engine._arrays import array_of
from opendr.engine.data.data import Data

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import ArrayLike, NDArray


class Calibration(Data):
    """The calibration of a lidar and a camera: transformation from lidar to camera frame, and projection to pixels.

    Args:
        p2: ``[3, 4]``, projection of the rectified camera frame into the left colour image (KITTI's ``P2``).
        r0_rect: ``[3, 3]``, rectifying rotation (``R0_rect``).
        tr_velo_to_cam: ``[3, 4]``, from lidar to camera frame, metres (``Tr_velo_to_cam``).

    Matrices of 4 rows or columns whose last ones are those of the identity are accepted too; all are float64.

    Raises:
        TypeError: A matrix has elements that are not numbers.
        ValueError: A matrix has another shape, or a number is not finite.
    """

    _fields: ClassVar[tuple[str, ...]] = ("p2", "r0_rect", "tr_velo_to_cam")

    def __init__(self, p2: ArrayLike, r0_rect: ArrayLike, tr_velo_to_cam: ArrayLike) -> None:
        super().__init__()
        self.p2: NDArray[np.float64] = _matrix(p2, 4, "P2")
        self.r0_rect: NDArray[np.float64] = _matrix(r0_rect, 3, "R0_rect")
        self.tr_velo_to_cam: NDArray[np.float64] = _matrix(tr_velo_to_cam, 4, "Tr_velo_to_cam")

    @classmethod
    def from_dict(cls, matrices: Mapping[str, ArrayLike]) -> Calibration:
        """Reads KITTI's dictionary of ``P2``, ``R0_rect`` and ``Tr_velo_to_cam``; other keys are ignored.

        Raises:
            ValueError: A matrix is missing, or has another shape.
        """
        missing = [name for name in ("P2", "R0_rect", "Tr_velo_to_cam") if name not in matrices]
        if missing:
            raise ValueError(f"{', '.join(missing)} is missing among {', '.join(matrices)}; give KITTI's three matrices")
        return cls(matrices["P2"], matrices["R0_rect"], matrices["Tr_velo_to_cam"])

    @property
    def data(self) -> dict[str, NDArray[np.float64]]:
        """KITTI's dictionary of the three matrices."""
        return {"P2": self.p2, "R0_rect": self.r0_rect, "Tr_velo_to_cam": self.tr_velo_to_cam}

    @data.setter
    def data(self, data: Mapping[str, ArrayLike]) -> None:
        read = self.from_dict(data)
        self.p2, self.r0_rect, self.tr_velo_to_cam = read.p2, read.r0_rect, read.tr_velo_to_cam

    def numpy(self) -> NDArray[np.float64]:
        """Returns the matrix ``[3, 4]`` from points in the lidar frame, ``[x, y, z, 1]`` in metres, to pixels times depth."""
        import numpy as np

        rect, velo = np.eye(4), np.eye(4)
        rect[:3, :3], velo[:3] = self.r0_rect, self.tr_velo_to_cam
        pixels: NDArray[np.float64] = self.p2 @ rect @ velo
        return pixels

    def __str__(self) -> str:
        return str(self.data)


def _matrix(values: ArrayLike, columns: int, name: str) -> NDArray[np.float64]:
    import numpy as np

    matrix = array_of(values, "float64", name)
    if matrix.ndim == 2 and matrix.shape in {(3, columns), (4, columns), (4, 4)}:
        unit = np.eye(4)
        extra_rows, extra_columns = matrix[3:], matrix[:3, columns:]
        fits = np.array_equal(extra_rows, unit[3 : matrix.shape[0], : matrix.shape[1]])
        if fits and not extra_columns.any() and np.isfinite(matrix).all():
            return matrix[:3, :columns]
    raise ValueError(f"{name} of shape {matrix.shape} should be 3 rows of {columns} finite numbers")
