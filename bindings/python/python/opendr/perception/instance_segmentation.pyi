"""Learners of the task instance_segmentation. Made by bindings/python/stubs.py; do not edit."""

# Each learner has the arguments of OpenDR's class of its name.
# mypy: disable-error-code="override"
# pyright: reportIncompatibleMethodOverride=false

import os
from collections.abc import Iterator, Mapping, Sequence
from typing import Any, Literal, NamedTuple, NoReturn, Optional, Union, overload

from numpy.typing import ArrayLike, NDArray
from opendr._drawing import draw_bounding_boxes as draw_bounding_boxes
from opendr._native_learner import NativeLearner, PathLike
from opendr.engine.data import Image
from opendr.engine.target import BoundingBoxList

class BodyPixLearner(NativeLearner):
    """BodyPix finds persons with the pixels of each.

    Task: instance_segmentation. ``infer`` takes:

        image: Image.

    and gives: BoundingBoxList.

    Args:
        threshold: Persons below this score are dropped. (default 0.2; 0 to 1; may change while running, also for
            one call of infer)
        mask_threshold: Pixels from this score on belong to a person. (default 0.5; 0.01 to 0.99; may change while
            running, also for one call of infer)
        peak_threshold: Joints below this score start no person. (default 0.4; 0.01 to 0.99; may change while
            running, also for one call of infer)
        nms_radius: Joints of one kind nearer than this belong to one person, in pixels of the network's input.
            (default 30.0; 0 to 200 px; may change while running, also for one call of infer)
        max_detections: At most this many persons a picture. (default 20; 1 to 100; may change while running, also
            for one call of infer)
        resolution: Longer side of the network's input. Larger finds smaller persons. (default 513; 65 to 1537 px;
            may change while running, also for one call of infer)
        others: OpenDR's arguments, see ``opendr.engine.learners.BaseLearner``.
    """

    mask_threshold: float
    peak_threshold: float
    nms_radius: float
    max_detections: int
    resolution: int
    def __init__(self, lr: float = ..., iters: int = ..., batch_size: int = ..., optimizer: str = ..., lr_schedule: str = ..., backbone: str = ..., network_head: str = ..., checkpoint_after_iter: int = ..., checkpoint_load_iter: int = ..., temp_path: str = ..., device: str = ..., threshold: float = ..., scale: float = ..., *, mask_threshold: float = ..., peak_threshold: float = ..., nms_radius: float = ..., max_detections: int = ..., resolution: int = ...) -> None: ...
    @overload
    def infer(self, image: Union[Image, NDArray[Any], str, os.PathLike[str]], *, threshold: float = ..., mask_threshold: float = ..., peak_threshold: float = ..., nms_radius: float = ..., max_detections: int = ..., resolution: int = ...) -> BoundingBoxList: ...  # type: ignore[overload-overlap]
    @overload
    def infer(self, image: Sequence[Union[Image, NDArray[Any], str, os.PathLike[str]]], *, threshold: float = ..., mask_threshold: float = ..., peak_threshold: float = ..., nms_radius: float = ..., max_detections: int = ..., resolution: int = ...) -> list[BoundingBoxList]: ...
    @overload
    def infer(self, image: Iterator[Union[Image, NDArray[Any], str, os.PathLike[str]]], *, threshold: float = ..., mask_threshold: float = ..., peak_threshold: float = ..., nms_radius: float = ..., max_detections: int = ..., resolution: int = ...) -> Iterator[BoundingBoxList]: ...
