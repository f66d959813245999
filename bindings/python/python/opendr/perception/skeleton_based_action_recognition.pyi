"""Learners of the task skeleton_based_action_recognition. Made by bindings/python/stubs.py; do not edit."""

# Each learner has the arguments of OpenDR's class of its name.
# mypy: disable-error-code="override"
# pyright: reportIncompatibleMethodOverride=false

import os
from collections.abc import Iterator, Mapping, Sequence
from typing import Any, Literal, NamedTuple, NoReturn, Optional, Union, overload

from numpy.typing import ArrayLike, NDArray
from opendr._native_learner import NativeLearner, PathLike
from opendr.engine.data import SkeletonSequence
from opendr.engine.datasets import Dataset
from opendr.engine.learners import Learner
from opendr.engine.target import Category

class SpatioTemporalGCNLearner(NativeLearner):
    """ST-GCN tells what a person does from a clip of its moving skeleton; it trains.

    Task: skeleton_based_action_recognition. ``infer`` takes:

        skeleton_sequence: SkeletonSequence.

    and gives: Category.

    Args:
        num_class: Classes. None: as many as the data name. (default None; 2 to 10000)
        num_point: Joints. None: as many as the graph has. (default None; 2 to 1000)
        num_person: Persons of a recording that are looked at, the first ones; the answer is the mean over those
            that are there. (default 2; 1 to 64)
        in_channels: Coordinates of a joint: 2 (a third channel, where there is one, holds scores) or 3. (default
            3; 2 to 3)
        graph_type: Joints and bones. (default 'ntu'; one of 'ntu', 'kinetics', 'coco', 'jhmdb')
        method_name: The network. (default 'stgcn'; one of 'stgcn')
        num_frames: Frames of a clip: the last of a longer recording; in a shorter one, the person stands still
            before it. (default 300; 1 to 10000)
        channels: Channels of each block. (default [64, 64, 64, 64, 128, 128, 128, 256, 256, 256]; 1 to 4096)
        temporal_kernel: Frames that a block sees; odd. (default 9; 3 to 101)
        others: OpenDR's arguments, see ``opendr.engine.learners.BaseLearner``.

    Parameters of ``fit``, for one call or, given here, for all of them:
        epochs: How often the data set is gone through. (default 50; 1 to 1e+06; in OpenDR iters)
        max_steps: Optimiser steps after which training ends, whatever the number of epochs; 0 for no limit.
            (default 0; 0 to 1e+09)
        batch_size: Samples a batch. (default 128; 1 to 65536)
        accumulate: Batches whose gradients are added up for one step of the optimiser. (default 1; 1 to 4096; in
            OpenDR batches_per_iter)
        lr: Learning rate at its highest. (default 0.1; 0 to 100)
        optimizer: What turns gradients into steps. (default 'sgd'; one of 'adamw', 'adam', 'sgd', 'rmsprop'; in
            OpenDR optimizer_name)
        momentum: Momentum of `sgd` and `rmsprop`. (default 0.9; 0 to 1)
        weight_decay: Weight decay: decoupled from the gradient in `adamw`, added to it in the others. (default
            0.0001; 0 to 10)
        lr_schedule: How the learning rate goes on after the warm-up. (default 'step'; one of 'constant', 'step',
            'cosine', 'linear')
        warmup_steps: Steps over which the learning rate rises from `warmup_ratio` of itself. (default 0; 0 to
            1e+08)
        warmup_ratio: What share of the learning rate the warm-up begins with. (default 0.1; 0 to 1)
        lr_min: Learning rate at the end of `cosine` and `linear`. (default 0.0; 0 to 100; in OpenDR
            lr_schedule_eta_min)
        lr_steps: Epochs at which `step` lowers the learning rate. (default [30, 40]; in OpenDR drop_after_epoch)
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
        dropout: Share of values between layers that are left out at random in each training step. (default 0.0; 0
            to 0.99)
        label_smoothing: Share of the other classes, all alike, in what the network is to say of a clip. (default
            0.0; 0 to 0.9)
        augment: Whether skeletons are mirrored, leant, stretched, cut in time and played slower or faster, at
            random. (default True)

    Arguments of OpenDR that are taken and have no effect:
        experiment_name: no effect: the folder of a training says it.
        device_ind: no effect: `device` says it.
        val_batch_size: no effect: validation asks the learner, clip by clip.
        start_epoch: no effect: `resume` of `fit` goes on where a training was.
        dataset_name: no effect: the data set says it.
        stbln_symmetric: no effect: there is no bilinear network.
        num_subframes: no effect: only networks with temporal attention choose frames.
    """

    num_class: Optional[int]
    num_point: Optional[int]
    num_person: int
    in_channels: int
    graph_type: Literal['ntu', 'kinetics', 'coco', 'jhmdb']
    method_name: Literal['stgcn']
    num_frames: int
    channels: list[Any]
    temporal_kernel: int
    def __init__(self, lr: float = ..., batch_size: int = ..., optimizer_name: Literal['adamw', 'adam', 'sgd', 'rmsprop'] = ..., lr_schedule: Literal['constant', 'step', 'cosine', 'linear'] = ..., checkpoint_after_iter: int = ..., checkpoint_load_iter: int = ..., temp_path: str = ..., device: str = ..., num_workers: int = ..., epochs: int = ..., experiment_name: Any = ..., device_ind: Any = ..., val_batch_size: Any = ..., drop_after_epoch: list[Any] = ..., start_epoch: Any = ..., dataset_name: Any = ..., num_class: Optional[int] = ..., num_point: Optional[int] = ..., num_person: int = ..., in_channels: int = ..., graph_type: Literal['ntu', 'kinetics', 'coco', 'jhmdb'] = ..., method_name: Literal['stgcn'] = ..., stbln_symmetric: Any = ..., num_frames: int = ..., num_subframes: Any = ..., *, iters: int = ..., optimizer: Literal['adamw', 'adam', 'sgd', 'rmsprop'] = ..., backbone: str = ..., network_head: str = ..., threshold: float = ..., scale: float = ..., max_steps: int = ..., accumulate: int = ..., batches_per_iter: int = ..., momentum: float = ..., weight_decay: float = ..., warmup_steps: int = ..., warmup_ratio: float = ..., lr_min: float = ..., lr_schedule_eta_min: float = ..., lr_steps: list[Any] = ..., lr_gamma: float = ..., lr_decay: float = ..., grad_clip: float = ..., ema: float = ..., early_stop: int = ..., val_after: int = ..., checkpoint_minutes: float = ..., checkpoints_kept: int = ..., log_after: int = ..., seed: int = ..., dropout: float = ..., label_smoothing: float = ..., augment: bool = ..., channels: list[Any] = ..., temporal_kernel: int = ...) -> None: ...
    @overload
    def infer(self, skeleton_sequence: Union[SkeletonSequence, ArrayLike], *, experiment_name: Any = ..., device_ind: Any = ..., val_batch_size: Any = ..., start_epoch: Any = ..., dataset_name: Any = ..., stbln_symmetric: Any = ..., num_subframes: Any = ...) -> Category: ...  # type: ignore[overload-overlap]
    @overload
    def infer(self, skeleton_sequence: Sequence[Union[SkeletonSequence, ArrayLike]], *, experiment_name: Any = ..., device_ind: Any = ..., val_batch_size: Any = ..., start_epoch: Any = ..., dataset_name: Any = ..., stbln_symmetric: Any = ..., num_subframes: Any = ...) -> list[Category]: ...
    @overload
    def infer(self, skeleton_sequence: Iterator[Union[SkeletonSequence, ArrayLike]], *, experiment_name: Any = ..., device_ind: Any = ..., val_batch_size: Any = ..., start_epoch: Any = ..., dataset_name: Any = ..., stbln_symmetric: Any = ..., num_subframes: Any = ...) -> Iterator[Category]: ...
    def fit(self, dataset: Dataset, val_dataset: Optional[Dataset] = ..., logging_path: PathLike = ..., silent: bool = ..., verbose: bool = ..., momentum: float = ..., nesterov: Any = ..., weight_decay: float = ..., train_data_filename: Any = ..., train_labels_filename: Any = ..., val_data_filename: Any = ..., val_labels_filename: Any = ..., skeleton_data_type: Any = ..., *, out: Optional[PathLike] = ..., resume: bool = ..., split: Optional[str] = ..., val_split: Optional[str] = ..., limit: Optional[int] = ..., teacher: Union[None, str, Learner] = ..., teacher_threshold: Optional[float] = ..., teacher_classes: Sequence[str] = ..., teacher_map: Optional[Mapping[str, str]] = ..., teacher_by_number: bool = ..., keep_empty: bool = ..., skip_broken: bool = ..., epochs: int = ..., iters: int = ..., max_steps: int = ..., batch_size: int = ..., accumulate: int = ..., batches_per_iter: int = ..., lr: float = ..., optimizer: Literal['adamw', 'adam', 'sgd', 'rmsprop'] = ..., optimizer_name: Literal['adamw', 'adam', 'sgd', 'rmsprop'] = ..., lr_schedule: Literal['constant', 'step', 'cosine', 'linear'] = ..., warmup_steps: int = ..., warmup_ratio: float = ..., lr_min: float = ..., lr_schedule_eta_min: float = ..., lr_steps: list[Any] = ..., drop_after_epoch: list[Any] = ..., lr_gamma: float = ..., lr_decay: float = ..., grad_clip: float = ..., ema: float = ..., early_stop: int = ..., val_after: int = ..., checkpoint_after_iter: int = ..., checkpoint_minutes: float = ..., checkpoints_kept: int = ..., log_after: int = ..., num_workers: int = ..., seed: int = ..., dropout: float = ..., label_smoothing: float = ..., augment: bool = ...) -> dict[str, Any]: ...
    def eval(self, val_dataset: Dataset = ..., val_loader: Any = ..., epoch: Any = ..., silent: Any = ..., verbose: bool = ..., val_data_filename: Any = ..., val_labels_filename: Any = ..., skeleton_data_type: Any = ..., save_score: Any = ..., wrong_file: Any = ..., result_file: Any = ..., show_topk: Any = ..., *, dataset: Dataset = ..., metric: Optional[str] = ..., split: Optional[str] = ..., limit: Optional[int] = ..., out: Optional[PathLike] = ..., skip_broken: bool = ..., classes: Optional[Mapping[str, str]] = ..., by_number: bool = ..., resamples: int = ..., **metric_params: Any) -> dict[str, Any]: ...
    def optimize(self, do_constant_folding: Any = ..., *, target_device: str = ..., out: Optional[PathLike] = ..., precision: str = ..., calibration: Union[None, Dataset] = ..., validation: Union[None, Dataset] = ..., verbose: bool = ..., **options: Any) -> dict[str, Any]: ...
    def load(self, path: Optional[PathLike] = ..., model_name: Any = ..., verbose: bool = ..., *, variant: Optional[str] = ...) -> bool: ...
    @classmethod
    def download(cls, path: Optional[PathLike] = ..., method_name: Any = ..., mode: str = ..., verbose: bool = ..., url: Optional[str] = ..., file_name: Any = ..., *, variant: Optional[str] = ...) -> str: ...
    def multi_stream_eval(self, *args: Any, **kwargs: Any) -> NoReturn: ...

