"""Learners of the task panoptic_segmentation. Made by bindings/python/stubs.py; do not edit."""

# Each learner has the arguments of OpenDR's class of its name.
# mypy: disable-error-code="override"
# pyright: reportIncompatibleMethodOverride=false

import os
from collections.abc import Iterator, Mapping, Sequence
from typing import Any, Literal, NamedTuple, NoReturn, Optional, Union, overload

from numpy.typing import ArrayLike, NDArray
from opendr._upstream.segmentation_datasets import CityscapesDataset as CityscapesDataset
from opendr._upstream.segmentation_datasets import KittiDataset as KittiDataset
from opendr._upstream.segmentation_datasets import SemanticKittiDataset as SemanticKittiDataset
from opendr._native_learner import NativeLearner, PathLike
from opendr._upstream.learners.scenes import PanopticPictures
from opendr.engine.data import Image, PointCloud
from opendr.engine.datasets import Dataset
from opendr.engine.learners import Learner
from opendr.engine.target import Heatmap

class EfficientPsLearnerOutputs(NamedTuple):
    instance: Heatmap
    semantic: Heatmap

class EfficientPsLearner(PanopticPictures):
    """Tells class and object of every pixel, by fusing DeepLab, CenterNet and BodyPix.

    Task: panoptic_segmentation. ``infer`` takes:

        image: Image.

    and gives: Heatmap, Heatmap.

    Args:
        threshold: Objects below this score are dropped. (default 0.3; 0 to 1; may change while running, also for
            one call of infer)
        box_masks: Whether objects of classes that no map of classes knows are the whole of their boxes; else they
            are left out. (default True; may change while running, also for one call of infer)
        min_overlap: Objects are dropped of whose box the map of classes confirms a smaller share. (default 0.1; 0
            to 1; may change while running, also for one call of infer)
        min_leftover: Regions of a countable class outside of all boxes are objects from this share of the picture
            on. (default 0.1; 0 to 1; may change while running, also for one call of infer)
        min_stuff: Regions that are not countable are told from this share of the picture on. (default 0.02; 0 to
            1; may change while running, also for one call of infer)
        others: OpenDR's arguments, see ``opendr.engine.learners.BaseLearner``.

    Arguments of OpenDR that are taken and have no effect:
        config_file: no effect: there is no network of its own to configure.
        lr: no effect: it belongs to training, which this learner does not have.
        iters: no effect: it belongs to training, which this learner does not have.
        batch_size: no effect: it belongs to training, which this learner does not have.
        optimizer: no effect: it belongs to training, which this learner does not have.
        lr_schedule: no effect: it belongs to training, which this learner does not have.
        momentum: no effect: it belongs to training, which this learner does not have.
        weight_decay: no effect: it belongs to training, which this learner does not have.
        optimizer_config: no effect: it belongs to training, which this learner does not have.
        checkpoint_after_iter: no effect: it belongs to training, which this learner does not have.
        num_workers: no effect: it belongs to training, which this learner does not have.
        seed: no effect: it belongs to training, which this learner does not have.
    """

    box_masks: bool
    min_overlap: float
    min_leftover: float
    min_stuff: float
    def __init__(self, config_file: Any = ..., lr: float = ..., iters: int = ..., batch_size: int = ..., optimizer: str = ..., lr_schedule: str = ..., momentum: Any = ..., weight_decay: Any = ..., optimizer_config: Any = ..., checkpoint_after_iter: int = ..., temp_path: str = ..., device: str = ..., num_workers: Any = ..., seed: Any = ..., *, backbone: str = ..., network_head: str = ..., checkpoint_load_iter: int = ..., threshold: float = ..., scale: float = ..., box_masks: bool = ..., min_overlap: float = ..., min_leftover: float = ..., min_stuff: float = ...) -> None: ...
    @overload
    def infer(self, image: Union[Image, NDArray[Any], str, os.PathLike[str]], return_raw_logits: Any = ..., *, threshold: float = ..., box_masks: bool = ..., min_overlap: float = ..., min_leftover: float = ..., min_stuff: float = ..., config_file: Any = ..., lr: Any = ..., iters: Any = ..., batch_size: Any = ..., optimizer: Any = ..., lr_schedule: Any = ..., momentum: Any = ..., weight_decay: Any = ..., optimizer_config: Any = ..., checkpoint_after_iter: Any = ..., num_workers: Any = ..., seed: Any = ...) -> EfficientPsLearnerOutputs: ...  # type: ignore[overload-overlap]
    @overload
    def infer(self, image: Sequence[Union[Image, NDArray[Any], str, os.PathLike[str]]], return_raw_logits: Any = ..., *, threshold: float = ..., box_masks: bool = ..., min_overlap: float = ..., min_leftover: float = ..., min_stuff: float = ..., config_file: Any = ..., lr: Any = ..., iters: Any = ..., batch_size: Any = ..., optimizer: Any = ..., lr_schedule: Any = ..., momentum: Any = ..., weight_decay: Any = ..., optimizer_config: Any = ..., checkpoint_after_iter: Any = ..., num_workers: Any = ..., seed: Any = ...) -> list[EfficientPsLearnerOutputs]: ...
    @overload
    def infer(self, image: Iterator[Union[Image, NDArray[Any], str, os.PathLike[str]]], return_raw_logits: Any = ..., *, threshold: float = ..., box_masks: bool = ..., min_overlap: float = ..., min_leftover: float = ..., min_stuff: float = ..., config_file: Any = ..., lr: Any = ..., iters: Any = ..., batch_size: Any = ..., optimizer: Any = ..., lr_schedule: Any = ..., momentum: Any = ..., weight_decay: Any = ..., optimizer_config: Any = ..., checkpoint_after_iter: Any = ..., num_workers: Any = ..., seed: Any = ...) -> Iterator[EfficientPsLearnerOutputs]: ...
    def eval(self, dataset: Dataset, print_results: bool = ..., *, metric: Optional[str] = ..., split: Optional[str] = ..., limit: Optional[int] = ..., out: Optional[PathLike] = ..., skip_broken: bool = ..., classes: Optional[Mapping[str, str]] = ..., by_number: bool = ..., resamples: int = ..., verbose: bool = ..., **metric_params: Any) -> dict[str, Any]: ...
    @classmethod
    def download(cls, path: Optional[PathLike] = ..., mode: str = ..., trained_on: Any = ..., *, verbose: bool = ..., url: Optional[str] = ..., variant: Optional[str] = ...) -> str: ...

