"""Learners of the task pose_estimation. Made by bindings/python/stubs.py; do not edit."""

import os
from collections.abc import Iterator, Sequence
from typing import Any, Literal, NamedTuple, Optional, Union, overload

from numpy.typing import ArrayLike, NDArray
from opendr._drawing import draw as draw
from opendr._drawing import get_bbox as get_bbox
from opendr._native_learner import NativeLearner
from opendr.engine.data import Image
from opendr.engine.target import PoseList

class MovenetLearner(NativeLearner):
    """MoveNet finds 18 joints of one person (lightning) or of up to six (multipose).

    Task: pose_estimation. ``infer`` takes:

        image: Image.

    and gives: PoseList.

    Args:
        threshold: Persons below this score are dropped. (default 0.2; 0 to 1; may change while running, also for
            one call of infer)
        keypoint_threshold: Joints below this score are missing. (default 0.1; 0 to 1; may change while running,
            also for one call of infer)
        size: Longer side of the input of MultiPose; a multiple of 32. Larger finds smaller persons. (default 256;
            128 to 1024 px)
        others: OpenDR's arguments, see ``opendr.engine.learners.BaseLearner``.
    """

    threshold: float
    keypoint_threshold: float
    size: int
    def __init__(self, lr: float = ..., iters: int = ..., batch_size: int = ..., optimizer: str = ..., lr_schedule: str = ..., backbone: str = ..., network_head: str = ..., checkpoint_after_iter: int = ..., checkpoint_load_iter: int = ..., temp_path: str = ..., device: str = ..., threshold: float = ..., scale: float = ..., *, keypoint_threshold: float = ..., size: int = ...) -> None: ...
    @overload
    def infer(self, image: Union[Image, NDArray[Any], str, os.PathLike[str]], *, threshold: float = ..., keypoint_threshold: float = ...) -> PoseList: ...  # type: ignore[overload-overlap]
    @overload
    def infer(self, image: Sequence[Union[Image, NDArray[Any], str, os.PathLike[str]]], *, threshold: float = ..., keypoint_threshold: float = ...) -> list[PoseList]: ...
    @overload
    def infer(self, image: Iterator[Union[Image, NDArray[Any], str, os.PathLike[str]]], *, threshold: float = ..., keypoint_threshold: float = ...) -> Iterator[PoseList]: ...

class PosenetLearner(NativeLearner):
    """PoseNet finds 18 joints of any number of persons; convolutions only.

    Task: pose_estimation. ``infer`` takes:

        image: Image.

    and gives: PoseList.

    Args:
        threshold: Persons below this score are dropped. (default 0.25; 0 to 1; may change while running, also for
            one call of infer)
        keypoint_threshold: Joints below this score are missing. (default 0.1; 0 to 1; may change while running,
            also for one call of infer)
        peak_threshold: Joints below this score start no person. (default 0.5; 0.01 to 0.99; may change while
            running, also for one call of infer)
        nms_radius: Joints of one kind nearer than this belong to one person, in pixels of the network's input.
            (default 20.0; 0 to 200 px; may change while running, also for one call of infer)
        max_detections: At most this many persons a picture. (default 20; 1 to 100; may change while running, also
            for one call of infer)
        others: OpenDR's arguments, see ``opendr.engine.learners.BaseLearner``.
    """

    threshold: float
    keypoint_threshold: float
    peak_threshold: float
    nms_radius: float
    max_detections: int
    def __init__(self, lr: float = ..., iters: int = ..., batch_size: int = ..., optimizer: str = ..., lr_schedule: str = ..., backbone: str = ..., network_head: str = ..., checkpoint_after_iter: int = ..., checkpoint_load_iter: int = ..., temp_path: str = ..., device: str = ..., threshold: float = ..., scale: float = ..., *, keypoint_threshold: float = ..., peak_threshold: float = ..., nms_radius: float = ..., max_detections: int = ...) -> None: ...
    @overload
    def infer(self, image: Union[Image, NDArray[Any], str, os.PathLike[str]], *, threshold: float = ..., keypoint_threshold: float = ..., peak_threshold: float = ..., nms_radius: float = ..., max_detections: int = ...) -> PoseList: ...  # type: ignore[overload-overlap]
    @overload
    def infer(self, image: Sequence[Union[Image, NDArray[Any], str, os.PathLike[str]]], *, threshold: float = ..., keypoint_threshold: float = ..., peak_threshold: float = ..., nms_radius: float = ..., max_detections: int = ...) -> list[PoseList]: ...
    @overload
    def infer(self, image: Iterator[Union[Image, NDArray[Any], str, os.PathLike[str]]], *, threshold: float = ..., keypoint_threshold: float = ..., peak_threshold: float = ..., nms_radius: float = ..., max_detections: int = ...) -> Iterator[PoseList]: ...
