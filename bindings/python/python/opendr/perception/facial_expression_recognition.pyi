"""Learners of the task facial_expression_recognition. Made by bindings/python/stubs.py; do not edit."""

# Each learner has the arguments of OpenDR's class of its name.
# mypy: disable-error-code="override"
# pyright: reportIncompatibleMethodOverride=false

import os
from collections.abc import Iterator, Mapping, Sequence
from typing import Any, Literal, NamedTuple, NoReturn, Optional, Union, overload

from numpy.typing import ArrayLike, NDArray
from opendr._native_learner import NativeLearner, PathLike
from opendr._upstream.learners.people import FacialEmotion
from opendr.engine.data import Image, SkeletonSequence
from opendr.engine.datasets import Dataset
from opendr.engine.learners import Learner
from opendr.engine.target import Category

class FacialEmotionLearner(FacialEmotion):
    """mini-XCEPTION tells which of seven emotions the largest face in a frame shows.

    Task: facial_expression_recognition. ``infer`` takes:

        image: Image.

    and gives: Category.

    Args:
        face_threshold: What the detector scores below this is no face. (default 0.6; 0 to 1)
        picture: What pictures show. (default 'frame'; one of 'frame', 'face'; may change while running, also for
            one call of infer)
        others: OpenDR's arguments, see ``opendr.engine.learners.BaseLearner``.

    Arguments of OpenDR that are taken and have no effect:
        device_ind: no effect: `device` says where.
        validation_interval: no effect: it belongs to training, which this learner does not have.
        max_training_epoch: no effect: it belongs to training, which this learner does not have.
        momentum: no effect: it belongs to training, which this learner does not have.
        ensemble_size: no effect: the network is one, not an ensemble.
        base_path_experiment: no effect: it belongs to training, which this learner does not have.
        name_experiment: no effect: it belongs to training, which this learner does not have.
        dimensional_finetune: no effect: it belongs to training, which this learner does not have.
        categorical_train: no effect: it belongs to training, which this learner does not have.
        base_path_to_dataset: no effect: it belongs to training, which this learner does not have.
        max_tuning_epoch: no effect: it belongs to training, which this learner does not have.
        diversify: no effect: it belongs to training, which this learner does not have.
    """

    face_threshold: float
    picture: Literal['frame', 'face']
    def __init__(self, lr: float = ..., batch_size: int = ..., temp_path: str = ..., device: str = ..., device_ind: Any = ..., validation_interval: Any = ..., max_training_epoch: Any = ..., momentum: Any = ..., ensemble_size: Any = ..., base_path_experiment: Any = ..., name_experiment: Any = ..., dimensional_finetune: Any = ..., categorical_train: Any = ..., base_path_to_dataset: Any = ..., max_tuning_epoch: Any = ..., diversify: Any = ..., *, iters: int = ..., optimizer: str = ..., lr_schedule: str = ..., backbone: str = ..., network_head: str = ..., checkpoint_after_iter: int = ..., checkpoint_load_iter: int = ..., threshold: float = ..., scale: float = ..., face_threshold: float = ..., picture: Literal['frame', 'face'] = ...) -> None: ...
    @overload
    def infer(self, image: Union[Image, NDArray[Any], str, os.PathLike[str]], *, picture: Literal['frame', 'face'] = ..., device_ind: Any = ..., validation_interval: Any = ..., max_training_epoch: Any = ..., momentum: Any = ..., ensemble_size: Any = ..., base_path_experiment: Any = ..., name_experiment: Any = ..., dimensional_finetune: Any = ..., categorical_train: Any = ..., base_path_to_dataset: Any = ..., max_tuning_epoch: Any = ..., diversify: Any = ...) -> Category: ...  # type: ignore[overload-overlap]
    @overload
    def infer(self, image: Sequence[Union[Image, NDArray[Any], str, os.PathLike[str]]], *, picture: Literal['frame', 'face'] = ..., device_ind: Any = ..., validation_interval: Any = ..., max_training_epoch: Any = ..., momentum: Any = ..., ensemble_size: Any = ..., base_path_experiment: Any = ..., name_experiment: Any = ..., dimensional_finetune: Any = ..., categorical_train: Any = ..., base_path_to_dataset: Any = ..., max_tuning_epoch: Any = ..., diversify: Any = ...) -> list[Category]: ...
    @overload
    def infer(self, image: Iterator[Union[Image, NDArray[Any], str, os.PathLike[str]]], *, picture: Literal['frame', 'face'] = ..., device_ind: Any = ..., validation_interval: Any = ..., max_training_epoch: Any = ..., momentum: Any = ..., ensemble_size: Any = ..., base_path_experiment: Any = ..., name_experiment: Any = ..., dimensional_finetune: Any = ..., categorical_train: Any = ..., base_path_to_dataset: Any = ..., max_tuning_epoch: Any = ..., diversify: Any = ...) -> Iterator[Category]: ...
    def optimize(self, do_constant_folding: Any = ..., *, target_device: str = ..., out: Optional[PathLike] = ..., precision: str = ..., calibration: Union[None, Dataset] = ..., validation: Union[None, Dataset] = ..., verbose: bool = ..., **options: Any) -> dict[str, Any]: ...