class EfficientLpsLearnerOutputs(NamedTuple):
    instance: Heatmap
    semantic: Heatmap
    depth: Heatmap

class EfficientLpsLearner(NativeLearner):
    """Tells class and object of every point of a lidar's scan; it trains on labelled scans.

    Task: panoptic_segmentation. ``infer`` takes:

        point_cloud: PointCloud. What the lidar saw; a PointCloudWithCalibration places the boxes in its camera's
            frame and picture.

    and gives: Heatmap, Heatmap, Heatmap.

    Args:
        things: The classes whose objects are told apart; a model brings those that it was trained with. (default
            [])
        projected: Whether the answers are maps of the range image's size instead of a number for each point.
            (default False; may change while running, also for one call of infer)
        max_gap: Points of neighbouring pixels farther apart than this are of two objects. (default 0.8; 0.01 to
            10 m; may change while running, also for one call of infer)
        min_points: Objects of fewer pixels are not told. (default 5; 1 to 100000; may change while running, also
            for one call of infer)
        others: OpenDR's arguments, see ``opendr.engine.learners.BaseLearner``.

    Parameters of ``fit``, for one call or, given here, for all of them:
        rows: Rows of the range image, a multiple of 8. (default 64; 8 to 1024)
        columns: Columns of the range image, a multiple of 8. (default 512; 8 to 8192)
        fov_up: Its upper edge above the horizon. (default 2.5; -90 to 90 deg)
        fov_down: Its lower edge. (default -25.0; -90 to 90 deg)
        half_view: How far it looks to either side; 180 for a full turn. (default 45.0; 1 to 180 deg)
        width: Channels of the first layer; the last of the way down has eight times as many. (default 16; 2 to
            128)
        epochs: How often the data set is gone through. (default 40; 1 to 1e+06; in OpenDR iters)
        max_steps: Optimiser steps after which training ends, whatever the number of epochs; 0 for no limit.
            (default 0; 0 to 1e+09)
        batch_size: Samples a batch. (default 4; 1 to 65536)
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
        warmup_steps: Steps over which the learning rate rises from `warmup_ratio` of itself. (default 0; 0 to
            1e+08)
        warmup_ratio: What share of the learning rate the warm-up begins with. (default 0.1; 0 to 1)
        lr_min: Learning rate at the end of `cosine` and `linear`. (default 0.0; 0 to 100; in OpenDR
            lr_schedule_eta_min)
        lr_steps: Epochs at which `step` lowers the learning rate. (default []; in OpenDR drop_after_epoch)
        lr_gamma: What `step` multiplies the learning rate with. (default 0.1; 0 to 1; in OpenDR lr_decay)
        grad_clip: Gradients whose norm over all weights is above this are scaled down to it; 0 for no limit.
            (default 0.0; 0 to 1e+09)
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
        num_workers: Threads that read and augment samples. (default 2; 0 to 1024)
        seed: What first weights, order, augmentation and dropout follow from. (default 0)

    Arguments of OpenDR that are taken and have no effect:
        config_file: no effect: what it needs to know stands in the model.
    """

    things: list[Any]
    projected: bool
    max_gap: float
    min_points: int
    def __init__(self, config_file: Any = ..., lr: float = ..., iters: int = ..., batch_size: int = ..., optimizer: Literal['adamw', 'adam', 'sgd', 'rmsprop'] = ..., lr_schedule: Literal['constant', 'step', 'cosine', 'linear'] = ..., momentum: float = ..., weight_decay: float = ..., optimizer_config: Any = ..., checkpoint_after_iter: int = ..., temp_path: str = ..., device: str = ..., num_workers: int = ..., seed: int = ..., *, backbone: str = ..., network_head: str = ..., checkpoint_load_iter: int = ..., threshold: float = ..., scale: float = ..., rows: int = ..., columns: int = ..., fov_up: float = ..., fov_down: float = ..., half_view: float = ..., width: int = ..., epochs: int = ..., max_steps: int = ..., accumulate: int = ..., batches_per_iter: int = ..., optimizer_name: Literal['adamw', 'adam', 'sgd', 'rmsprop'] = ..., warmup_steps: int = ..., warmup_ratio: float = ..., lr_min: float = ..., lr_schedule_eta_min: float = ..., lr_steps: list[Any] = ..., drop_after_epoch: list[Any] = ..., lr_gamma: float = ..., lr_decay: float = ..., grad_clip: float = ..., ema: float = ..., early_stop: int = ..., val_after: int = ..., checkpoint_minutes: float = ..., checkpoints_kept: int = ..., log_after: int = ..., things: list[Any] = ..., projected: bool = ..., max_gap: float = ..., min_points: int = ...) -> None: ...
    @overload
    def infer(self, point_cloud: Union[PointCloud, ArrayLike], return_raw_logits: Any = ..., projected: bool = ..., *, max_gap: float = ..., min_points: int = ..., config_file: Any = ...) -> EfficientLpsLearnerOutputs: ...  # type: ignore[overload-overlap]
    @overload
    def infer(self, point_cloud: Sequence[Union[PointCloud, ArrayLike]], return_raw_logits: Any = ..., projected: bool = ..., *, max_gap: float = ..., min_points: int = ..., config_file: Any = ...) -> list[EfficientLpsLearnerOutputs]: ...
    @overload
    def infer(self, point_cloud: Iterator[Union[PointCloud, ArrayLike]], return_raw_logits: Any = ..., projected: bool = ..., *, max_gap: float = ..., min_points: int = ..., config_file: Any = ...) -> Iterator[EfficientLpsLearnerOutputs]: ...
    def fit(self, dataset: Dataset, val_dataset: Optional[Dataset] = ..., logging_path: PathLike = ..., silent: bool = ..., verbose: bool = ..., *, out: Optional[PathLike] = ..., resume: bool = ..., split: Optional[str] = ..., val_split: Optional[str] = ..., limit: Optional[int] = ..., teacher: Union[None, str, Learner] = ..., teacher_threshold: Optional[float] = ..., teacher_classes: Sequence[str] = ..., teacher_map: Optional[Mapping[str, str]] = ..., teacher_by_number: bool = ..., keep_empty: bool = ..., skip_broken: bool = ..., rows: int = ..., columns: int = ..., fov_up: float = ..., fov_down: float = ..., half_view: float = ..., width: int = ..., epochs: int = ..., iters: int = ..., max_steps: int = ..., batch_size: int = ..., accumulate: int = ..., batches_per_iter: int = ..., lr: float = ..., optimizer: Literal['adamw', 'adam', 'sgd', 'rmsprop'] = ..., optimizer_name: Literal['adamw', 'adam', 'sgd', 'rmsprop'] = ..., momentum: float = ..., weight_decay: float = ..., lr_schedule: Literal['constant', 'step', 'cosine', 'linear'] = ..., warmup_steps: int = ..., warmup_ratio: float = ..., lr_min: float = ..., lr_schedule_eta_min: float = ..., lr_steps: list[Any] = ..., drop_after_epoch: list[Any] = ..., lr_gamma: float = ..., lr_decay: float = ..., grad_clip: float = ..., ema: float = ..., early_stop: int = ..., val_after: int = ..., checkpoint_after_iter: int = ..., checkpoint_minutes: float = ..., checkpoints_kept: int = ..., log_after: int = ..., num_workers: int = ..., seed: int = ...) -> dict[str, Any]: ...
    def eval(self, dataset: Dataset, print_results: bool = ..., *, metric: Optional[str] = ..., split: Optional[str] = ..., limit: Optional[int] = ..., out: Optional[PathLike] = ..., skip_broken: bool = ..., classes: Optional[Mapping[str, str]] = ..., by_number: bool = ..., resamples: int = ..., verbose: bool = ..., **metric_params: Any) -> dict[str, Any]: ...
    @classmethod
    def download(cls, path: Optional[PathLike] = ..., mode: str = ..., trained_on: Any = ..., *, verbose: bool = ..., url: Optional[str] = ..., variant: Optional[str] = ...) -> str: ...
    def visualize(self, *args: Any, **kwargs: Any) -> NoReturn: ...
