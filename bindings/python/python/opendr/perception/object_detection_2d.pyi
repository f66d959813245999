"""Learners of the task object_detection_2d. Made by bindings/python/stubs.py; do not edit."""

import os
from collections.abc import Iterator, Sequence
from typing import Any, Literal, NamedTuple, Optional, Union, overload

from numpy.typing import ArrayLike, NDArray
from opendr._drawing import draw_bounding_boxes as draw_bounding_boxes
from opendr._native_learner import NativeLearner, PathLike
from opendr.engine.data import Image
from opendr.engine.target import BoundingBoxList
from opendr.engine.datasets import Dataset
from opendr.engine.learners import Learner

class CenterNetDetectorLearner(NativeLearner):
    """CenterNet on MobileNetV3 finds the 80 COCO classes; the best of the light detectors here.

    Task: object_detection_2d. ``infer`` takes:

        image: Image.

    and gives: BoundingBoxList.

    Args:
        threshold: Detections below this score are dropped. (default 0.3; 0 to 1; may change while running, also
            for one call of infer)
        iou_threshold: Boxes of one class that overlap more than this (intersection over union) are one object.
            (default 0.5; 0 to 1; may change while running, also for one call of infer)
        max_detections: At most this many boxes a picture. (default 100; 1 to 100; may change while running, also
            for one call of infer)
        suppression: How overlapping boxes are thinned out. (default 'hard'; one of 'hard', 'soft', 'fast',
            'cluster'; may change while running, also for one call of infer)
        others: OpenDR's arguments, see ``opendr.engine.learners.BaseLearner``.

    Arguments of OpenDR that are taken and have no effect:
        img_size: no effect: the network's input has one size.
        keep_size: no effect: the whole picture is looked at, at the network's size.
        num_workers: no effect: it belongs to training, which this learner does not have.
        epochs: no effect: it belongs to training, which this learner does not have.
        val_after: no effect: it belongs to training, which this learner does not have.
        log_after: no effect: it belongs to training, which this learner does not have.
        weight_decay: no effect: it belongs to training, which this learner does not have.
        momentum: no effect: it belongs to training, which this learner does not have.
        wh_weight: no effect: it belongs to training, which this learner does not have.
        center_reg_weight: no effect: it belongs to training, which this learner does not have.
        lr_decay_epoch: no effect: it belongs to training, which this learner does not have.
        lr_decay: no effect: it belongs to training, which this learner does not have.
        warmup_epochs: no effect: it belongs to training, which this learner does not have.
        flip_validation: no effect: it belongs to training, which this learner does not have.
    """

    threshold: float
    iou_threshold: float
    max_detections: int
    suppression: Literal['hard', 'soft', 'fast', 'cluster']
    def __init__(self, lr: float = ..., iters: int = ..., batch_size: int = ..., optimizer: str = ..., lr_schedule: str = ..., backbone: str = ..., network_head: str = ..., checkpoint_after_iter: int = ..., checkpoint_load_iter: int = ..., temp_path: str = ..., device: str = ..., threshold: float = ..., scale: float = ..., *, iou_threshold: float = ..., max_detections: int = ..., suppression: Literal['hard', 'soft', 'fast', 'cluster'] = ..., img_size: Any = ..., keep_size: Any = ..., num_workers: Any = ..., epochs: Any = ..., val_after: Any = ..., log_after: Any = ..., weight_decay: Any = ..., momentum: Any = ..., wh_weight: Any = ..., center_reg_weight: Any = ..., lr_decay_epoch: Any = ..., lr_decay: Any = ..., warmup_epochs: Any = ..., flip_validation: Any = ...) -> None: ...
    @overload
    def infer(self, image: Union[Image, NDArray[Any], str, os.PathLike[str]], *, threshold: float = ..., iou_threshold: float = ..., max_detections: int = ..., suppression: Literal['hard', 'soft', 'fast', 'cluster'] = ..., img_size: Any = ..., keep_size: Any = ..., num_workers: Any = ..., epochs: Any = ..., val_after: Any = ..., log_after: Any = ..., weight_decay: Any = ..., momentum: Any = ..., wh_weight: Any = ..., center_reg_weight: Any = ..., lr_decay_epoch: Any = ..., lr_decay: Any = ..., warmup_epochs: Any = ..., flip_validation: Any = ...) -> BoundingBoxList: ...  # type: ignore[overload-overlap]
    @overload
    def infer(self, image: Sequence[Union[Image, NDArray[Any], str, os.PathLike[str]]], *, threshold: float = ..., iou_threshold: float = ..., max_detections: int = ..., suppression: Literal['hard', 'soft', 'fast', 'cluster'] = ..., img_size: Any = ..., keep_size: Any = ..., num_workers: Any = ..., epochs: Any = ..., val_after: Any = ..., log_after: Any = ..., weight_decay: Any = ..., momentum: Any = ..., wh_weight: Any = ..., center_reg_weight: Any = ..., lr_decay_epoch: Any = ..., lr_decay: Any = ..., warmup_epochs: Any = ..., flip_validation: Any = ...) -> list[BoundingBoxList]: ...
    @overload
    def infer(self, image: Iterator[Union[Image, NDArray[Any], str, os.PathLike[str]]], *, threshold: float = ..., iou_threshold: float = ..., max_detections: int = ..., suppression: Literal['hard', 'soft', 'fast', 'cluster'] = ..., img_size: Any = ..., keep_size: Any = ..., num_workers: Any = ..., epochs: Any = ..., val_after: Any = ..., log_after: Any = ..., weight_decay: Any = ..., momentum: Any = ..., wh_weight: Any = ..., center_reg_weight: Any = ..., lr_decay_epoch: Any = ..., lr_decay: Any = ..., warmup_epochs: Any = ..., flip_validation: Any = ...) -> Iterator[BoundingBoxList]: ...

