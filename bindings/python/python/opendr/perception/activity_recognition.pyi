"""Learners of the task activity_recognition. Made by bindings/python/stubs.py; do not edit."""

# Each learner has the arguments of OpenDR's class of its name.
# mypy: disable-error-code="override"
# pyright: reportIncompatibleMethodOverride=false

import os
from collections.abc import Iterator, Mapping, Sequence
from typing import Any, Literal, NamedTuple, NoReturn, Optional, Union, overload

from numpy.typing import ArrayLike, NDArray
from opendr._upstream.video_datasets import DummyTimeseriesDataset as DummyTimeseriesDataset
from opendr._upstream.video_datasets import KineticsDataset as KineticsDataset
from opendr._native_learner import NativeLearner, PathLike
from opendr.engine.data import Image, Video
from opendr.engine.datasets import Dataset
from opendr.engine.learners import Learner
from opendr.engine.target import Category

class X3DLearner(NativeLearner):
    """X3D tells what persons do in a clip; it trains.

    Task: activity_recognition. ``infer`` takes:

        video: Video.

    and gives: Category.

    Args:
        backbone: Frames of a clip, pixels of a frame and depth of the network, where nothing else is given.
            (default 's'; one of 's', 'xs', 'm', 'l')
        num_classes: Classes. None: as many as the data name. (default None; 2 to 10000)
        num_frames: Frames of a clip, taken evenly from it. None: as the backbone has. (default None; 1 to 256)
        side: Pixels of a side of a frame. None: as the backbone has. (default None; 32 to 1024 px)
        width: Factor on the channels. (default 1.0; 0.1 to 8)
        depth: Factor on the number of blocks. None: as the backbone has. (default None; 0.1 to 8)
        others: OpenDR's arguments, see ``opendr.engine.learners.BaseLearner``.

    Parameters of ``fit``, for one call or, given here, for all of them:
        epochs: How often the data set is gone through. (default 10; 1 to 1e+06; in OpenDR iters)
        max_steps: Optimiser steps after which training ends, whatever the number of epochs; 0 for no limit.
            (default 0; 0 to 1e+09)
        batch_size: Samples a batch. (default 64; 1 to 65536)
        accumulate: Batches whose gradients are added up for one step of the optimiser. (default 1; 1 to 4096; in
            OpenDR batches_per_iter)
        lr: Learning rate at its highest. (default 0.001; 0 to 100)
        optimizer: What turns gradients into steps. (default 'adam'; one of 'adamw', 'adam', 'sgd', 'rmsprop'; in
            OpenDR optimizer_name)
        momentum: Momentum of `sgd` and `rmsprop`. (default 0.9; 0 to 1)
        weight_decay: Weight decay: decoupled from the gradient in `adamw`, added to it in the others. (default
            1e-05; 0 to 10)
        lr_schedule: How the learning rate goes on after the warm-up. (default 'constant'; one of 'constant',
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
        seed: What first weights, order, augmentation and dropout follow from. (default 123)
        dropout: Share of values before the last layer that are left out at random in each training step. (default
            0.5; 0 to 0.99)
        augment: Whether clips are mirrored at random. (default True)

    Arguments of OpenDR that are taken and have no effect:
        network_head: no effect: it classifies.
        loss: no effect: it is the cross-entropy.
        drop_last: no effect: a last batch that is not full is always left out.
        pin_memory: no effect: there is no such memory.
    """

    num_classes: Optional[int]
    num_frames: Optional[int]
    side: Optional[int]
    width: float
    depth: Optional[float]
    def __init__(self, lr: float = ..., iters: int = ..., batch_size: int = ..., optimizer: Literal['adamw', 'adam', 'sgd', 'rmsprop'] = ..., lr_schedule: Literal['constant', 'step', 'cosine', 'linear'] = ..., backbone: Literal['s', 'xs', 'm', 'l'] = ..., network_head: str = ..., checkpoint_after_iter: int = ..., checkpoint_load_iter: int = ..., temp_path: str = ..., device: str = ..., loss: Any = ..., weight_decay: float = ..., momentum: float = ..., drop_last: Any = ..., pin_memory: Any = ..., num_workers: int = ..., seed: int = ..., num_classes: Optional[int] = ..., *, threshold: float = ..., scale: float = ..., epochs: int = ..., max_steps: int = ..., accumulate: int = ..., batches_per_iter: int = ..., optimizer_name: Literal['adamw', 'adam', 'sgd', 'rmsprop'] = ..., warmup_steps: int = ..., warmup_ratio: float = ..., lr_min: float = ..., lr_schedule_eta_min: float = ..., lr_steps: list[Any] = ..., drop_after_epoch: list[Any] = ..., lr_gamma: float = ..., lr_decay: float = ..., grad_clip: float = ..., ema: float = ..., early_stop: int = ..., val_after: int = ..., checkpoint_minutes: float = ..., checkpoints_kept: int = ..., log_after: int = ..., dropout: float = ..., augment: bool = ..., num_frames: Optional[int] = ..., side: Optional[int] = ..., width: float = ..., depth: Optional[float] = ...) -> None: ...
    @overload
    def infer(self, video: Union[Video, ArrayLike], *, network_head: Any = ..., loss: Any = ..., drop_last: Any = ..., pin_memory: Any = ...) -> Category: ...  # type: ignore[overload-overlap]
    @overload
    def infer(self, video: Sequence[Union[Video, ArrayLike]], *, network_head: Any = ..., loss: Any = ..., drop_last: Any = ..., pin_memory: Any = ...) -> list[Category]: ...
    @overload
    def infer(self, video: Iterator[Union[Video, ArrayLike]], *, network_head: Any = ..., loss: Any = ..., drop_last: Any = ..., pin_memory: Any = ...) -> Iterator[Category]: ...
    def fit(self, dataset: Dataset, val_dataset: Optional[Dataset] = ..., epochs: int = ..., steps: Any = ..., *, logging_path: PathLike = ..., silent: bool = ..., verbose: bool = ..., out: Optional[PathLike] = ..., resume: bool = ..., split: Optional[str] = ..., val_split: Optional[str] = ..., limit: Optional[int] = ..., teacher: Union[None, str, Learner] = ..., teacher_threshold: Optional[float] = ..., teacher_classes: Sequence[str] = ..., teacher_map: Optional[Mapping[str, str]] = ..., teacher_by_number: bool = ..., keep_empty: bool = ..., skip_broken: bool = ..., iters: int = ..., max_steps: int = ..., batch_size: int = ..., accumulate: int = ..., batches_per_iter: int = ..., lr: float = ..., optimizer: Literal['adamw', 'adam', 'sgd', 'rmsprop'] = ..., optimizer_name: Literal['adamw', 'adam', 'sgd', 'rmsprop'] = ..., momentum: float = ..., weight_decay: float = ..., lr_schedule: Literal['constant', 'step', 'cosine', 'linear'] = ..., warmup_steps: int = ..., warmup_ratio: float = ..., lr_min: float = ..., lr_schedule_eta_min: float = ..., lr_steps: list[Any] = ..., drop_after_epoch: list[Any] = ..., lr_gamma: float = ..., lr_decay: float = ..., grad_clip: float = ..., ema: float = ..., early_stop: int = ..., val_after: int = ..., checkpoint_after_iter: int = ..., checkpoint_minutes: float = ..., checkpoints_kept: int = ..., log_after: int = ..., num_workers: int = ..., seed: int = ..., dropout: float = ..., augment: bool = ...) -> dict[str, Any]: ...
    def eval(self, dataset: Dataset, steps: Optional[int] = ..., *, metric: Optional[str] = ..., split: Optional[str] = ..., limit: Optional[int] = ..., out: Optional[PathLike] = ..., skip_broken: bool = ..., classes: Optional[Mapping[str, str]] = ..., by_number: bool = ..., resamples: int = ..., verbose: bool = ..., **metric_params: Any) -> dict[str, Any]: ...
    def optimize(self, do_constant_folding: Any = ..., *, target_device: str = ..., out: Optional[PathLike] = ..., precision: str = ..., calibration: Union[None, Dataset] = ..., validation: Union[None, Dataset] = ..., verbose: bool = ..., **options: Any) -> dict[str, Any]: ...
    @classmethod
    def download(cls, path: Optional[PathLike] = ..., model_names: Any = ..., *, mode: str = ..., verbose: bool = ..., url: Optional[str] = ..., variant: Optional[str] = ...) -> str: ...

