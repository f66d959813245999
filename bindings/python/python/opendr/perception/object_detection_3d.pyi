"""Learners of the task object_detection_3d. Made by bindings/python/stubs.py; do not edit."""

# Each learner has the arguments of OpenDR's class of its name.
# mypy: disable-error-code="override"
# pyright: reportIncompatibleMethodOverride=false

import os
from collections.abc import Iterator, Mapping, Sequence
from typing import Any, Literal, NamedTuple, NoReturn, Optional, Union, overload

from numpy.typing import ArrayLike, NDArray
from opendr._upstream.space_datasets import KittiDataset as KittiDataset
from opendr._upstream.space_datasets import LabeledPointCloudsDatasetIterator as LabeledPointCloudsDatasetIterator
from opendr._native_learner import NativeLearner, PathLike
from opendr.engine.data import PointCloud
from opendr.engine.datasets import Dataset
from opendr.engine.learners import Learner
from opendr.engine.target import BoundingBox3DList

class VoxelObjectDetection3DLearner(NativeLearner):
    """PointPillars finds boxes in the scan of a lidar; it trains on classes of your own.

    Task: object_detection_3d. ``infer`` takes:

        point_cloud: PointCloud. What the lidar saw; a PointCloudWithCalibration places the boxes in its camera's
            frame and picture.

    and gives: BoundingBox3DList.

    Args:
        threshold: Boxes below this score are dropped. OpenDR's default of 0 tells every box that the network
            thinks of. (default 0.3; 0 to 1; may change while running, also for one call of infer)
        iou_threshold: Boxes of one class whose floors overlap more than this (intersection over union) are one
            object. (default 0.1; 0 to 1; may change while running, also for one call of infer)
        max_candidates: So many of the best boxes are looked at before overlapping ones are thinned out. (default
            400; 1 to 10000; may change while running, also for one call of infer)
        max_detections: At most this many boxes a scan. (default 100; 1 to 1000; may change while running, also
            for one call of infer)
        others: OpenDR's arguments, see ``opendr.engine.learners.BaseLearner``.

    Parameters of ``fit``, for one call or, given here, for all of them:
        classes: The classes to find, of `Car`, `Pedestrian` and `Cyclist`; cars when empty. (default [])
        ahead: How far it looks ahead. (default 51.2; 4 to 200 m)
        aside: How far it looks to either side. (default 25.6; 2 to 100 m)
        pillar: Side of a pillar. (default 0.32; 0.05 to 5 m)
        augment: Whether scans are mirrored at random. (default True)
        epochs: How often the data set is gone through. (default 10; 1 to 1e+06; in OpenDR iters)
        max_steps: Optimiser steps after which training ends, whatever the number of epochs; 0 for no limit.
            (default 0; 0 to 1e+09)
        batch_size: Samples a batch. (default 4; 1 to 65536)
        accumulate: Batches whose gradients are added up for one step of the optimiser. (default 1; 1 to 4096; in
            OpenDR batches_per_iter)
        lr: Learning rate at its highest. (default 0.002; 0 to 100)
        optimizer: What turns gradients into steps. (default 'adamw'; one of 'adamw', 'adam', 'sgd', 'rmsprop'; in
            OpenDR optimizer_name)
        momentum: Momentum of `sgd` and `rmsprop`. (default 0.9; 0 to 1)
        weight_decay: Weight decay: decoupled from the gradient in `adamw`, added to it in the others. (default
            0.01; 0 to 10)
        lr_schedule: How the learning rate goes on after the warm-up. (default 'cosine'; one of 'constant',
            'step', 'cosine', 'linear')
        warmup_steps: Steps over which the learning rate rises from `warmup_ratio` of itself. (default 50; 0 to
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
        tanet_config_path: no effect: there is one network, PointPillars.
        backbone: no effect: there is one network, PointPillars.
        network_head: no effect: there is one head.
        scale: no effect: the model knows the range of its clouds.
        temp_path: no effect: what fit writes lies in its output folder.
        checkpoint_load_iter: no effect: fit goes on from the last checkpoint of its output folder.
    """

    iou_threshold: float
    max_candidates: int
    max_detections: int
    def __init__(self, model_config_path: Any = ..., lr: float = ..., iters: int = ..., batch_size: int = ..., optimizer: Literal['adamw', 'adam', 'sgd', 'rmsprop'] = ..., lr_schedule: Literal['constant', 'step', 'cosine', 'linear'] = ..., backbone: str = ..., network_head: str = ..., checkpoint_after_iter: int = ..., checkpoint_load_iter: int = ..., temp_path: str = ..., device: str = ..., threshold: float = ..., scale: float = ..., tanet_config_path: Any = ..., optimizer_params: Any = ..., lr_schedule_params: Any = ..., *, classes: list[Any] = ..., ahead: float = ..., aside: float = ..., pillar: float = ..., augment: bool = ..., epochs: int = ..., max_steps: int = ..., accumulate: int = ..., batches_per_iter: int = ..., optimizer_name: Literal['adamw', 'adam', 'sgd', 'rmsprop'] = ..., momentum: float = ..., weight_decay: float = ..., warmup_steps: int = ..., warmup_ratio: float = ..., lr_min: float = ..., lr_schedule_eta_min: float = ..., lr_steps: list[Any] = ..., drop_after_epoch: list[Any] = ..., lr_gamma: float = ..., lr_decay: float = ..., grad_clip: float = ..., ema: float = ..., early_stop: int = ..., val_after: int = ..., checkpoint_minutes: float = ..., checkpoints_kept: int = ..., log_after: int = ..., num_workers: int = ..., seed: int = ..., iou_threshold: float = ..., max_candidates: int = ..., max_detections: int = ...) -> None: ...
    @overload
    def infer(self, point_cloud: Union[PointCloud, ArrayLike], *, threshold: float = ..., iou_threshold: float = ..., max_candidates: int = ..., max_detections: int = ..., model_config_path: Any = ..., tanet_config_path: Any = ..., backbone: Any = ..., network_head: Any = ..., scale: Any = ..., temp_path: Any = ..., checkpoint_load_iter: Any = ...) -> BoundingBox3DList: ...  # type: ignore[overload-overlap]
    @overload
    def infer(self, point_cloud: Sequence[Union[PointCloud, ArrayLike]], *, threshold: float = ..., iou_threshold: float = ..., max_candidates: int = ..., max_detections: int = ..., model_config_path: Any = ..., tanet_config_path: Any = ..., backbone: Any = ..., network_head: Any = ..., scale: Any = ..., temp_path: Any = ..., checkpoint_load_iter: Any = ...) -> list[BoundingBox3DList]: ...
    @overload
    def infer(self, point_cloud: Iterator[Union[PointCloud, ArrayLike]], *, threshold: float = ..., iou_threshold: float = ..., max_candidates: int = ..., max_detections: int = ..., model_config_path: Any = ..., tanet_config_path: Any = ..., backbone: Any = ..., network_head: Any = ..., scale: Any = ..., temp_path: Any = ..., checkpoint_load_iter: Any = ...) -> Iterator[BoundingBox3DList]: ...
    def fit(self, dataset: Dataset, val_dataset: Optional[Dataset] = ..., refine_weight: Any = ..., ground_truth_annotations: Any = ..., logging_path: PathLike = ..., silent: bool = ..., verbose: bool = ..., model_dir: Optional[PathLike] = ..., image_shape: Any = ..., evaluate: Any = ..., *, out: Optional[PathLike] = ..., resume: bool = ..., split: Optional[str] = ..., val_split: Optional[str] = ..., limit: Optional[int] = ..., teacher: Union[None, str, Learner] = ..., teacher_threshold: Optional[float] = ..., teacher_classes: Sequence[str] = ..., teacher_map: Optional[Mapping[str, str]] = ..., teacher_by_number: bool = ..., keep_empty: bool = ..., skip_broken: bool = ..., classes: list[Any] = ..., ahead: float = ..., aside: float = ..., pillar: float = ..., augment: bool = ..., epochs: int = ..., iters: int = ..., max_steps: int = ..., batch_size: int = ..., accumulate: int = ..., batches_per_iter: int = ..., lr: float = ..., optimizer: Literal['adamw', 'adam', 'sgd', 'rmsprop'] = ..., optimizer_name: Literal['adamw', 'adam', 'sgd', 'rmsprop'] = ..., momentum: float = ..., weight_decay: float = ..., lr_schedule: Literal['constant', 'step', 'cosine', 'linear'] = ..., warmup_steps: int = ..., warmup_ratio: float = ..., lr_min: float = ..., lr_schedule_eta_min: float = ..., lr_steps: list[Any] = ..., drop_after_epoch: list[Any] = ..., lr_gamma: float = ..., lr_decay: float = ..., grad_clip: float = ..., ema: float = ..., early_stop: int = ..., val_after: int = ..., checkpoint_after_iter: int = ..., checkpoint_minutes: float = ..., checkpoints_kept: int = ..., log_after: int = ..., num_workers: int = ..., seed: int = ...) -> dict[str, Any]: ...
    def eval(self, dataset: Dataset, ground_truth_annotations: Any = ..., logging_path: Any = ..., silent: Any = ..., verbose: bool = ..., image_shape: Any = ..., count: Optional[int] = ..., *, metric: Optional[str] = ..., split: Optional[str] = ..., limit: Optional[int] = ..., out: Optional[PathLike] = ..., skip_broken: bool = ..., classes: Optional[Mapping[str, str]] = ..., by_number: bool = ..., resamples: int = ..., **metric_params: Any) -> dict[str, Any]: ...
    def optimize(self, do_constant_folding: Any = ..., *, target_device: str = ..., out: Optional[PathLike] = ..., precision: str = ..., calibration: Union[None, Dataset] = ..., validation: Union[None, Dataset] = ..., verbose: bool = ..., **options: Any) -> dict[str, Any]: ...
    @classmethod
    def download(cls, model_name: Any = ..., path: Optional[PathLike] = ..., server_url: Optional[str] = ..., *, mode: str = ..., verbose: bool = ..., url: Optional[str] = ..., variant: Optional[str] = ...) -> str: ...
