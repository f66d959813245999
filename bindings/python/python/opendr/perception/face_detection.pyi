"""Learners of the task face_detection. Made by bindings/python/stubs.py; do not edit."""

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

class UltraLightFaceLearner(NativeLearner):
    """Ultra-Light RFB finds faces in a few milliseconds; boxes only.

    Task: face_detection. ``infer`` takes:

        image: Image.

    and gives: BoundingBoxList.

    Args:
        threshold: Faces below this score are dropped. (default 0.7; 0 to 1; may change while running, also for
            one call of infer)
        iou_threshold: Faces that overlap more than this (intersection over union) are one face. (default 0.3; 0
            to 1; may change while running, also for one call of infer)
        max_detections: At most this many faces a picture. (default 200; 1 to 1000; may change while running, also
            for one call of infer)
        suppression: How overlapping boxes are thinned out. (default 'hard'; one of 'hard', 'soft', 'fast',
            'cluster'; may change while running, also for one call of infer)
        others: OpenDR's arguments, see ``opendr.engine.learners.BaseLearner``.
    """

    iou_threshold: float
    max_detections: int
    suppression: Literal['hard', 'soft', 'fast', 'cluster']
    def __init__(self, lr: float = ..., iters: int = ..., batch_size: int = ..., optimizer: str = ..., lr_schedule: str = ..., backbone: str = ..., network_head: str = ..., checkpoint_after_iter: int = ..., checkpoint_load_iter: int = ..., temp_path: str = ..., device: str = ..., threshold: float = ..., scale: float = ..., *, iou_threshold: float = ..., max_detections: int = ..., suppression: Literal['hard', 'soft', 'fast', 'cluster'] = ...) -> None: ...
    @overload
    def infer(self, image: Union[Image, NDArray[Any], str, os.PathLike[str]], *, threshold: float = ..., iou_threshold: float = ..., max_detections: int = ..., suppression: Literal['hard', 'soft', 'fast', 'cluster'] = ...) -> BoundingBoxList: ...  # type: ignore[overload-overlap]
    @overload
    def infer(self, image: Sequence[Union[Image, NDArray[Any], str, os.PathLike[str]]], *, threshold: float = ..., iou_threshold: float = ..., max_detections: int = ..., suppression: Literal['hard', 'soft', 'fast', 'cluster'] = ...) -> list[BoundingBoxList]: ...
    @overload
    def infer(self, image: Iterator[Union[Image, NDArray[Any], str, os.PathLike[str]]], *, threshold: float = ..., iou_threshold: float = ..., max_detections: int = ..., suppression: Literal['hard', 'soft', 'fast', 'cluster'] = ...) -> Iterator[BoundingBoxList]: ...

class YunetLearner(NativeLearner):
    """YuNet finds faces with eyes, nose and corners of the mouth; tiny and fast.

    Task: face_detection. ``infer`` takes:

        image: Image.

    and gives: BoundingBoxList.

    Args:
        threshold: Faces below this score are dropped. (default 0.6; 0 to 1; may change while running, also for
            one call of infer)
        iou_threshold: Faces that overlap more than this (intersection over union) are one face. (default 0.3; 0
            to 1; may change while running, also for one call of infer)
        max_detections: At most this many faces a picture. (default 200; 1 to 1000; may change while running, also
            for one call of infer)
        size: Side of the network's input, for models that take any; a multiple of 32. (default 640; 32 to 4096
            px)
        suppression: How overlapping boxes are thinned out. (default 'hard'; one of 'hard', 'soft', 'fast',
            'cluster'; may change while running, also for one call of infer)
        others: OpenDR's arguments, see ``opendr.engine.learners.BaseLearner``.
    """

    iou_threshold: float
    max_detections: int
    size: int
    suppression: Literal['hard', 'soft', 'fast', 'cluster']
    def __init__(self, lr: float = ..., iters: int = ..., batch_size: int = ..., optimizer: str = ..., lr_schedule: str = ..., backbone: str = ..., network_head: str = ..., checkpoint_after_iter: int = ..., checkpoint_load_iter: int = ..., temp_path: str = ..., device: str = ..., threshold: float = ..., scale: float = ..., *, iou_threshold: float = ..., max_detections: int = ..., size: int = ..., suppression: Literal['hard', 'soft', 'fast', 'cluster'] = ...) -> None: ...
    @overload
    def infer(self, image: Union[Image, NDArray[Any], str, os.PathLike[str]], *, threshold: float = ..., iou_threshold: float = ..., max_detections: int = ..., suppression: Literal['hard', 'soft', 'fast', 'cluster'] = ...) -> BoundingBoxList: ...  # type: ignore[overload-overlap]
    @overload
    def infer(self, image: Sequence[Union[Image, NDArray[Any], str, os.PathLike[str]]], *, threshold: float = ..., iou_threshold: float = ..., max_detections: int = ..., suppression: Literal['hard', 'soft', 'fast', 'cluster'] = ...) -> list[BoundingBoxList]: ...
    @overload
    def infer(self, image: Iterator[Union[Image, NDArray[Any], str, os.PathLike[str]]], *, threshold: float = ..., iou_threshold: float = ..., max_detections: int = ..., suppression: Literal['hard', 'soft', 'fast', 'cluster'] = ...) -> Iterator[BoundingBoxList]: ...
