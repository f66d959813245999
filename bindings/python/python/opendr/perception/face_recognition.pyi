"""Learners of the task face_recognition. Made by bindings/python/stubs.py; do not edit."""

# Each learner has the arguments of OpenDR's class of its name.
# mypy: disable-error-code="override"
# pyright: reportIncompatibleMethodOverride=false

import os
from collections.abc import Iterator, Mapping, Sequence
from typing import Any, Literal, NamedTuple, NoReturn, Optional, Union, overload

from numpy.typing import ArrayLike, NDArray
from opendr._drawing import draw_bounding_boxes as draw_bounding_boxes
from opendr._native_learner import NativeLearner, PathLike
from opendr.engine.data import Image
from opendr.engine.datasets import Dataset
from opendr.engine.learners import Learner
from opendr.engine.target import BoundingBoxList

class FaceRecognitionLearner(NativeLearner):
    """MobileFace tells whose faces a frame shows, after a few reference pictures of each person.

    Task: face_recognition. ``infer`` takes:

        image: Image.

    and gives: BoundingBoxList.

    Args:
        threshold: Faces whose cosine with every picture of a known person is below this are unknown. (default
            0.38; -1 to 1; may change while running, also for one call of infer)
        face_threshold: What the detector scores below this is no face. (default 0.6; 0 to 1)
        picture: What pictures show. (default 'frame'; one of 'frame', 'face'; may change while running, also for
            one call of infer)
        others: OpenDR's arguments, see ``opendr.engine.learners.BaseLearner``.

    Parameters of ``fit``, for one call or, given here, for all of them:
        mode: What is made of the pictures. (default 'reference'; one of 'reference', 'full')
        create_new: Whether the model forgets the persons that it knows (`reference`). (default True)
        dimension: Numbers of an embedding (`full`). (default 256; 2 to 4096; in OpenDR embedding_size)
        width: Factor on the network's channels (`full`). (default 0.5; 0.05 to 2)
        margin: Added to the angle between a face and the centre of its person's, radians (`full`). (default 0.5;
            0 to 1.5)
        scale: What cosines are multiplied with (`full`). (default 32.0; 1 to 1000)
        epochs: How often the data set is gone through. (default 30; 1 to 1e+06; in OpenDR iters)
        max_steps: Optimiser steps after which training ends, whatever the number of epochs; 0 for no limit.
            (default 0; 0 to 1e+09)
        batch_size: Samples a batch. (default 64; 1 to 65536)
        accumulate: Batches whose gradients are added up for one step of the optimiser. (default 1; 1 to 4096; in
            OpenDR batches_per_iter)
        lr: Learning rate at its highest. (default 0.002; 0 to 100)
        optimizer: What turns gradients into steps. (default 'adamw'; one of 'adamw', 'adam', 'sgd', 'rmsprop'; in
            OpenDR optimizer_name)
        momentum: Momentum of `sgd` and `rmsprop`. (default 0.9; 0 to 1)
        weight_decay: Weight decay: decoupled from the gradient in `adamw`, added to it in the others. (default
            0.0; 0 to 10)
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
        backbone: no effect: the model says it: MobileFace, or MobileNet where it was trained here.
        network_head: no effect: the network is trained by ArcFace's loss.
        loss: no effect: the network is trained by ArcFace's loss.
        input_size: no effect: the network says what it takes.
        rgb_mean: no effect: the network says what it takes.
        rgb_std: no effect: the network says what it takes.
        drop_last: no effect: the last batch counts.
        stages: no effect: `lr_steps` says them.
        pin_memory: no effect: there is nothing to pin.
    """

    face_threshold: float
    picture: Literal['frame', 'face']
    def __init__(self, lr: float = ..., iters: int = ..., batch_size: int = ..., optimizer: Literal['adamw', 'adam', 'sgd', 'rmsprop'] = ..., device: str = ..., threshold: float = ..., backbone: str = ..., network_head: str = ..., loss: Any = ..., temp_path: str = ..., mode: Literal['reference', 'full'] = ..., checkpoint_after_iter: int = ..., checkpoint_load_iter: int = ..., val_after: int = ..., input_size: Any = ..., rgb_mean: Any = ..., rgb_std: Any = ..., embedding_size: int = ..., weight_decay: float = ..., momentum: float = ..., drop_last: Any = ..., stages: Any = ..., pin_memory: Any = ..., num_workers: int = ..., seed: int = ..., *, lr_schedule: Literal['constant', 'step', 'cosine', 'linear'] = ..., scale: float = ..., create_new: bool = ..., dimension: int = ..., width: float = ..., margin: float = ..., epochs: int = ..., max_steps: int = ..., accumulate: int = ..., batches_per_iter: int = ..., optimizer_name: Literal['adamw', 'adam', 'sgd', 'rmsprop'] = ..., warmup_steps: int = ..., warmup_ratio: float = ..., lr_min: float = ..., lr_schedule_eta_min: float = ..., lr_steps: list[Any] = ..., drop_after_epoch: list[Any] = ..., lr_gamma: float = ..., lr_decay: float = ..., grad_clip: float = ..., ema: float = ..., early_stop: int = ..., checkpoint_minutes: float = ..., checkpoints_kept: int = ..., log_after: int = ..., face_threshold: float = ..., picture: Literal['frame', 'face'] = ...) -> None: ...
    @overload
    def infer(self, image: Union[Image, NDArray[Any], str, os.PathLike[str]], *, threshold: float = ..., picture: Literal['frame', 'face'] = ..., backbone: Any = ..., network_head: Any = ..., loss: Any = ..., input_size: Any = ..., rgb_mean: Any = ..., rgb_std: Any = ..., drop_last: Any = ..., stages: Any = ..., pin_memory: Any = ...) -> BoundingBoxList: ...  # type: ignore[overload-overlap]
    @overload
    def infer(self, image: Sequence[Union[Image, NDArray[Any], str, os.PathLike[str]]], *, threshold: float = ..., picture: Literal['frame', 'face'] = ..., backbone: Any = ..., network_head: Any = ..., loss: Any = ..., input_size: Any = ..., rgb_mean: Any = ..., rgb_std: Any = ..., drop_last: Any = ..., stages: Any = ..., pin_memory: Any = ...) -> list[BoundingBoxList]: ...
    @overload
    def infer(self, image: Iterator[Union[Image, NDArray[Any], str, os.PathLike[str]]], *, threshold: float = ..., picture: Literal['frame', 'face'] = ..., backbone: Any = ..., network_head: Any = ..., loss: Any = ..., input_size: Any = ..., rgb_mean: Any = ..., rgb_std: Any = ..., drop_last: Any = ..., stages: Any = ..., pin_memory: Any = ...) -> Iterator[BoundingBoxList]: ...
    def fit(self, dataset: Dataset, val_dataset: Optional[Dataset] = ..., logging_path: PathLike = ..., silent: bool = ..., verbose: bool = ..., *, out: Optional[PathLike] = ..., resume: bool = ..., split: Optional[str] = ..., val_split: Optional[str] = ..., limit: Optional[int] = ..., teacher: Union[None, str, Learner] = ..., teacher_threshold: Optional[float] = ..., teacher_classes: Sequence[str] = ..., teacher_map: Optional[Mapping[str, str]] = ..., teacher_by_number: bool = ..., keep_empty: bool = ..., skip_broken: bool = ..., mode: Literal['reference', 'full'] = ..., create_new: bool = ..., dimension: int = ..., embedding_size: int = ..., width: float = ..., margin: float = ..., scale: float = ..., epochs: int = ..., iters: int = ..., max_steps: int = ..., batch_size: int = ..., accumulate: int = ..., batches_per_iter: int = ..., lr: float = ..., optimizer: Literal['adamw', 'adam', 'sgd', 'rmsprop'] = ..., optimizer_name: Literal['adamw', 'adam', 'sgd', 'rmsprop'] = ..., momentum: float = ..., weight_decay: float = ..., lr_schedule: Literal['constant', 'step', 'cosine', 'linear'] = ..., warmup_steps: int = ..., warmup_ratio: float = ..., lr_min: float = ..., lr_schedule_eta_min: float = ..., lr_steps: list[Any] = ..., drop_after_epoch: list[Any] = ..., lr_gamma: float = ..., lr_decay: float = ..., grad_clip: float = ..., ema: float = ..., early_stop: int = ..., val_after: int = ..., checkpoint_after_iter: int = ..., checkpoint_minutes: float = ..., checkpoints_kept: int = ..., log_after: int = ..., num_workers: int = ..., seed: int = ...) -> dict[str, Any]: ...
    def eval(self, dataset: Dataset, num_pairs: Optional[int] = ..., silent: Any = ..., verbose: bool = ..., *, metric: Optional[str] = ..., split: Optional[str] = ..., limit: Optional[int] = ..., out: Optional[PathLike] = ..., skip_broken: bool = ..., classes: Optional[Mapping[str, str]] = ..., by_number: bool = ..., resamples: int = ..., **metric_params: Any) -> dict[str, Any]: ...
    def optimize(self, do_constant_folding: Any = ..., *, target_device: str = ..., out: Optional[PathLike] = ..., precision: str = ..., calibration: Union[None, Dataset] = ..., validation: Union[None, Dataset] = ..., verbose: bool = ..., **options: Any) -> dict[str, Any]: ...
    def align(self, *args: Any, **kwargs: Any) -> NoReturn: ...

class FaceRecognitionDataset:
    """Not here yet: use ExternalDataset(path, "lfw") for pairs of faces."""

    def __init__(self, *args: Any, **kwargs: Any) -> NoReturn: ...