class CoX3DLearner(NativeLearner):
    """CoX3D tells after every picture of a video what persons do; it trains.

    Task: activity_recognition. ``infer`` takes:

        image: Image.

    and gives: Category.

    Args:
        backbone: Frames of a clip, pixels of a frame and depth of the network, where nothing else is given.
            (default 's'; one of 's', 'xs', 'm', 'l')
        num_classes: Classes. None: as many as the data name. (default None; 2 to 10000)
        temporal_window_size: Frames that an answer is averaged over. None: as the backbone has. (default None; 1
            to 256)
        side: Pixels of a side of a frame. None: as the backbone has. (default None; 32 to 1024 px)
        width: Factor on the channels. (default 1.0; 0.1 to 8)
        depth: Factor on the number of blocks. None: as the backbone has. (default None; 0.1 to 8)
        others: OpenDR's arguments, see ``opendr.engine.learners.BaseLearner``.

    Parameters of ``fit``, for one call or, given here, for all of them:
        epochs: How often the data set is gone through. (default 10; 1 to 1e+06; in OpenDR iters)
        max_steps: Optimiser steps after which training ends, whatever the number of epochs; 0 for no limit.
            (default 0; 0 to 1e+09)
        batch_size: Samples a batch. (default 64; 1 to 65536)
        accumulate: Batches whose gradients are added up for one step of the optimiser. (default 1; 1 to 4096; in
            OpenDR batches_per_iter)
        lr: Learning rate at its highest. (default 0.001; 0 to 100)
        optimizer: What turns gradients into steps. (default 'adam'; one of 'adamw', 'adam', 'sgd', 'rmsprop'; in
            OpenDR optimizer_name)
        momentum: Momentum of `sgd` and `rmsprop`. (default 0.9; 0 to 1)
        weight_decay: Weight decay: decoupled from the gradient in `adamw`, added to it in the others. (default
            1e-05; 0 to 10)
        lr_schedule: How the learning rate goes on after the warm-up. (default 'constant'; one of 'constant',
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
        seed: What first weights, order, augmentation and dropout follow from. (default 123)
        dropout: Share of values before the last layer that are left out at random in each training step. (default
            0.5; 0 to 0.99)
        augment: Whether clips are mirrored at random. (default True)

    Arguments of OpenDR that are taken and have no effect:
        network_head: no effect: it classifies.
        loss: no effect: it is the cross-entropy.
        drop_last: no effect: a last batch that is not full is always left out.
        pin_memory: no effect: there is no such memory.
    """

    num_classes: Optional[int]
    temporal_window_size: Optional[int]
    side: Optional[int]
    width: float
    depth: Optional[float]
    def __init__(self, lr: float = ..., iters: int = ..., batch_size: int = ..., optimizer: Literal['adamw', 'adam', 'sgd', 'rmsprop'] = ..., lr_schedule: Literal['constant', 'step', 'cosine', 'linear'] = ..., backbone: Literal['s', 'xs', 'm', 'l'] = ..., network_head: str = ..., checkpoint_after_iter: int = ..., checkpoint_load_iter: int = ..., temp_path: str = ..., device: str = ..., loss: Any = ..., weight_decay: float = ..., momentum: float = ..., drop_last: Any = ..., pin_memory: Any = ..., num_workers: int = ..., seed: int = ..., num_classes: Optional[int] = ..., temporal_window_size: Optional[int] = ..., *, threshold: float = ..., scale: float = ..., epochs: int = ..., max_steps: int = ..., accumulate: int = ..., batches_per_iter: int = ..., optimizer_name: Literal['adamw', 'adam', 'sgd', 'rmsprop'] = ..., warmup_steps: int = ..., warmup_ratio: float = ..., lr_min: float = ..., lr_schedule_eta_min: float = ..., lr_steps: list[Any] = ..., drop_after_epoch: list[Any] = ..., lr_gamma: float = ..., lr_decay: float = ..., grad_clip: float = ..., ema: float = ..., early_stop: int = ..., val_after: int = ..., checkpoint_minutes: float = ..., checkpoints_kept: int = ..., log_after: int = ..., dropout: float = ..., augment: bool = ..., side: Optional[int] = ..., width: float = ..., depth: Optional[float] = ...) -> None: ...
    @overload
    def infer(self, image: Union[Image, NDArray[Any], str, os.PathLike[str]], *, network_head: Any = ..., loss: Any = ..., drop_last: Any = ..., pin_memory: Any = ...) -> Category: ...  # type: ignore[overload-overlap]
    @overload
    def infer(self, image: Sequence[Union[Image, NDArray[Any], str, os.PathLike[str]]], *, network_head: Any = ..., loss: Any = ..., drop_last: Any = ..., pin_memory: Any = ...) -> list[Category]: ...
    @overload
    def infer(self, image: Iterator[Union[Image, NDArray[Any], str, os.PathLike[str]]], *, network_head: Any = ..., loss: Any = ..., drop_last: Any = ..., pin_memory: Any = ...) -> Iterator[Category]: ...
    def fit(self, dataset: Dataset, val_dataset: Optional[Dataset] = ..., epochs: int = ..., steps: Any = ..., *, logging_path: PathLike = ..., silent: bool = ..., verbose: bool = ..., out: Optional[PathLike] = ..., resume: bool = ..., split: Optional[str] = ..., val_split: Optional[str] = ..., limit: Optional[int] = ..., teacher: Union[None, str, Learner] = ..., teacher_threshold: Optional[float] = ..., teacher_classes: Sequence[str] = ..., teacher_map: Optional[Mapping[str, str]] = ..., teacher_by_number: bool = ..., keep_empty: bool = ..., skip_broken: bool = ..., iters: int = ..., max_steps: int = ..., batch_size: int = ..., accumulate: int = ..., batches_per_iter: int = ..., lr: float = ..., optimizer: Literal['adamw', 'adam', 'sgd', 'rmsprop'] = ..., optimizer_name: Literal['adamw', 'adam', 'sgd', 'rmsprop'] = ..., momentum: float = ..., weight_decay: float = ..., lr_schedule: Literal['constant', 'step', 'cosine', 'linear'] = ..., warmup_steps: int = ..., warmup_ratio: float = ..., lr_min: float = ..., lr_schedule_eta_min: float = ..., lr_steps: list[Any] = ..., drop_after_epoch: list[Any] = ..., lr_gamma: float = ..., lr_decay: float = ..., grad_clip: float = ..., ema: float = ..., early_stop: int = ..., val_after: int = ..., checkpoint_after_iter: int = ..., checkpoint_minutes: float = ..., checkpoints_kept: int = ..., log_after: int = ..., num_workers: int = ..., seed: int = ..., dropout: float = ..., augment: bool = ...) -> dict[str, Any]: ...
    def eval(self, dataset: Dataset, steps: Optional[int] = ..., *, metric: Optional[str] = ..., split: Optional[str] = ..., limit: Optional[int] = ..., out: Optional[PathLike] = ..., skip_broken: bool = ..., classes: Optional[Mapping[str, str]] = ..., by_number: bool = ..., resamples: int = ..., verbose: bool = ..., **metric_params: Any) -> dict[str, Any]: ...
    def optimize(self, do_constant_folding: Any = ..., *, target_device: str = ..., out: Optional[PathLike] = ..., precision: str = ..., calibration: Union[None, Dataset] = ..., validation: Union[None, Dataset] = ..., verbose: bool = ..., **options: Any) -> dict[str, Any]: ...
    @classmethod
    def download(cls, path: Optional[PathLike] = ..., model_names: Any = ..., *, mode: str = ..., verbose: bool = ..., url: Optional[str] = ..., variant: Optional[str] = ...) -> str: ...

class CLASSES:
    """Not here yet: `classes` of the loaded learner names what it tells."""

    def __init__(self, *args: Any, **kwargs: Any) -> NoReturn: ...

class CoTransEncLearner:
    """Not here yet: use GatedRecurrentUnitLearner of heart_anomaly_detection for classes of time series."""

    def __init__(self, *args: Any, **kwargs: Any) -> NoReturn: ...
