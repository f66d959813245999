"""Learners of the task object_tracking_3d. Made by bindings/python/stubs.py; do not edit."""

# Each learner has the arguments of OpenDR's class of its name.
# mypy: disable-error-code="override"
# pyright: reportIncompatibleMethodOverride=false

import os
from collections.abc import Iterator, Mapping, Sequence
from typing import Any, Literal, NamedTuple, NoReturn, Optional, Union, overload

from numpy.typing import ArrayLike, NDArray
from opendr._upstream.space_datasets import KittiTrackingDatasetIterator as KittiTrackingDatasetIterator
from opendr._upstream.space_datasets import LabeledTrackingPointCloudsDatasetIterator as LabeledTrackingPointCloudsDatasetIterator
from opendr._native_learner import PathLike
from opendr._upstream.learners.tracking import BoxesInSpace, Vpit
from opendr.engine.data import PointCloud
from opendr.engine.datasets import Dataset
from opendr.engine.learners import Learner
from opendr.engine.target import BoundingBox3DList, TrackingAnnotation3DList

class ObjectTracking3DAb3dmotLearner(BoxesInSpace):
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
    def __init__(self, device: str = ..., max_staleness: int = ..., min_updates: int = ..., state_dimensions: Any = ..., measurement_dimensions: Any = ..., state_transition_matrix: Any = ..., measurement_function_matrix: Any = ..., covariance_matrix: Any = ..., process_uncertainty_matrix: Any = ..., iou_threshold: float = ..., *, lr: float = ..., iters: int = ..., batch_size: int = ..., optimizer: str = ..., lr_schedule: str = ..., backbone: str = ..., network_head: str = ..., checkpoint_after_iter: int = ..., checkpoint_load_iter: int = ..., temp_path: str = ..., threshold: float = ..., scale: float = ..., per_class: bool = ...) -> None: ...
    @overload
    def infer(self, boxes_3d: BoundingBox3DList, *, max_staleness: int = ..., min_updates: int = ..., iou_threshold: float = ..., per_class: bool = ..., state_dimensions: Any = ..., measurement_dimensions: Any = ..., state_transition_matrix: Any = ..., measurement_function_matrix: Any = ..., covariance_matrix: Any = ..., process_uncertainty_matrix: Any = ...) -> TrackingAnnotation3DList: ...
    @overload
    def infer(self, boxes_3d: Sequence[BoundingBox3DList], *, max_staleness: int = ..., min_updates: int = ..., iou_threshold: float = ..., per_class: bool = ..., state_dimensions: Any = ..., measurement_dimensions: Any = ..., state_transition_matrix: Any = ..., measurement_function_matrix: Any = ..., covariance_matrix: Any = ..., process_uncertainty_matrix: Any = ...) -> list[TrackingAnnotation3DList]: ...
    @overload
    def infer(self, boxes_3d: Iterator[BoundingBox3DList], *, max_staleness: int = ..., min_updates: int = ..., iou_threshold: float = ..., per_class: bool = ..., state_dimensions: Any = ..., measurement_dimensions: Any = ..., state_transition_matrix: Any = ..., measurement_function_matrix: Any = ..., covariance_matrix: Any = ..., process_uncertainty_matrix: Any = ...) -> Iterator[TrackingAnnotation3DList]: ...
    def fit(self, dataset: Dataset, val_dataset: Optional[Dataset] = ..., logging_path: PathLike = ..., silent: bool = ..., verbose: bool = ..., *, out: Optional[PathLike] = ..., resume: bool = ..., split: Optional[str] = ..., val_split: Optional[str] = ..., limit: Optional[int] = ..., teacher: Union[None, str, Learner] = ..., teacher_threshold: Optional[float] = ..., teacher_classes: Sequence[str] = ..., teacher_map: Optional[Mapping[str, str]] = ..., teacher_by_number: bool = ..., keep_empty: bool = ..., skip_broken: bool = ...) -> dict[str, Any]: ...
    def eval(self, dataset: Any, logging_path: Any = ..., silent: Any = ..., verbose: Any = ..., count: Any = ..., **options: Any) -> dict[str, Any]: ...

