"""Learners of the task compressive_learning. Made by bindings/python/stubs.py; do not edit."""

# Each learner has the arguments of OpenDR's class of its name.
# mypy: disable-error-code="override"
# pyright: reportIncompatibleMethodOverride=false

import os
from collections.abc import Iterator, Mapping, Sequence
from typing import Any, Literal, NamedTuple, NoReturn, Optional, Union, overload

from numpy.typing import ArrayLike, NDArray
from opendr._native_learner import NativeLearner, PathLike
from opendr.engine.data import Image
from opendr.engine.datasets import Dataset
from opendr.engine.learners import Learner
from opendr.engine.target import Category

class MultilinearCompressiveLearner(NativeLearner):
    """Tells the class of a picture by few numbers that were measured of it.

    Task: compressive_learning. ``infer`` takes:

        image: Image.

    and gives: Category.

    Args:
        input_shape: Height, width and channels (3) of the pictures that are measured; others are stretched to it.
            (default [32, 32, 3]; 1 to 4096)
        compressed_shape: Height, width and channels of the measurement. (default [16, 16, 1]; 1 to 4096)
        backbone: What tells the class. (default 'small'; one of 'small')
        n_class: Classes. None: as many as the data name. (default None; 2 to 10000)
        others: OpenDR's arguments, see ``opendr.engine.learners.BaseLearner``.

    Parameters of ``fit``, for one call or, given here, for all of them:
        epochs: How often the data set is gone through. (default 300; 1 to 1e+06; in OpenDR iters)
        max_steps: Optimiser steps after which training ends, whatever the number of epochs; 0 for no limit.
            (default 0; 0 to 1e+09)
        batch_size: Samples a batch. (default 32; 1 to 65536)
        accumulate: Batches whose gradients are added up for one step of the optimiser. (default 1; 1 to 4096; in
            OpenDR batches_per_iter)
        lr: Learning rate at its highest. (default 0.001; 0 to 100)
        optimizer: What turns gradients into steps. (default 'adam'; one of 'adamw', 'adam', 'sgd', 'rmsprop'; in
            OpenDR optimizer_name)
        momentum: Momentum of `sgd` and `rmsprop`. (default 0.9; 0 to 1)
        weight_decay: Weight decay: decoupled from the gradient in `adamw`, added to it in the others. (default
            0.0001; 0 to 10)
        lr_schedule: How the learning rate goes on after the warm-up. (default 'cosine'; one of 'constant',
            'step', 'cosine', 'linear')
        warmup_steps: Steps over which the learning rate rises from `warmup_ratio` of itself. (default 0; 0 to
            1e+08)
        warmup_ratio: What share of the learning rate the warm-up begins with. (default 0.1; 0 to 1)
        lr_min: Learning rate at the end of `cosine` and `linear`. (default 1e-05; 0 to 100; in OpenDR
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
        width: Channels of the classifier's first block; the others have up to twice as many. (default 32; 4 to
            1024)
        dropout: Share of the features that are left out at random. (default 0.1; 0 to 0.9)
        flip: How often a picture is mirrored. (default 0.5; 0 to 1)

    Arguments of OpenDR that are taken and have no effect:
        pretrained_backbone: no effect: there are no weights of others for its backbone.
        init_backbone: no effect: there are no weights of others for its backbone.
        n_init_iters: no effect: sensing begins with a cosine transform, which needs no training.
        test_mode: no effect: it made OpenDR's own tests short.
    """

    input_shape: list[Any]
    compressed_shape: list[Any]
    n_class: Optional[int]
    def __init__(self, input_shape: list[Any] = ..., compressed_shape: list[Any] = ..., backbone: Literal['small'] = ..., n_class: Optional[int] = ..., pretrained_backbone: Any = ..., init_backbone: Any = ..., lr_scheduler: Any = ..., optimizer: Literal['adamw', 'adam', 'sgd', 'rmsprop'] = ..., weight_decay: float = ..., n_init_iters: Any = ..., iters: int = ..., batch_size: int = ..., checkpoint_after_iter: int = ..., checkpoint_load_iter: int = ..., temp_path: str = ..., device: str = ..., test_mode: Any = ..., *, lr: float = ..., lr_schedule: Literal['constant', 'step', 'cosine', 'linear'] = ..., network_head: str = ..., threshold: float = ..., scale: float = ..., epochs: int = ..., max_steps: int = ..., accumulate: int = ..., batches_per_iter: int = ..., optimizer_name: Literal['adamw', 'adam', 'sgd', 'rmsprop'] = ..., momentum: float = ..., warmup_steps: int = ..., warmup_ratio: float = ..., lr_min: float = ..., lr_schedule_eta_min: float = ..., lr_steps: list[Any] = ..., drop_after_epoch: list[Any] = ..., lr_gamma: float = ..., lr_decay: float = ..., grad_clip: float = ..., ema: float = ..., early_stop: int = ..., val_after: int = ..., checkpoint_minutes: float = ..., checkpoints_kept: int = ..., log_after: int = ..., num_workers: int = ..., seed: int = ..., width: int = ..., dropout: float = ..., flip: float = ...) -> None: ...
    @overload
    def infer(self, image: Union[Image, NDArray[Any], str, os.PathLike[str]], *, pretrained_backbone: Any = ..., init_backbone: Any = ..., n_init_iters: Any = ..., test_mode: Any = ...) -> Category: ...  # type: ignore[overload-overlap]
    @overload
    def infer(self, image: Sequence[Union[Image, NDArray[Any], str, os.PathLike[str]]], *, pretrained_backbone: Any = ..., init_backbone: Any = ..., n_init_iters: Any = ..., test_mode: Any = ...) -> list[Category]: ...
    @overload
    def infer(self, image: Iterator[Union[Image, NDArray[Any], str, os.PathLike[str]]], *, pretrained_backbone: Any = ..., init_backbone: Any = ..., n_init_iters: Any = ..., test_mode: Any = ...) -> Iterator[Category]: ...
    def fit(self, train_set: Dataset = ..., val_set: Optional[Dataset] = ..., test_set: Any = ..., logging_path: PathLike = ..., silent: bool = ..., verbose: bool = ..., *, dataset: Dataset = ..., val_dataset: Optional[Dataset] = ..., out: Optional[PathLike] = ..., resume: bool = ..., split: Optional[str] = ..., val_split: Optional[str] = ..., limit: Optional[int] = ..., teacher: Union[None, str, Learner] = ..., teacher_threshold: Optional[float] = ..., teacher_classes: Sequence[str] = ..., teacher_map: Optional[Mapping[str, str]] = ..., teacher_by_number: bool = ..., keep_empty: bool = ..., skip_broken: bool = ..., epochs: int = ..., iters: int = ..., max_steps: int = ..., batch_size: int = ..., accumulate: int = ..., batches_per_iter: int = ..., lr: float = ..., optimizer: Literal['adamw', 'adam', 'sgd', 'rmsprop'] = ..., optimizer_name: Literal['adamw', 'adam', 'sgd', 'rmsprop'] = ..., momentum: float = ..., weight_decay: float = ..., lr_schedule: Literal['constant', 'step', 'cosine', 'linear'] = ..., warmup_steps: int = ..., warmup_ratio: float = ..., lr_min: float = ..., lr_schedule_eta_min: float = ..., lr_steps: list[Any] = ..., drop_after_epoch: list[Any] = ..., lr_gamma: float = ..., lr_decay: float = ..., grad_clip: float = ..., ema: float = ..., early_stop: int = ..., val_after: int = ..., checkpoint_after_iter: int = ..., checkpoint_minutes: float = ..., checkpoints_kept: int = ..., log_after: int = ..., num_workers: int = ..., seed: int = ..., width: int = ..., dropout: float = ..., flip: float = ...) -> dict[str, Any]: ...
    def eval(self, dataset: Dataset, silent: Any = ..., verbose: bool = ..., *, metric: Optional[str] = ..., split: Optional[str] = ..., limit: Optional[int] = ..., out: Optional[PathLike] = ..., skip_broken: bool = ..., classes: Optional[Mapping[str, str]] = ..., by_number: bool = ..., resamples: int = ..., **metric_params: Any) -> dict[str, Any]: ...
    def get_sensing_parameters(self, *args: Any, **kwargs: Any) -> NoReturn: ...
    def infer_from_compressed_measurement(self, *args: Any, **kwargs: Any) -> NoReturn: ...