class NanodetLearner(NativeLearner):
    """NanoDet finds the 80 COCO classes; light, good on small things.

    Task: object_detection_2d. ``infer`` takes:

        image: Image.

    and gives: BoundingBoxList.

    Args:
        threshold: Detections below this score are dropped. (default 0.35; 0 to 1; may change while running, also
            for one call of infer; in OpenDR conf_threshold)
        iou_threshold: Boxes of one class that overlap more than this (intersection over union) are one object.
            (default 0.6; 0 to 1; may change while running, also for one call of infer)
        max_detections: At most this many boxes a picture. (default 100; 1 to 1000; may change while running, also
            for one call of infer; in OpenDR nms_max_num)
        suppression: How overlapping boxes are thinned out. (default 'hard'; one of 'hard', 'soft', 'fast',
            'cluster'; may change while running, also for one call of infer)
        others: OpenDR's arguments, see ``opendr.engine.learners.BaseLearner``.

    Parameters of ``fit``, for one call or, given here, for all of them:
        freeze: What does not train: for few pictures, or little time. (default 'none'; one of 'none', 'backbone',
            'features')
        augment: Whether pictures are cropped, mirrored and recoloured at random. (default True)
        epochs: How often the data set is gone through. (default 50; 1 to 1e+06; in OpenDR iters)
        max_steps: Optimiser steps after which training ends, whatever the number of epochs; 0 for no limit.
            (default 0; 0 to 1e+09)
        batch_size: Samples a batch. (default 8; 1 to 65536)
        accumulate: Batches whose gradients are added up for one step of the optimiser. (default 1; 1 to 4096; in
            OpenDR batches_per_iter)
        lr: Learning rate at its highest. (default 0.001; 0 to 100)
        optimizer: What turns gradients into steps. (default 'adamw'; one of 'adamw', 'adam', 'sgd', 'rmsprop')
        momentum: Momentum of `sgd` and `rmsprop`. (default 0.9; 0 to 1)
        weight_decay: Weight decay: decoupled from the gradient in `adamw`, added to it in the others. (default
            0.0005; 0 to 10)
        lr_schedule: How the learning rate goes on after the warm-up. (default 'cosine'; one of 'constant',
            'step', 'cosine', 'linear')
        warmup_steps: Steps over which the learning rate rises from `warmup_ratio` of itself. (default 20; 0 to
            1e+08)
        warmup_ratio: What share of the learning rate the warm-up begins with. (default 0.01; 0 to 1)
        lr_min: Learning rate at the end of `cosine` and `linear`. (default 5e-05; 0 to 100; in OpenDR
            lr_schedule_eta_min)
        lr_steps: Epochs at which `step` lowers the learning rate. (default [])
        lr_gamma: What `step` multiplies the learning rate with. (default 0.1; 0 to 1; in OpenDR lr_decay)
        grad_clip: Gradients whose norm over all weights is above this are scaled down to it; 0 for no limit.
            (default 35.0; 0 to 1e+09)
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
        skip_unreadable: Whether samples that cannot be read are left out and listed, instead of ending the
            training. (default False)
        seed: What first weights, order, augmentation and dropout follow from. (default 0)

    Arguments of OpenDR that are taken and have no effect:
        model_to_use: no effect: the container that is loaded says which network it is.
        hf: no effect: the runtime chooses the precision.
        dynamic: no effect: the network's input has one size.
        ch_l: no effect: the runtime chooses the memory layout.
        lr_schedule_T_max: no effect: the learning rate falls until the last epoch.
    """

    threshold: float
    iou_threshold: float
    max_detections: int
    suppression: Literal['hard', 'soft', 'fast', 'cluster']
    def __init__(self, lr: float = ..., iters: int = ..., batch_size: int = ..., optimizer: Literal['adamw', 'adam', 'sgd', 'rmsprop'] = ..., lr_schedule: Literal['constant', 'step', 'cosine', 'linear'] = ..., backbone: str = ..., network_head: str = ..., checkpoint_after_iter: int = ..., checkpoint_load_iter: int = ..., temp_path: str = ..., device: str = ..., threshold: float = ..., scale: float = ..., *, freeze: Literal['none', 'backbone', 'features'] = ..., augment: bool = ..., epochs: int = ..., max_steps: int = ..., accumulate: int = ..., batches_per_iter: int = ..., momentum: float = ..., weight_decay: float = ..., warmup_steps: int = ..., warmup_ratio: float = ..., lr_min: float = ..., lr_schedule_eta_min: float = ..., lr_steps: list[Any] = ..., lr_gamma: float = ..., lr_decay: float = ..., grad_clip: float = ..., ema: float = ..., early_stop: int = ..., val_after: int = ..., checkpoint_minutes: float = ..., checkpoints_kept: int = ..., log_after: int = ..., num_workers: int = ..., skip_unreadable: bool = ..., seed: int = ..., conf_threshold: float = ..., iou_threshold: float = ..., max_detections: int = ..., nms_max_num: int = ..., suppression: Literal['hard', 'soft', 'fast', 'cluster'] = ..., model_to_use: Any = ..., hf: Any = ..., dynamic: Any = ..., ch_l: Any = ..., lr_schedule_T_max: Any = ...) -> None: ...
    @overload
    def infer(self, image: Union[Image, NDArray[Any], str, os.PathLike[str]], *, threshold: float = ..., conf_threshold: float = ..., iou_threshold: float = ..., max_detections: int = ..., nms_max_num: int = ..., suppression: Literal['hard', 'soft', 'fast', 'cluster'] = ..., model_to_use: Any = ..., hf: Any = ..., dynamic: Any = ..., ch_l: Any = ..., lr_schedule_T_max: Any = ...) -> BoundingBoxList: ...  # type: ignore[overload-overlap]
    @overload
    def infer(self, image: Sequence[Union[Image, NDArray[Any], str, os.PathLike[str]]], *, threshold: float = ..., conf_threshold: float = ..., iou_threshold: float = ..., max_detections: int = ..., nms_max_num: int = ..., suppression: Literal['hard', 'soft', 'fast', 'cluster'] = ..., model_to_use: Any = ..., hf: Any = ..., dynamic: Any = ..., ch_l: Any = ..., lr_schedule_T_max: Any = ...) -> list[BoundingBoxList]: ...
    @overload
    def infer(self, image: Iterator[Union[Image, NDArray[Any], str, os.PathLike[str]]], *, threshold: float = ..., conf_threshold: float = ..., iou_threshold: float = ..., max_detections: int = ..., nms_max_num: int = ..., suppression: Literal['hard', 'soft', 'fast', 'cluster'] = ..., model_to_use: Any = ..., hf: Any = ..., dynamic: Any = ..., ch_l: Any = ..., lr_schedule_T_max: Any = ...) -> Iterator[BoundingBoxList]: ...
    def fit(self, dataset: Dataset, val_dataset: Optional[Dataset] = ..., logging_path: PathLike = ..., silent: bool = ..., verbose: bool = ..., *, output: Optional[PathLike] = ..., resume: bool = ..., split: Optional[str] = ..., val_split: Optional[str] = ..., limit: Optional[int] = ..., teacher: Union[None, str, Learner] = ..., teacher_threshold: Optional[float] = ..., teacher_classes: Sequence[str] = ..., keep_empty: bool = ..., skip_broken: bool = ..., freeze: Literal['none', 'backbone', 'features'] = ..., augment: bool = ..., epochs: int = ..., iters: int = ..., max_steps: int = ..., batch_size: int = ..., accumulate: int = ..., batches_per_iter: int = ..., lr: float = ..., optimizer: Literal['adamw', 'adam', 'sgd', 'rmsprop'] = ..., momentum: float = ..., weight_decay: float = ..., lr_schedule: Literal['constant', 'step', 'cosine', 'linear'] = ..., warmup_steps: int = ..., warmup_ratio: float = ..., lr_min: float = ..., lr_schedule_eta_min: float = ..., lr_steps: list[Any] = ..., lr_gamma: float = ..., lr_decay: float = ..., grad_clip: float = ..., ema: float = ..., early_stop: int = ..., val_after: int = ..., checkpoint_after_iter: int = ..., checkpoint_minutes: float = ..., checkpoints_kept: int = ..., log_after: int = ..., num_workers: int = ..., skip_unreadable: bool = ..., seed: int = ...) -> dict[str, Any]: ...  # type: ignore[override]