class ObjectTracking3DVpitLearner(Vpit):
    """VPIT follows one object in the scans of a lidar from a box in the first; it trains on recordings.

    Task: object_tracking_3d. ``infer`` takes:

        point_cloud: PointCloud. What the lidar saw; a PointCloudWithCalibration places the boxes in its camera's
            frame and picture.
        init_box: BoundingBox3DList (with the first input of a stream). What is to be followed from this scan on:
            its first box.

    and gives: TrackingAnnotation3DList.

    Args:
        window_influence: How much a place far from where the object is expected is marked down. (default 0.4; 0
            to 1; may change while running, also for one call of infer)
        rotation_penalty: What the score of another direction than the expected one is multiplied by. (default
            0.98; 0 to 1; may change while running, also for one call of infer)
        rotation_step: How far the directions are apart that are looked at. (default 0.15; 0.01 to 1 rad; may
            change while running, also for one call of infer)
        rotations_count: How many directions are looked at, the expected one in their middle; an even number is
            one more. (default 3; 1 to 9; may change while running, also for one call of infer)
        context_amount: What is seen around an object with it, in its mean sides. (default 0.25; 0 to 2)
        target_feature_merge_scale: How much of every later view goes into what the object looks like; OpenDR's
            default is 0, too. (default 0.0; 0 to 1; may change while running, also for one call of infer)
        extrapolation_mode: What is known of the object's way. (default 'linear+'; one of 'linear+', 'linear',
            'none'; may change while running, also for one call of infer)
        offset_interpolation: How much of the way to where it is seen the box moves. (default 1.0; 0 to 1; may
            change while running, also for one call of infer)
        vertical_offset_interpolation: The same for its height. (default 0.5; 0 to 1; may change while running,
            also for one call of infer)
        min_top_score: Below this score the object is out of sight: the box goes where it is expected. (default
            0.0; 0 to 1; may change while running, also for one call of infer)
        others: OpenDR's arguments, see ``opendr.engine.learners.BaseLearner``.

    Parameters of ``fit``, for one call or, given here, for all of them:
        pillar: Side of a pillar; a view shows 64 of them each way, the largest object a quarter of it. (default
            0.2; 0.02 to 5 m)
        apart: An object is looked for at most so many moments after it was seen. (default 5; 1 to 1000)
        objects: At most so many objects of a scan go into a batch. (default 4; 1 to 1000)
        augment: Whether objects are looked for from places beside them, and turned. (default True)
        epochs: How often the data set is gone through. (default 10; 1 to 1e+06; in OpenDR iters)
        max_steps: Optimiser steps after which training ends, whatever the number of epochs; 0 for no limit.
            (default 0; 0 to 1e+09)
        batch_size: Samples a batch. (default 8; 1 to 65536)
        accumulate: Batches whose gradients are added up for one step of the optimiser. (default 1; 1 to 4096; in
            OpenDR batches_per_iter)
        lr: Learning rate at its highest. (default 0.003; 0 to 100)
        optimizer: What turns gradients into steps. (default 'adamw'; one of 'adamw', 'adam', 'sgd', 'rmsprop'; in
            OpenDR optimizer_name)
        momentum: Momentum of `sgd` and `rmsprop`. (default 0.9; 0 to 1)
        weight_decay: Weight decay: decoupled from the gradient in `adamw`, added to it in the others. (default
            0.0001; 0 to 10)
        lr_schedule: How the learning rate goes on after the warm-up. (default 'cosine'; one of 'constant',
            'step', 'cosine', 'linear')
        warmup_steps: Steps over which the learning rate rises from `warmup_ratio` of itself. (default 20; 0 to
            1e+08)
        warmup_ratio: What share of the learning rate the warm-up begins with. (default 0.1; 0 to 1)
        lr_min: Learning rate at the end of `cosine` and `linear`. (default 0.0; 0 to 100; in OpenDR
            lr_schedule_eta_min)
        lr_steps: Epochs at which `step` lowers the learning rate. (default []; in OpenDR drop_after_epoch)
        lr_gamma: What `step` multiplies the learning rate with. (default 0.1; 0 to 1; in OpenDR lr_decay)
        grad_clip: Gradients whose norm over all weights is above this are scaled down to it; 0 for no limit.
            (default 10.0; 0 to 1e+09)
        ema: Share of itself that the moving average of the weights keeps each step, e.g. 0.999; it is what is
            validated and saved. 0 for no average. (default 0.0; 0 to 0.999999)
        early_stop: Validations without a better metric after which training ends; 0 for never. (default 0; 0 to
            100000)
        val_after: Epochs between validations. (default 1; 1 to 1e+06)
        checkpoint_after_iter: Steps between checkpoints; 0 for none but those by the clock. (default 0; 0 to
            1e+08)
        checkpoint_minutes: Minutes between checkpoints; 0 for none by the clock. (default 10.0; 0 to 10000 min)
        checkpoints_kept: Checkpoints that are kept beside the best. (default 2; 1 to 1000)
        log_after: Steps between lines of the log. (default 10; 1 to 1e+06)
        num_workers: Threads that read and augment samples. (default 1; 0 to 1024)
        seed: What first weights, order, augmentation and dropout follow from. (default 0)

    Arguments of OpenDR that are taken and have no effect:
        model_config_path: no effect: what it needs to know stands in the model.
        tanet_config_path: no effect: there is one network.
        backbone: no effect: there is one network.
        feature_blocks: no effect: there is one network.
        bof_mode: no effect: there is one network.
        bof_training_steps: no effect: there is one network.
        score_upscale: no effect: the place is found between cells by a parabola.
        upscaling_mode: no effect: the place is found between cells by a parabola.
        rotation_interpolation: no effect: the turn is found between directions by a parabola.
        target_size: no effect: the model knows the size of its views.
        search_size: no effect: the model knows the size of its views.
        search_type: no effect: the model knows the size of its views.
        target_type: no effect: the cells that the object covers are compared.
        target_features_mode: no effect: target_feature_merge_scale tells it.
        overwrite_strides: no effect: there is one network.
        regress_vertical_position: no effect: the height follows the points of the object.
        regression_training_isolation: no effect: the height follows the points of the object.
        vertical_regressor_type: no effect: the height follows the points of the object.
        vertical_regressor_kwargs: no effect: the height follows the points of the object.
        threshold: no effect: min_top_score tells it.
        scale: no effect: the model knows the range of its views.
        temp_path: no effect: what fit writes lies in its output folder.
        checkpoint_load_iter: no effect: fit goes on from the last checkpoint of its output folder.
        loss_function: no effect: binary cross-entropy, as OpenDR's default.
        train_pseudo_image: no effect: there is one network, which trains as a whole.
        augment_rotation: no effect: augment tells it.
    """

    window_influence: float
    rotation_penalty: float
    rotation_step: float
    rotations_count: int
    context_amount: float
    target_feature_merge_scale: float
    extrapolation_mode: Literal['linear+', 'linear', 'none']
    offset_interpolation: float
    vertical_offset_interpolation: float
    min_top_score: float
    def __init__(self, model_config_path: Any = ..., lr: float = ..., optimizer: Literal['adamw', 'adam', 'sgd', 'rmsprop'] = ..., lr_schedule: Literal['constant', 'step', 'cosine', 'linear'] = ..., checkpoint_after_iter: int = ..., checkpoint_load_iter: int = ..., temp_path: str = ..., device: str = ..., tanet_config_path: Any = ..., optimizer_params: Any = ..., lr_schedule_params: Any = ..., feature_blocks: Any = ..., window_influence: float = ..., score_upscale: Any = ..., rotation_penalty: float = ..., rotation_step: float = ..., rotations_count: int = ..., rotation_interpolation: Any = ..., target_size: Any = ..., search_size: Any = ..., context_amount: float = ..., target_feature_merge_scale: float = ..., loss_function: Any = ..., r_pos: Any = ..., augment: bool = ..., augment_rotation: Any = ..., train_pseudo_image: Any = ..., search_type: Any = ..., target_type: Any = ..., bof_mode: Any = ..., bof_training_steps: Any = ..., extrapolation_mode: Literal['linear+', 'linear', 'none'] = ..., offset_interpolation: float = ..., vertical_offset_interpolation: float = ..., min_top_score: float = ..., overwrite_strides: Any = ..., target_features_mode: Any = ..., upscaling_mode: Any = ..., regress_vertical_position: Any = ..., regression_training_isolation: Any = ..., vertical_regressor_type: Any = ..., vertical_regressor_kwargs: Any = ..., iters: int = ..., backbone: str = ..., batch_size: int = ..., threshold: float = ..., scale: float = ..., *, network_head: str = ..., pillar: float = ..., apart: int = ..., objects: int = ..., epochs: int = ..., max_steps: int = ..., accumulate: int = ..., batches_per_iter: int = ..., optimizer_name: Literal['adamw', 'adam', 'sgd', 'rmsprop'] = ..., momentum: float = ..., weight_decay: float = ..., warmup_steps: int = ..., warmup_ratio: float = ..., lr_min: float = ..., lr_schedule_eta_min: float = ..., lr_steps: list[Any] = ..., drop_after_epoch: list[Any] = ..., lr_gamma: float = ..., lr_decay: float = ..., grad_clip: float = ..., ema: float = ..., early_stop: int = ..., val_after: int = ..., checkpoint_minutes: float = ..., checkpoints_kept: int = ..., log_after: int = ..., num_workers: int = ..., seed: int = ...) -> None: ...
    def fit(self, dataset: Dataset, steps: Any = ..., val_dataset: Optional[Dataset] = ..., refine_weight: Any = ..., ground_truth_annotations: Any = ..., logging_path: PathLike = ..., silent: bool = ..., verbose: bool = ..., model_dir: Optional[PathLike] = ..., image_shape: Any = ..., evaluate: Any = ..., debug: Any = ..., load_optimizer: Any = ..., *, out: Optional[PathLike] = ..., resume: bool = ..., split: Optional[str] = ..., val_split: Optional[str] = ..., limit: Optional[int] = ..., teacher: Union[None, str, Learner] = ..., teacher_threshold: Optional[float] = ..., teacher_classes: Sequence[str] = ..., teacher_map: Optional[Mapping[str, str]] = ..., teacher_by_number: bool = ..., keep_empty: bool = ..., skip_broken: bool = ..., pillar: float = ..., apart: int = ..., objects: int = ..., augment: bool = ..., epochs: int = ..., iters: int = ..., max_steps: int = ..., batch_size: int = ..., accumulate: int = ..., batches_per_iter: int = ..., lr: float = ..., optimizer: Literal['adamw', 'adam', 'sgd', 'rmsprop'] = ..., optimizer_name: Literal['adamw', 'adam', 'sgd', 'rmsprop'] = ..., momentum: float = ..., weight_decay: float = ..., lr_schedule: Literal['constant', 'step', 'cosine', 'linear'] = ..., warmup_steps: int = ..., warmup_ratio: float = ..., lr_min: float = ..., lr_schedule_eta_min: float = ..., lr_steps: list[Any] = ..., drop_after_epoch: list[Any] = ..., lr_gamma: float = ..., lr_decay: float = ..., grad_clip: float = ..., ema: float = ..., early_stop: int = ..., val_after: int = ..., checkpoint_after_iter: int = ..., checkpoint_minutes: float = ..., checkpoints_kept: int = ..., log_after: int = ..., num_workers: int = ..., seed: int = ...) -> dict[str, Any]: ...
    def eval(self, dataset: Dataset, ground_truth_annotations: Any = ..., logging_path: Any = ..., silent: Any = ..., verbose: bool = ..., image_shape: Any = ..., count: Optional[int] = ..., *, metric: Optional[str] = ..., split: Optional[str] = ..., limit: Optional[int] = ..., out: Optional[PathLike] = ..., skip_broken: bool = ..., classes: Optional[Mapping[str, str]] = ..., by_number: bool = ..., resamples: int = ..., **metric_params: Any) -> dict[str, Any]: ...
    def optimize(self, do_constant_folding: Any = ..., *, target_device: str = ..., out: Optional[PathLike] = ..., precision: str = ..., calibration: Union[None, Dataset] = ..., validation: Union[None, Dataset] = ..., verbose: bool = ..., **options: Any) -> dict[str, Any]: ...
    def load(self, path: Optional[PathLike] = ..., verbose: bool = ..., backbone: Any = ..., full: Any = ..., *, variant: Optional[str] = ...) -> bool: ...
    @classmethod
    def download(cls, model_name: Any = ..., path: Optional[PathLike] = ..., server_url: Optional[str] = ..., *, mode: str = ..., verbose: bool = ..., url: Optional[str] = ..., variant: Optional[str] = ...) -> str: ...

class SiameseTrackingDatasetIterator:
    """Not here yet: give fit of ObjectTracking3DVpitLearner an ExternalDataset(path, "kitti_tracking")."""

    def __init__(self, *args: Any, **kwargs: Any) -> NoReturn: ...

class SiameseTripletTrackingDatasetIterator:
    """Not here yet: give fit of ObjectTracking3DVpitLearner an ExternalDataset(path, "kitti_tracking")."""

    def __init__(self, *args: Any, **kwargs: Any) -> NoReturn: ...
