"""Learners of the task stereo_matching. Made by bindings/python/stubs.py; do not edit."""

# Each learner has the arguments of OpenDR's class of its name.
# mypy: disable-error-code="override"
# pyright: reportIncompatibleMethodOverride=false

import os
from collections.abc import Iterator, Mapping, Sequence
from typing import Any, Literal, NamedTuple, NoReturn, Optional, Union, overload

from numpy.typing import ArrayLike, NDArray
from opendr._native_learner import NativeLearner, PathLike
from opendr.engine.data import Image
from opendr.engine.target import BoundingBox3DList, Heatmap

class SemiGlobalMatchingLearnerOutputs(NamedTuple):
    disparity: Heatmap
    depth: Heatmap
    obstacles: BoundingBox3DList

class SemiGlobalMatchingLearner(NativeLearner):
    """Tells the distance of what two cameras see, by semi-global matching.

    Task: stereo_matching. ``infer`` takes:

        left: Image. Of the left camera.
        right: Image. Of the right camera.

    and gives: Heatmap, Heatmap, BoundingBox3DList.

    Args:
        min_disparity: The least disparity that is looked for. (default 0; 0 to 4096 px; may change while running,
            also for one call of infer)
        num_disparities: How many disparities are looked for; rounded up to a multiple of 16. (default 64; 1 to
            1024 px; may change while running, also for one call of infer)
        p1: What a step of one pixel in disparity costs, in differing neighbours of 62. (default 8; 0 to 193; may
            change while running, also for one call of infer)
        p2: What a larger step costs. (default 40; 0 to 193; may change while running, also for one call of infer)
        uniqueness_ratio: By how many percent the second best disparity must be worse. (default 5; 0 to 99 %; may
            change while running, also for one call of infer)
        disp12_max_diff: How far the right picture may disagree; -1 does not ask it. (default 1; -1 to 1000 px;
            may change while running, also for one call of infer)
        speckle_window_size: Islands of at most so many pixels are forgotten. (default 100; 0 to 1e+06 px; may
            change while running, also for one call of infer)
        speckle_range: Neighbours belong to one island where they differ by at most so much. (default 1.0; 0 to
            1000 px; may change while running, also for one call of infer)
        fill: Whether holes are filled from the background in their row. (default False; may change while running,
            also for one call of infer)
        shrink: Squares of as many pixels along each side are matched as one: faster, coarser. (default 1; 1 to 16
            px; may change while running, also for one call of infer)
        focal_length: Focal length of the rectified pair. Depths need it. (default 0.0; 0 to 1e+06 px; may change
            while running, also for one call of infer)
        baseline: Between the cameras. Depths need it. (default 0.0; 0 to 1000 m; may change while running, also
            for one call of infer)
        disparity_offset: How much further right the right principal point lies (Middlebury's doffs). (default
            0.0; -10000 to 10000 px; may change while running, also for one call of infer)
        camera_height: How high the cameras are above the floor. Obstacles need it. (default 0.0; 0 to 100 m; may
            change while running, also for one call of infer)
        camera_pitch: How far the cameras look down. (default 0.0; -89 to 89 deg; may change while running, also
            for one call of infer)
        min_height: What rises less above the floor is no obstacle. (default 0.2; 0 to 100 m; may change while
            running, also for one call of infer)
        max_height: What hangs higher above the floor is no obstacle. (default 2.0; 0 to 100 m; may change while
            running, also for one call of infer)
        max_distance: What is farther is no obstacle. (default 10.0; 0.1 to 100 m; may change while running, also
            for one call of infer)
        others: OpenDR's arguments, see ``opendr.engine.learners.BaseLearner``.
    """

    min_disparity: int
    num_disparities: int
    p1: int
    p2: int
    uniqueness_ratio: int
    disp12_max_diff: int
    speckle_window_size: int
    speckle_range: float
    fill: bool
    shrink: int
    focal_length: float
    baseline: float
    disparity_offset: float
    camera_height: float
    camera_pitch: float
    min_height: float
    max_height: float
    max_distance: float
    def __init__(self, lr: float = ..., iters: int = ..., batch_size: int = ..., optimizer: str = ..., lr_schedule: str = ..., backbone: str = ..., network_head: str = ..., checkpoint_after_iter: int = ..., checkpoint_load_iter: int = ..., temp_path: str = ..., device: str = ..., threshold: float = ..., scale: float = ..., *, min_disparity: int = ..., num_disparities: int = ..., p1: int = ..., p2: int = ..., uniqueness_ratio: int = ..., disp12_max_diff: int = ..., speckle_window_size: int = ..., speckle_range: float = ..., fill: bool = ..., shrink: int = ..., focal_length: float = ..., baseline: float = ..., disparity_offset: float = ..., camera_height: float = ..., camera_pitch: float = ..., min_height: float = ..., max_height: float = ..., max_distance: float = ...) -> None: ...
    def infer(self, left: Union[Image, NDArray[Any], str, os.PathLike[str]], right: Union[Image, NDArray[Any], str, os.PathLike[str]], *, min_disparity: int = ..., num_disparities: int = ..., p1: int = ..., p2: int = ..., uniqueness_ratio: int = ..., disp12_max_diff: int = ..., speckle_window_size: int = ..., speckle_range: float = ..., fill: bool = ..., shrink: int = ..., focal_length: float = ..., baseline: float = ..., disparity_offset: float = ..., camera_height: float = ..., camera_pitch: float = ..., min_height: float = ..., max_height: float = ..., max_distance: float = ...) -> SemiGlobalMatchingLearnerOutputs: ...
