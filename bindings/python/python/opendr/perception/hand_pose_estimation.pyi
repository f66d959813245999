"""Learners of the task hand_pose_estimation. Made by bindings/python/stubs.py; do not edit."""

# Each learner has the arguments of OpenDR's class of its name.
# mypy: disable-error-code="override"
# pyright: reportIncompatibleMethodOverride=false

import os
from collections.abc import Iterator, Mapping, Sequence
from typing import Any, Literal, NamedTuple, NoReturn, Optional, Union, overload

from numpy.typing import ArrayLike, NDArray
from opendr._drawing import draw as draw
from opendr._drawing import get_bbox as get_bbox
from opendr._native_learner import NativeLearner, PathLike
from opendr.engine.data import Image
from opendr.engine.target import PoseList

class HandPoseEstimationLearner(NativeLearner):
    """Finds 21 joints of each hand and follows hands through a video.

    Task: hand_pose_estimation. ``infer`` takes:

        image: Image.

    and gives: PoseList.

    Args:
        max_hands: At most this many hands a picture. (default 2; 1 to 16; may change while running, also for one
            call of infer)
        threshold: Hands below this score are dropped, and followed no longer. (default 0.5; 0 to 1; may change
            while running, also for one call of infer)
        palm_threshold: Palms below this score are not looked at. Lower than MediaPipe's 0.5: a closer look drops
            what is no hand. (default 0.2; 0 to 1; may change while running, also for one call of infer)
        iou_threshold: Palms that overlap more than this (intersection over union) are one palm. (default 0.3; 0
            to 1; may change while running, also for one call of infer)
        track: Whether hands are followed from frame to frame, each with a number. Switch it off for single
            pictures. (default True; may change while running, also for one call of infer)
        mirrored: Whether pictures are mirrored, as those of a selfie are: what looks like a left hand is a right
            one then. (default False; may change while running, also for one call of infer)
        others: OpenDR's arguments, see ``opendr.engine.learners.BaseLearner``.
    """

    max_hands: int
    palm_threshold: float
    iou_threshold: float
    track: bool
    mirrored: bool
    def __init__(self, lr: float = ..., iters: int = ..., batch_size: int = ..., optimizer: str = ..., lr_schedule: str = ..., backbone: str = ..., network_head: str = ..., checkpoint_after_iter: int = ..., checkpoint_load_iter: int = ..., temp_path: str = ..., device: str = ..., threshold: float = ..., scale: float = ..., *, max_hands: int = ..., palm_threshold: float = ..., iou_threshold: float = ..., track: bool = ..., mirrored: bool = ...) -> None: ...
    @overload
    def infer(self, image: Union[Image, NDArray[Any], str, os.PathLike[str]], *, max_hands: int = ..., threshold: float = ..., palm_threshold: float = ..., iou_threshold: float = ..., track: bool = ..., mirrored: bool = ...) -> PoseList: ...  # type: ignore[overload-overlap]
    @overload
    def infer(self, image: Sequence[Union[Image, NDArray[Any], str, os.PathLike[str]]], *, max_hands: int = ..., threshold: float = ..., palm_threshold: float = ..., iou_threshold: float = ..., track: bool = ..., mirrored: bool = ...) -> list[PoseList]: ...
    @overload
    def infer(self, image: Iterator[Union[Image, NDArray[Any], str, os.PathLike[str]]], *, max_hands: int = ..., threshold: float = ..., palm_threshold: float = ..., iou_threshold: float = ..., track: bool = ..., mirrored: bool = ...) -> Iterator[PoseList]: ...
