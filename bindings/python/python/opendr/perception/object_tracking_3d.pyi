"""Learners of the task object_tracking_3d. Made by bindings/python/stubs.py; do not edit."""

import os
from collections.abc import Iterator, Sequence
from typing import Any, Literal, NamedTuple, Optional, Union, overload

from numpy.typing import ArrayLike, NDArray
from opendr._native_learner import NativeLearner
from opendr.engine.target import BoundingBox3DList, TrackingAnnotation3DList

class ObjectTracking3DAb3dmotLearner(NativeLearner):
    """AB3DMOT follows boxes in space by motion and shared volume.

    Task: object_tracking_3d. ``infer`` takes:

        boxes_3d: BoundingBox3DList.

    and gives: TrackingAnnotation3DList.

    Args:
        max_staleness: An object that is out of sight for so many moments is forgotten. (default 2; 1 to 1000; may
            change while running, also for one call of infer)
        min_updates: An object is told once it was seen so many moments in a row; in the first moments of a stream
            at once. (default 3; 1 to 100; may change while running, also for one call of infer)
        iou_threshold: A track and a box may be one object when they share at least this much of their volume
            (intersection over union). (default 0.01; 0 to 1; may change while running, also for one call of
            infer)
        per_class: Only boxes of the same class can be one object. (default True; may change while running, also
            for one call of infer)
        others: OpenDR's arguments, see ``opendr.engine.learners.BaseLearner``.

    Arguments of OpenDR that are taken and have no effect:
        state_dimensions: no effect: the filter is the paper's, of ten numbers.
        measurement_dimensions: no effect: the filter is the paper's, which measures seven numbers.
        state_transition_matrix: no effect: the filter is the paper's.
        measurement_function_matrix: no effect: the filter is the paper's.
        covariance_matrix: no effect: the filter is the paper's.
        process_uncertainty_matrix: no effect: the filter is the paper's.
    """

    max_staleness: int
    min_updates: int
    iou_threshold: float
    per_class: bool
    def __init__(self, lr: float = ..., iters: int = ..., batch_size: int = ..., optimizer: str = ..., lr_schedule: str = ..., backbone: str = ..., network_head: str = ..., checkpoint_after_iter: int = ..., checkpoint_load_iter: int = ..., temp_path: str = ..., device: str = ..., threshold: float = ..., scale: float = ..., *, max_staleness: int = ..., min_updates: int = ..., iou_threshold: float = ..., per_class: bool = ..., state_dimensions: Any = ..., measurement_dimensions: Any = ..., state_transition_matrix: Any = ..., measurement_function_matrix: Any = ..., covariance_matrix: Any = ..., process_uncertainty_matrix: Any = ...) -> None: ...
    @overload
    def infer(self, boxes_3d: BoundingBox3DList, *, max_staleness: int = ..., min_updates: int = ..., iou_threshold: float = ..., per_class: bool = ..., state_dimensions: Any = ..., measurement_dimensions: Any = ..., state_transition_matrix: Any = ..., measurement_function_matrix: Any = ..., covariance_matrix: Any = ..., process_uncertainty_matrix: Any = ...) -> TrackingAnnotation3DList: ...
    @overload
    def infer(self, boxes_3d: Sequence[BoundingBox3DList], *, max_staleness: int = ..., min_updates: int = ..., iou_threshold: float = ..., per_class: bool = ..., state_dimensions: Any = ..., measurement_dimensions: Any = ..., state_transition_matrix: Any = ..., measurement_function_matrix: Any = ..., covariance_matrix: Any = ..., process_uncertainty_matrix: Any = ...) -> list[TrackingAnnotation3DList]: ...
    @overload
    def infer(self, boxes_3d: Iterator[BoundingBox3DList], *, max_staleness: int = ..., min_updates: int = ..., iou_threshold: float = ..., per_class: bool = ..., state_dimensions: Any = ..., measurement_dimensions: Any = ..., state_transition_matrix: Any = ..., measurement_function_matrix: Any = ..., covariance_matrix: Any = ..., process_uncertainty_matrix: Any = ...) -> Iterator[TrackingAnnotation3DList]: ...
