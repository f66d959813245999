"""Further drawing functions of OpenDR."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, Any, Optional, Union

from opendr._drawing import ClassNames, ImageType, draw_bounding_boxes, draw_target
from opendr.engine.data import Image
from opendr.engine.target import BoundingBox, BoundingBoxList, Heatmap

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

__all__ = ["draw", "draw_bounding_boxes", "draw_detections", "visualize"]


def draw_detections(
    img: ImageType,
    boxes: ArrayLike,
    scores: ArrayLike,
    classes: ArrayLike,
    class_names: Optional[ClassNames] = None,
    show: bool = False,
    line_thickness: Optional[int] = None,
) -> ImageType:
    """Draws boxes given as arrays.

    Args:
        img: OpenCV's image, drawn on in place, or an :class:`Image`.
        boxes: Corners, ``[boxes, 4]``: left, top, right, bottom, in pixels.
        scores: Their scores.
        classes: Their class indices.
        class_names: Names of the class indices, by index.
        show: Opens a window and waits for a key; without OpenCV or a display, writes a file and prints its path.
        line_thickness: No effect: lines and letters follow the image's size.

    Returns:
        ``img`` itself for OpenCV's image, else a new :class:`Image`.

    Raises:
        ValueError: The arrays do not fit together, or the image cannot be drawn on.
    """
    import numpy as np

    corners = np.asarray(boxes, dtype=float).reshape(-1, 4)
    values, names = np.asarray(scores, dtype=float).reshape(-1), np.asarray(classes).reshape(-1)
    if not len(corners) == len(values) == len(names):
        raise ValueError(
            f"{len(corners)} boxes have {len(values)} scores and {len(names)} classes; give the same number of each"
        )
    rows = zip(corners.tolist(), names.tolist(), values.tolist())
    found = [BoundingBox(int(name), x0, y0, x1 - x0, y1 - y0, score) for (x0, y0, x1, y1), name, score in rows]
    return draw_bounding_boxes(img, BoundingBoxList(found), class_names, show, line_thickness)


def draw(img: ImageType, bounding_box_list: BoundingBoxList, w_sensor1: float = 1.0) -> ImageType:
    """Draws predictions of GemLearner, with a bar for the weight of its first sensor.

    Args:
        img: OpenCV's image, drawn on in place, or an :class:`Image`.
        bounding_box_list: The boxes.
        w_sensor1: The weight, 0 to 1: the blue share of the bar at the lower edge; the rest is green.

    Returns:
        ``img`` itself for OpenCV's image, else a new :class:`Image`.

    Raises:
        ValueError: The weight is out of range, or the image cannot be drawn on.
    """
    if not 0 <= w_sensor1 <= 1:
        raise ValueError(f"w_sensor1 = {w_sensor1} is out of range 0 to 1")
    drawn = draw_bounding_boxes(img, bounding_box_list)
    if isinstance(drawn, Image):
        pixels = drawn.opencv()
        _bar(pixels, w_sensor1)
        return Image(pixels)
    _bar(drawn, w_sensor1)
    return drawn


def _bar(pixels: Any, weight: float) -> None:
    height, width = pixels.shape[:2]
    split = round(width * weight)
    rows = slice(height - max(2, height // 50), height)
    pixels[rows, :split, :3] = (255, 0, 0)
    pixels[rows, split:, :3] = (0, 255, 0)


def visualize(learner: Any, image_path: Union[str, os.PathLike[str]], show: bool = True) -> tuple[Image, Heatmap]:
    """Draws the prediction of BinaryHighResolutionLearner for an image.

    Args:
        learner: The learner, loaded.
        image_path: The file.
        show: Opens a window and waits for a key; without OpenCV or a display, writes a file and prints its path.

    Returns:
        The drawing, and the map.
    """
    from opendr._show import show_image

    image = Image.open(image_path)
    found = learner.infer(image).map
    drawn = draw_target(image, found)
    if show:
        show_image(drawn)
    return drawn, found
