"""Drawing of targets on images."""

from __future__ import annotations

import warnings
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, Optional, TypeVar, Union

from opendr import _opendr
from opendr._show import show_image
from opendr.engine._checks import names_by_index
from opendr.engine._equality import is_array
from opendr.engine.data import Image
from opendr.engine.target import BaseTarget, BoundingBoxList, Pose, PoseList, TrackingAnnotationList

if TYPE_CHECKING:
    from numpy.typing import NDArray

#: OpenCV's image, ``[height, width, 3]`` BGR uint8, which is drawn on in place, or an :class:`Image`, which is copied.
ImageType = TypeVar("ImageType", "NDArray[Any]", Image)
ClassNames = Union[Sequence[str], Mapping[int, str]]


def draw_bounding_boxes(
    img: ImageType,
    bounding_boxes: Union[BoundingBoxList, TrackingAnnotationList],
    class_names: Optional[ClassNames] = None,
    show: bool = False,
    line_thickness: Optional[int] = None,
) -> ImageType:
    """Draws boxes with their class, score, landmarks and mask.

    Args:
        img: OpenCV's image, drawn on in place, or an :class:`Image`.
        bounding_boxes: The boxes.
        class_names: Names of the class indices, by index; the boxes' own names when left out.
        show: Opens a window and waits for a key; without OpenCV or a display, writes a file and prints its path.
        line_thickness: No effect: lines and letters follow the image's size.

    Returns:
        ``img`` itself for OpenCV's image, else a new :class:`Image`.

    Raises:
        TypeError: An argument is of another type.
        ValueError: The image cannot be drawn on.
    """
    if not isinstance(bounding_boxes, (BoundingBoxList, TrackingAnnotationList)):
        raise TypeError(f"bounding_boxes should be a BoundingBoxList, not {bounding_boxes!r:.200}")
    if line_thickness is not None:
        text = "draw_bounding_boxes: line_thickness has no effect: lines and letters follow the image's size"
        warnings.warn(text, UserWarning, stacklevel=2)
    drawn = _drawn(img, bounding_boxes, class_names)
    if show:
        show_image(drawn if isinstance(drawn, Image) else _image_from_opencv(drawn))
    return drawn


def draw(img: ImageType, pose: Union[Pose, PoseList]) -> ImageType:
    """Draws the joints and bones of a person, or of several.

    Args:
        img: OpenCV's image, drawn on in place, or an :class:`Image`.
        pose: The person.

    Returns:
        ``img`` itself for OpenCV's image, else a new :class:`Image`.

    Raises:
        TypeError: An argument is of another type.
        ValueError: The image cannot be drawn on.
    """
    if not isinstance(pose, (Pose, PoseList)):
        raise TypeError(f"pose should be a Pose, not {pose!r:.200}")
    return _drawn(img, pose, None)


def draw_target(image: ImageType, target: BaseTarget, class_names: Optional[ClassNames] = None) -> ImageType:
    """Draws a target of any type; types that cannot be drawn leave the image unchanged.

    Args:
        image: OpenCV's image, drawn on in place, or an :class:`Image`.
        target: The target.
        class_names: Names of the class indices, by index; the target's own names when left out.

    Returns:
        ``image`` itself for OpenCV's image, else a new :class:`Image`.

    Raises:
        TypeError: An argument is of another type.
        ValueError: The image cannot be drawn on.
    """
    if not isinstance(target, BaseTarget):
        raise TypeError(f"target should be a target, e.g. a BoundingBoxList, not {target!r:.200}")
    return _drawn(image, target, class_names)


def get_bbox(pose: Pose) -> tuple[int, int, int, int]:
    """Returns the smallest box of integer pixels around the detected joints, the same as OpenCV's ``boundingRect``.

    Returns:
        ``(left, top, width, height)`` in pixels; all 0 when no joint is detected.
    """
    import numpy as np

    detected = np.floor(pose.data[(pose.data >= 0).all(axis=1)]).astype(int)
    if len(detected) == 0:
        return (0, 0, 0, 0)
    left, top = detected.min(axis=0).tolist()
    right, bottom = detected.max(axis=0).tolist()
    return (left, top, right - left + 1, bottom - top + 1)


def _drawn(image: ImageType, target: BaseTarget, class_names: Optional[ClassNames]) -> ImageType:
    names = None if class_names is None else _list_of_names(class_names)
    if isinstance(image, Image):
        return _opendr.draw(image, target, names)
    drawn = _opendr.draw(_image_from_opencv(image), target, names)
    image[:, :, :3] = drawn.data[::-1].transpose(1, 2, 0)
    return image


def _image_from_opencv(image: NDArray[Any]) -> Image:
    if not is_array(image):
        raise TypeError(f"an image is OpenCV's array [height, width, 3] or an Image, not {image!r:.200}")
    if image.ndim != 3 or image.shape[2] not in (3, 4) or image.dtype != "uint8":
        raise ValueError(
            f"an array of {image.dtype} and shape {image.shape} cannot be drawn on; give OpenCV's uint8 "
            "[height, width, 3], or an Image"
        )
    if not image.flags.writeable:
        raise ValueError("the array is read-only; give a copy of it, or an Image")
    return Image(image[:, :, 2::-1].transpose(2, 0, 1), guess_format=False)


def _list_of_names(class_names: ClassNames) -> list[str]:
    if isinstance(class_names, Mapping):
        return names_by_index(class_names)
    if isinstance(class_names, str):
        raise TypeError(f"class_names should be a list of names, not {class_names!r}")
    return [str(name) for name in class_names]