class CoSTGCNLearner(NativeLearner):
    """CoST-GCN tells after every frame what a person does by its moving skeleton; it trains.

    Task: skeleton_based_action_recognition. ``infer`` takes:

        skeleton_sequence: SkeletonSequence.

    and gives: Category.

    Args:
        num_classes: Classes. None: as many as the data name. (default None; 2 to 10000)
        num_point: Joints. None: as many as the graph has. (default None; 2 to 1000)
        num_person: Persons of a recording that are looked at, the first ones; the answer is the mean over those
            seen so far. (default 2; 1 to 64)
        in_channels: Coordinates of a joint: 2 (a third channel, where there is one, holds scores) or 3. (default
            3; 2 to 3)
        graph_type: Joints and bones. (default 'ntu'; one of 'ntu', 'kinetics', 'coco', 'jhmdb')
        backbone: The network. (default 'costgcn'; one of 'costgcn')
        sequence_len: Frames that an answer speaks of. (default 300; 1 to 10000)
        channels: Channels of each block. (default [64, 64, 64, 64, 128, 128, 128, 256, 256, 256]; 1 to 4096)
        temporal_kernel: Frames that a block sees; odd. (default 9; 3 to 101)
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
        dropout: Share of values between layers that are left out at random in each training step. (default 0.0; 0
            to 0.99)
        label_smoothing: Share of the other classes, all alike, in what the network is to say of a clip. (default
            0.0; 0 to 0.9)
        augment: Whether skeletons are mirrored, leant, stretched, cut in time and played slower or faster, at
            random. (default True)

    Arguments of OpenDR that are taken and have no effect:
        network_head: no effect: it classifies.
        loss: no effect: it is the cross-entropy.
        drop_last: no effect: a last batch that is not full is always left out.
        pin_memory: no effect: there is no such memory.
    """

    num_classes: Optional[int]
    num_point: Optional[int]
    num_person: int
    in_channels: int
    graph_type: Literal['ntu', 'kinetics', 'coco', 'jhmdb']
    sequence_len: int
    channels: list[Any]
    temporal_kernel: int
    def __init__(self, lr: float = ..., iters: int = ..., batch_size: int = ..., optimizer: Literal['adamw', 'adam', 'sgd', 'rmsprop'] = ..., lr_schedule: Literal['constant', 'step', 'cosine', 'linear'] = ..., backbone: Literal['costgcn'] = ..., network_head: str = ..., checkpoint_after_iter: int = ..., checkpoint_load_iter: int = ..., temp_path: str = ..., device: str = ..., loss: Any = ..., weight_decay: float = ..., momentum: float = ..., drop_last: Any = ..., pin_memory: Any = ..., num_workers: int = ..., seed: int = ..., num_classes: Optional[int] = ..., num_point: Optional[int] = ..., num_person: int = ..., in_channels: int = ..., graph_type: Literal['ntu', 'kinetics', 'coco', 'jhmdb'] = ..., sequence_len: int = ..., *, threshold: float = ..., scale: float = ..., epochs: int = ..., max_steps: int = ..., accumulate: int = ..., batches_per_iter: int = ..., optimizer_name: Literal['adamw', 'adam', 'sgd', 'rmsprop'] = ..., warmup_steps: int = ..., warmup_ratio: float = ..., lr_min: float = ..., lr_schedule_eta_min: float = ..., lr_steps: list[Any] = ..., drop_after_epoch: list[Any] = ..., lr_gamma: float = ..., lr_decay: float = ..., grad_clip: float = ..., ema: float = ..., early_stop: int = ..., val_after: int = ..., checkpoint_minutes: float = ..., checkpoints_kept: int = ..., log_after: int = ..., dropout: float = ..., label_smoothing: float = ..., augment: bool = ..., channels: list[Any] = ..., temporal_kernel: int = ...) -> None: ...
    @overload
    def infer(self, skeleton_sequence: Union[SkeletonSequence, ArrayLike], *, network_head: Any = ..., loss: Any = ..., drop_last: Any = ..., pin_memory: Any = ...) -> Category: ...  # type: ignore[overload-overlap]
    @overload
    def infer(self, skeleton_sequence: Sequence[Union[SkeletonSequence, ArrayLike]], *, network_head: Any = ..., loss: Any = ..., drop_last: Any = ..., pin_memory: Any = ...) -> list[Category]: ...
    @overload
    def infer(self, skeleton_sequence: Iterator[Union[SkeletonSequence, ArrayLike]], *, network_head: Any = ..., loss: Any = ..., drop_last: Any = ..., pin_memory: Any = ...) -> Iterator[Category]: ...
    def fit(self, dataset: Dataset, val_dataset: Optional[Dataset] = ..., epochs: int = ..., steps: Any = ..., *, logging_path: PathLike = ..., silent: bool = ..., verbose: bool = ..., out: Optional[PathLike] = ..., resume: bool = ..., split: Optional[str] = ..., val_split: Optional[str] = ..., limit: Optional[int] = ..., teacher: Union[None, str, Learner] = ..., teacher_threshold: Optional[float] = ..., teacher_classes: Sequence[str] = ..., teacher_map: Optional[Mapping[str, str]] = ..., teacher_by_number: bool = ..., keep_empty: bool = ..., skip_broken: bool = ..., iters: int = ..., max_steps: int = ..., batch_size: int = ..., accumulate: int = ..., batches_per_iter: int = ..., lr: float = ..., optimizer: Literal['adamw', 'adam', 'sgd', 'rmsprop'] = ..., optimizer_name: Literal['adamw', 'adam', 'sgd', 'rmsprop'] = ..., momentum: float = ..., weight_decay: float = ..., lr_schedule: Literal['constant', 'step', 'cosine', 'linear'] = ..., warmup_steps: int = ..., warmup_ratio: float = ..., lr_min: float = ..., lr_schedule_eta_min: float = ..., lr_steps: list[Any] = ..., drop_after_epoch: list[Any] = ..., lr_gamma: float = ..., lr_decay: float = ..., grad_clip: float = ..., ema: float = ..., early_stop: int = ..., val_after: int = ..., checkpoint_after_iter: int = ..., checkpoint_minutes: float = ..., checkpoints_kept: int = ..., log_after: int = ..., num_workers: int = ..., seed: int = ..., dropout: float = ..., label_smoothing: float = ..., augment: bool = ...) -> dict[str, Any]: ...
    def eval(self, dataset: Dataset, steps: Optional[int] = ..., *, metric: Optional[str] = ..., split: Optional[str] = ..., limit: Optional[int] = ..., out: Optional[PathLike] = ..., skip_broken: bool = ..., classes: Optional[Mapping[str, str]] = ..., by_number: bool = ..., resamples: int = ..., verbose: bool = ..., **metric_params: Any) -> dict[str, Any]: ...
    def optimize(self, do_constant_folding: Any = ..., *, target_device: str = ..., out: Optional[PathLike] = ..., precision: str = ..., calibration: Union[None, Dataset] = ..., validation: Union[None, Dataset] = ..., verbose: bool = ..., **options: Any) -> dict[str, Any]: ...
    @classmethod
    def download(cls, path: Optional[PathLike] = ..., method_name: Any = ..., mode: str = ..., verbose: bool = ..., url: Optional[str] = ..., file_name: Any = ..., *, variant: Optional[str] = ...) -> str: ...

class Feeder:
    """Not here yet: use ExternalDataset(path, "skeleton")."""

    def __init__(self, *args: Any, **kwargs: Any) -> NoReturn: ...

class KineticsFeeder:
    """Not here yet: use ExternalDataset(path, "skeleton")."""

    def __init__(self, *args: Any, **kwargs: Any) -> NoReturn: ...

class ProgressiveSpatioTemporalGCNLearner:
    """Not here yet: use SpatioTemporalGCNLearner, whose `channels` say its size."""

    def __init__(self, *args: Any, **kwargs: Any) -> NoReturn: ...

class STBLN:
    """Not here yet: use SpatioTemporalGCNLearner, whose network is ST-GCN."""

    def __init__(self, *args: Any, **kwargs: Any) -> NoReturn: ...

class TAGCN:
    """Not here yet: use SpatioTemporalGCNLearner, whose network is ST-GCN."""

    def __init__(self, *args: Any, **kwargs: Any) -> NoReturn: ...
