"""Learners of the task fall_detection. Made by bindings/python/stubs.py; do not edit."""

# Each learner has the arguments of OpenDR's class of its name.
# mypy: disable-error-code="override"
# pyright: reportIncompatibleMethodOverride=false

import os
from collections.abc import Iterator, Mapping, Sequence
from typing import Any, Literal, NamedTuple, NoReturn, Optional, Union, overload

from numpy.typing import ArrayLike, NDArray
from opendr._drawing import draw as draw
from opendr._drawing import draw_bounding_boxes as draw_bounding_boxes
from opendr._drawing import get_bbox as get_bbox
from opendr._upstream.pose_datasets import URFallDatasetIterator as URFallDatasetIterator
from opendr._upstream.learners.people import FallDetector
from opendr.engine.data import Image
from opendr.engine.target import BoundingBoxList, PoseList

class FallDetectorLearnerOutputs(NamedTuple):
    falls: BoundingBoxList
    poses: PoseList

class FallDetectorLearner(FallDetector):
    """Tells which persons have fallen, by a rule on their poses over time.

    Task: fall_detection. ``infer`` takes:

        image: Image.

    and gives: BoundingBoxList, PoseList.

    Args:
        hold: A posture takes the place of another when it was seen for so long. (default 0.5; 0 to 60 s; may
            change while running, also for one call of infer)
        threshold: Persons below this score are dropped. (default 0.1; 0 to 1; may change while running, also for
            one call of infer)
        keypoint_threshold: Joints below this score are missing. (default 0.1; 0.01 to 1; may change while
            running, also for one call of infer)
        base_height: Height of the input of LightweightOpenPose. Larger finds smaller persons; MoveNet has a size
            of its own. (default 368; 64 to 2048 px; may change while running, also for one call of infer)
        others: OpenDR's arguments, see ``opendr.engine.learners.BaseLearner``.

    Arguments of OpenDR that are taken and have no effect:
        pose_estimator: no effect: the model carries its own.
    """

    hold: float
    keypoint_threshold: float
    base_height: int
    def __init__(self, pose_estimator: Any = ..., *, lr: float = ..., iters: int = ..., batch_size: int = ..., optimizer: str = ..., lr_schedule: str = ..., backbone: str = ..., network_head: str = ..., checkpoint_after_iter: int = ..., checkpoint_load_iter: int = ..., temp_path: str = ..., device: str = ..., threshold: float = ..., scale: float = ..., hold: float = ..., keypoint_threshold: float = ..., base_height: int = ...) -> None: ...
    def eval(self, dataset: Any, verbose: Any = ..., **options: Any) -> dict[str, Any]: ...
