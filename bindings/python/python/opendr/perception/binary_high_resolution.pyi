"""Learners of the task binary_high_resolution. Made by bindings/python/stubs.py; do not edit."""

# Each learner has the arguments of OpenDR's class of its name.
# mypy: disable-error-code="override"
# pyright: reportIncompatibleMethodOverride=false

import os
from collections.abc import Iterator, Mapping, Sequence
from typing import Any, Literal, NamedTuple, NoReturn, Optional, Union, overload

from numpy.typing import ArrayLike, NDArray
from opendr._upstream.drawing import visualize as visualize
from opendr._upstream.segmentation_datasets import HighResolutionDataset as HighResolutionDataset
from opendr._native_learner import PathLike
from opendr._upstream.learners.scenes import HighResolution
from opendr.engine.data import Image
from opendr.engine.datasets import Dataset
from opendr.engine.target import Category, Heatmap

class BinaryHighResolutionLearnerOutputs(NamedTuple):
    map: Heatmap
    category: Category

class BinaryHighResolutionLearner(HighResolution):
    """Tells where a picture of full high definition shows what it has learned to look for; it trains.

    Task: binary_high_resolution. ``infer`` takes:

        image: Image.

    and gives: Heatmap, Category.

    Args:
        architecture: The network that is trained; a loaded model is of the one it was trained as. (default
            'VGG_720p'; one of 'VGG_720p', 'VGG_1080p')
        others: OpenDR's arguments, see ``opendr.engine.learners.BaseLearner``.

    Parameters of ``fit``, for one call or, given here, for all of them:
        epochs: How often the data set is gone through. (default 100; 1 to 1e+06; in OpenDR iters)
        max_steps: Optimiser steps after which training ends, whatever the number of epochs; 0 for no limit.
            (default 0; 0 to 1e+09)
        batch_size: Samples a batch. (default 512; 1 to 65536)
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
        num_workers: Threads that read and augment samples. (default 4; 0 to 1024)
        seed: What first weights, order, augmentation and dropout follow from. (default 0)
        patches: At most so many patches with something and as many without are taken of a picture with boxes.
            (default 8; 1 to 1000)
    """

    architecture: Literal['VGG_720p', 'VGG_1080p']
    def __init__(self, lr: float = ..., iters: int = ..., batch_size: int = ..., optimizer: Literal['adamw', 'adam', 'sgd', 'rmsprop'] = ..., temp_path: str = ..., device: str = ..., weight_decay: float = ..., momentum: float = ..., num_workers: int = ..., architecture: Literal['VGG_720p', 'VGG_1080p'] = ..., *, lr_schedule: Literal['constant', 'step', 'cosine', 'linear'] = ..., backbone: str = ..., network_head: str = ..., checkpoint_after_iter: int = ..., checkpoint_load_iter: int = ..., threshold: float = ..., scale: float = ..., epochs: int = ..., max_steps: int = ..., accumulate: int = ..., batches_per_iter: int = ..., optimizer_name: Literal['adamw', 'adam', 'sgd', 'rmsprop'] = ..., warmup_steps: int = ..., warmup_ratio: float = ..., lr_min: float = ..., lr_schedule_eta_min: float = ..., lr_steps: list[Any] = ..., drop_after_epoch: list[Any] = ..., lr_gamma: float = ..., lr_decay: float = ..., grad_clip: float = ..., ema: float = ..., early_stop: int = ..., val_after: int = ..., checkpoint_minutes: float = ..., checkpoints_kept: int = ..., log_after: int = ..., seed: int = ..., patches: int = ...) -> None: ...
    @overload
    def infer(self, image: Union[Image, NDArray[Any], str, os.PathLike[str]]) -> BinaryHighResolutionLearnerOutputs: ...  # type: ignore[overload-overlap]
    @overload
    def infer(self, image: Sequence[Union[Image, NDArray[Any], str, os.PathLike[str]]]) -> list[BinaryHighResolutionLearnerOutputs]: ...
    @overload
    def infer(self, image: Iterator[Union[Image, NDArray[Any], str, os.PathLike[str]]]) -> Iterator[BinaryHighResolutionLearnerOutputs]: ...
    def fit(self, dataset: Any, silent: bool = ..., verbose: bool = ..., *, val_dataset: Any = ..., logging_path: PathLike = ..., epochs: int = ..., iters: int = ..., max_steps: int = ..., batch_size: int = ..., accumulate: int = ..., batches_per_iter: int = ..., lr: float = ..., optimizer: Literal['adamw', 'adam', 'sgd', 'rmsprop'] = ..., optimizer_name: Literal['adamw', 'adam', 'sgd', 'rmsprop'] = ..., momentum: float = ..., weight_decay: float = ..., lr_schedule: Literal['constant', 'step', 'cosine', 'linear'] = ..., warmup_steps: int = ..., warmup_ratio: float = ..., lr_min: float = ..., lr_schedule_eta_min: float = ..., lr_steps: list[Any] = ..., drop_after_epoch: list[Any] = ..., lr_gamma: float = ..., lr_decay: float = ..., grad_clip: float = ..., ema: float = ..., early_stop: int = ..., val_after: int = ..., checkpoint_after_iter: int = ..., checkpoint_minutes: float = ..., checkpoints_kept: int = ..., log_after: int = ..., num_workers: int = ..., seed: int = ..., patches: int = ...) -> dict[str, Any]: ...
    def eval(self, dataset: Any, silent: Any = ..., verbose: Any = ..., **options: Any) -> dict[str, Any]: ...
    def optimize(self, do_constant_folding: Any = ..., *, target_device: str = ..., out: Optional[PathLike] = ..., precision: str = ..., calibration: Union[None, Dataset] = ..., validation: Union[None, Dataset] = ..., verbose: bool = ..., **options: Any) -> dict[str, Any]: ...
