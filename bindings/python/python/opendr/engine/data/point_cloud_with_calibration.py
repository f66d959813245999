"""A point cloud with the calibration of lidar and camera."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, ClassVar, Optional, SupportsIndex, Union

from opendr.engine._checks import whole
from opendr.engine.data.calibration import Calibration
from opendr.engine.data.point_cloud import PointCloud

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import ArrayLike


class PointCloudWithCalibration(PointCloud):
    """A cloud with the calibration between lidar and camera.

    Args:
        data: ``[points, channels]`` as for :class:`PointCloud`.
        calib: KITTI's dictionary of ``P2``, ``R0_rect``, ``Tr_velo_to_cam`` and other matrices, or a
            :class:`Calibration`.
        image_shape: ``[height, width]`` of the camera's image, pixels.

    Raises:
        TypeError: An argument is of another type.
        ValueError: A shape does not fit.
    """

    _fields: ClassVar[tuple[str, ...]] = ("data", "calib", "image_shape")

    def __init__(
        self,
        data: Optional[ArrayLike] = None,
        calib: Union[Mapping[str, Any], Calibration, None] = None,
        image_shape: Optional[Sequence[SupportsIndex]] = None,
    ) -> None:
        super().__init__(data)
        if calib is not None and not isinstance(calib, (Mapping, Calibration)):
            raise TypeError(f"calib should be KITTI's dictionary or a Calibration, not {calib!r:.200}")
        #: KITTI's dictionary.
        self.calib: Optional[dict[str, Any]] = None
        if calib is not None:
            self.calib = calib.data if isinstance(calib, Calibration) else dict(calib)
        #: ``(height, width)`` of the camera's image, pixels.
        self.image_shape: Optional[tuple[int, int]] = None
        if image_shape is not None:
            height, width = (whole(side, "image_shape") for side in image_shape)
            self.image_shape = (height, width)

    @property
    def calibration(self) -> Optional[Calibration]:
        """The three matrices of ``calib``; None without a calibration.

        Raises:
            ValueError: A matrix is missing, or has another shape.
        """
        return None if self.calib is None else Calibration.from_dict(self.calib)

    def __str__(self) -> str:
        return f"{super().__str__()}\nCalib:{self.calib}"
