"""Learners of the task grasp_detection. Made by bindings/python/stubs.py; do not edit."""

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

class GrConvNetLearner(NativeLearner):
    """GR-ConvNet finds where a gripper can take hold, in colour and depth.

    Task: grasp_detection. ``infer`` takes:

        image: Image. In colour.
        depth: Image. Of the same size and place: one channel, 16 bits in millimetres or floats in metres; 0 where
            nothing is known.

    and gives: PoseList.

    Args:
        threshold: Least quality of a grasp. (default 0.2; 0 to 1; may change while running, also for one call of
            infer)
        max_grasps: Most grasps of a picture. (default 5; 1 to 100; may change while running, also for one call of
            infer)
        distance: Least distance between two grasps, pixels of the network's map of 224. (default 20; 1 to 224 px;
            may change while running, also for one call of infer)
        others: OpenDR's arguments, see ``opendr.engine.learners.BaseLearner``.
    """

    max_grasps: int
    distance: int
    def __init__(self, lr: float = ..., iters: int = ..., batch_size: int = ..., optimizer: str = ..., lr_schedule: str = ..., backbone: str = ..., network_head: str = ..., checkpoint_after_iter: int = ..., checkpoint_load_iter: int = ..., temp_path: str = ..., device: str = ..., threshold: float = ..., scale: float = ..., *, max_grasps: int = ..., distance: int = ...) -> None: ...
    def infer(self, image: Union[Image, NDArray[Any], str, os.PathLike[str]], depth: Union[Image, NDArray[Any], str, os.PathLike[str]], *, threshold: float = ..., max_grasps: int = ..., distance: int = ...) -> PoseList: ...
