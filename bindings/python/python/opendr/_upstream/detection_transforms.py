"""OpenDR's transforms of samples with boxes."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from opendr.engine.data import Image
    from opendr.engine.target import BoundingBoxList


class BoundingBoxListToNumpyArray:
    """Converts boxes to an array ``[boxes, 6]``: left, top, right, bottom, score, class index."""

    def __call__(self, bbox_list: BoundingBoxList) -> NDArray[Any]:
        import numpy as np

        rows = [
            [box.left, box.top, box.left + box.width, box.top + box.height, box.confidence, box.name]
            for box in bbox_list.data
        ]
        return np.array(rows, dtype=float).reshape(-1, 6)


class ImageToNumpyArrayTransform:
    """Converts an image to an array ``[channels, height, width]``."""

    def __call__(self, img: Image) -> NDArray[Any]:
        return img.data


class ResizeImageAndBoxesTransform:
    """Resizes an image ``[height, width, channels]`` and its boxes, rows of left, top, right, bottom and more.

    Args:
        w: The new width, pixels.
        h: The new height, pixels.

    Raises:
        ValueError: A side is below 1.
    """

    def __init__(self, w: int, h: int) -> None:
        if w < 1 or h < 1:
            raise ValueError(f"the size {w} x {h} is invalid; give 1 or more")
        self.w, self.h = w, h

    def __call__(self, img: NDArray[Any], labels: NDArray[Any]) -> tuple[NDArray[Any], NDArray[Any]]:
        import numpy as np

        height, width = img.shape[:2]
        resized = _resized(_resized(img, self.h, 0), self.w, 1)
        boxes = np.array(labels, dtype=float)
        boxes[:, [0, 2]] *= self.w / width
        boxes[:, [1, 3]] *= self.h / height
        return (np.rint(resized) if img.dtype.kind in "ui" else resized).astype(img.dtype), boxes


def _resized(pixels: NDArray[Any], size: int, axis: int) -> NDArray[Any]:
    """Interpolates linearly along an axis, with pixel centres at half-integers as in OpenCV."""
    import numpy as np

    old = pixels.shape[axis]
    at = np.clip((np.arange(size) + 0.5) * old / size - 0.5, 0, old - 1)
    low = np.floor(at).astype(int)
    shape = [1] * pixels.ndim
    shape[axis] = size
    weight = (at - low).reshape(shape)
    first, second = np.take(pixels, low, axis), np.take(pixels, np.minimum(low + 1, old - 1), axis)
    between: NDArray[Any] = first * (1 - weight) + second * weight
    return between