class ProgressiveSpatioTemporalBLNLearner(NativeLearner):
    """PST-BLN tells an expression by the landmarks of a face through time; it trains.

    Task: facial_expression_recognition. ``infer`` takes:

        skeleton_sequence: SkeletonSequence.

    and gives: Category.

    Args:
        num_class: Classes. None: as many as the data name. (default None; 2 to 10000)
        num_point: Landmarks of a face. None: as many as the data have. (default None; 2 to 1000)
        in_channels: Coordinates of a landmark: 2 (a third channel, where there is one, holds scores) or 3.
            (default 2; 2 to 3)
        num_frames: Frames of a clip: the last of a longer recording; in a shorter one, the face stands still
            before it. (default 20; 1 to 10000)
        blocksize: Channels of a block. (default 5; 1 to 256)
        topology: Blocks of each layer. (default [2, 2, 4, 4]; 1 to 1000)
        others: OpenDR's arguments, see ``opendr.engine.learners.BaseLearner``.

    Parameters of ``fit``, for one call or, given here, for all of them:
        epochs: How often the data set is gone through. (default 400; 1 to 1e+06; in OpenDR iters)
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
        lr_steps: Epochs at which `step` lowers the learning rate. (default [400]; in OpenDR drop_after_epoch)
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
        dropout: Share of values between layers that are left out at random in each training step. (default 0.2; 0
            to 0.99)

    Arguments of OpenDR that are taken and have no effect:
        experiment_name: no effect: the folder of a training says it.
        device_indices: no effect: `device` says it.
        val_batch_size: no effect: validation asks the learner, clip by clip.
        start_epoch: no effect: `resume` of `fit` goes on where a training was.
        dataset_name: no effect: the data set says it.
        num_person: no effect: a recording is of one face, the first that is there.
        num_blocks: no effect: `topology` says it.
        num_layers: no effect: `topology` says it.
        layer_threshold: no effect: layers do not grow: `topology` says their sizes.
        block_threshold: no effect: layers do not grow: `topology` says their sizes.
    """

    num_class: Optional[int]
    num_point: Optional[int]
    in_channels: int
    num_frames: int
    blocksize: int
    topology: list[Any]
    def __init__(self, lr: float = ..., batch_size: int = ..., optimizer_name: Literal['adamw', 'adam', 'sgd', 'rmsprop'] = ..., lr_schedule: Literal['constant', 'step', 'cosine', 'linear'] = ..., checkpoint_after_iter: int = ..., checkpoint_load_iter: int = ..., temp_path: str = ..., device: str = ..., num_workers: int = ..., epochs: int = ..., experiment_name: Any = ..., device_indices: Any = ..., val_batch_size: Any = ..., drop_after_epoch: list[Any] = ..., start_epoch: Any = ..., dataset_name: Any = ..., num_class: Optional[int] = ..., num_point: Optional[int] = ..., num_person: Any = ..., in_channels: int = ..., blocksize: int = ..., num_blocks: Any = ..., num_layers: Any = ..., topology: list[Any] = ..., layer_threshold: Any = ..., block_threshold: Any = ..., *, iters: int = ..., optimizer: Literal['adamw', 'adam', 'sgd', 'rmsprop'] = ..., backbone: str = ..., network_head: str = ..., threshold: float = ..., scale: float = ..., max_steps: int = ..., accumulate: int = ..., batches_per_iter: int = ..., momentum: float = ..., weight_decay: float = ..., warmup_steps: int = ..., warmup_ratio: float = ..., lr_min: float = ..., lr_schedule_eta_min: float = ..., lr_steps: list[Any] = ..., lr_gamma: float = ..., lr_decay: float = ..., grad_clip: float = ..., ema: float = ..., early_stop: int = ..., val_after: int = ..., checkpoint_minutes: float = ..., checkpoints_kept: int = ..., log_after: int = ..., seed: int = ..., dropout: float = ..., num_frames: int = ...) -> None: ...
    @overload
    def infer(self, skeleton_sequence: Union[SkeletonSequence, ArrayLike], monte_carlo_dropout: Any = ..., mcdo_repeats: Any = ..., *, experiment_name: Any = ..., device_indices: Any = ..., val_batch_size: Any = ..., start_epoch: Any = ..., dataset_name: Any = ..., num_person: Any = ..., num_blocks: Any = ..., num_layers: Any = ..., layer_threshold: Any = ..., block_threshold: Any = ...) -> Category: ...  # type: ignore[overload-overlap]
    @overload
    def infer(self, skeleton_sequence: Sequence[Union[SkeletonSequence, ArrayLike]], monte_carlo_dropout: Any = ..., mcdo_repeats: Any = ..., *, experiment_name: Any = ..., device_indices: Any = ..., val_batch_size: Any = ..., start_epoch: Any = ..., dataset_name: Any = ..., num_person: Any = ..., num_blocks: Any = ..., num_layers: Any = ..., layer_threshold: Any = ..., block_threshold: Any = ...) -> list[Category]: ...
    @overload
    def infer(self, skeleton_sequence: Iterator[Union[SkeletonSequence, ArrayLike]], monte_carlo_dropout: Any = ..., mcdo_repeats: Any = ..., *, experiment_name: Any = ..., device_indices: Any = ..., val_batch_size: Any = ..., start_epoch: Any = ..., dataset_name: Any = ..., num_person: Any = ..., num_blocks: Any = ..., num_layers: Any = ..., layer_threshold: Any = ..., block_threshold: Any = ...) -> Iterator[Category]: ...
    def fit(self, dataset: Dataset, val_dataset: Optional[Dataset] = ..., logging_path: PathLike = ..., silent: bool = ..., verbose: bool = ..., momentum: float = ..., nesterov: Any = ..., weight_decay: float = ..., monte_carlo_dropout: Any = ..., mcdo_repeats: Any = ..., train_data_filename: Any = ..., train_labels_filename: Any = ..., val_data_filename: Any = ..., val_labels_filename: Any = ..., *, out: Optional[PathLike] = ..., resume: bool = ..., split: Optional[str] = ..., val_split: Optional[str] = ..., limit: Optional[int] = ..., teacher: Union[None, str, Learner] = ..., teacher_threshold: Optional[float] = ..., teacher_classes: Sequence[str] = ..., teacher_map: Optional[Mapping[str, str]] = ..., teacher_by_number: bool = ..., keep_empty: bool = ..., skip_broken: bool = ..., epochs: int = ..., iters: int = ..., max_steps: int = ..., batch_size: int = ..., accumulate: int = ..., batches_per_iter: int = ..., lr: float = ..., optimizer: Literal['adamw', 'adam', 'sgd', 'rmsprop'] = ..., optimizer_name: Literal['adamw', 'adam', 'sgd', 'rmsprop'] = ..., lr_schedule: Literal['constant', 'step', 'cosine', 'linear'] = ..., warmup_steps: int = ..., warmup_ratio: float = ..., lr_min: float = ..., lr_schedule_eta_min: float = ..., lr_steps: list[Any] = ..., drop_after_epoch: list[Any] = ..., lr_gamma: float = ..., lr_decay: float = ..., grad_clip: float = ..., ema: float = ..., early_stop: int = ..., val_after: int = ..., checkpoint_after_iter: int = ..., checkpoint_minutes: float = ..., checkpoints_kept: int = ..., log_after: int = ..., num_workers: int = ..., seed: int = ..., dropout: float = ...) -> dict[str, Any]: ...
    def eval(self, val_dataset: Dataset = ..., val_loader: Any = ..., epoch: Any = ..., monte_carlo_dropout: Any = ..., mcdo_repeats: Any = ..., silent: Any = ..., verbose: bool = ..., val_data_filename: Any = ..., val_labels_filename: Any = ..., save_score: Any = ..., wrong_file: Any = ..., result_file: Any = ..., show_topk: Any = ..., *, dataset: Dataset = ..., metric: Optional[str] = ..., split: Optional[str] = ..., limit: Optional[int] = ..., out: Optional[PathLike] = ..., skip_broken: bool = ..., classes: Optional[Mapping[str, str]] = ..., by_number: bool = ..., resamples: int = ..., **metric_params: Any) -> dict[str, Any]: ...
    def optimize(self, do_constant_folding: Any = ..., *, target_device: str = ..., out: Optional[PathLike] = ..., precision: str = ..., calibration: Union[None, Dataset] = ..., validation: Union[None, Dataset] = ..., verbose: bool = ..., **options: Any) -> dict[str, Any]: ...
    def load(self, path: Optional[PathLike] = ..., model_name: Any = ..., verbose: bool = ..., *, variant: Optional[str] = ...) -> bool: ...
    def network_builder(self, *args: Any, **kwargs: Any) -> NoReturn: ...

class AffectNetCategorical:
    """Not here yet: use ExternalDataset(path, "imagefolder"), a folder for each emotion."""

    def __init__(self, *args: Any, **kwargs: Any) -> NoReturn: ...

class AffectNetDimensional:
    """Not here yet: use ExternalDataset(path, "imagefolder"), a folder for each emotion."""

    def __init__(self, *args: Any, **kwargs: Any) -> NoReturn: ...
