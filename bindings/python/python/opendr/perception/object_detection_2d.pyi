"""Learners of the task object_detection_2d. Made by bindings/python/stubs.py; do not edit."""

import os
from collections.abc import Iterator, Sequence
from typing import Any, Literal, NamedTuple, Optional, Union, overload

from numpy.typing import ArrayLike, NDArray
from opendr._drawing import draw_bounding_boxes as draw_bounding_boxes
from opendr._native_learner import NativeLearner
from opendr.engine.data import Image
from opendr.engine.target import BoundingBoxList

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
    def __init__(self, lr: float = ..., iters: int = ..., batch_size: int = ..., optimizer: str = ..., lr_schedule: str = ..., backbone: str = ..., network_head: str = ..., checkpoint_after_iter: int = ..., checkpoint_load_iter: int = ..., temp_path: str = ..., device: str = ..., scale: float = ..., *, threshold: float = ..., iou_threshold: float = ..., max_detections: int = ..., suppression: Literal['hard', 'soft', 'fast', 'cluster'] = ..., img_size: Any = ..., keep_size: Any = ..., num_workers: Any = ..., epochs: Any = ..., val_after: Any = ..., log_after: Any = ..., weight_decay: Any = ..., momentum: Any = ..., wh_weight: Any = ..., center_reg_weight: Any = ..., lr_decay_epoch: Any = ..., lr_decay: Any = ..., warmup_epochs: Any = ..., flip_validation: Any = ...) -> None: ...
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

    Arguments of OpenDR that are taken and have no effect:
        model_to_use: no effect: the container that is loaded says which network it is.
        hf: no effect: the runtime chooses the precision.
        dynamic: no effect: the network's input has one size.
        ch_l: no effect: the runtime chooses the memory layout.
        weight_decay: no effect: it belongs to training, which this learner does not have.
        warmup_steps: no effect: it belongs to training, which this learner does not have.
        warmup_ratio: no effect: it belongs to training, which this learner does not have.
        lr_schedule_T_max: no effect: it belongs to training, which this learner does not have.
        lr_schedule_eta_min: no effect: it belongs to training, which this learner does not have.
        grad_clip: no effect: it belongs to training, which this learner does not have.
    """

    threshold: float
    iou_threshold: float
    max_detections: int
    suppression: Literal['hard', 'soft', 'fast', 'cluster']
    def __init__(self, lr: float = ..., iters: int = ..., batch_size: int = ..., optimizer: str = ..., lr_schedule: str = ..., backbone: str = ..., network_head: str = ..., checkpoint_after_iter: int = ..., checkpoint_load_iter: int = ..., temp_path: str = ..., device: str = ..., scale: float = ..., *, threshold: float = ..., conf_threshold: float = ..., iou_threshold: float = ..., max_detections: int = ..., nms_max_num: int = ..., suppression: Literal['hard', 'soft', 'fast', 'cluster'] = ..., model_to_use: Any = ..., hf: Any = ..., dynamic: Any = ..., ch_l: Any = ..., weight_decay: Any = ..., warmup_steps: Any = ..., warmup_ratio: Any = ..., lr_schedule_T_max: Any = ..., lr_schedule_eta_min: Any = ..., grad_clip: Any = ...) -> None: ...
    @overload
    def infer(self, image: Union[Image, NDArray[Any], str, os.PathLike[str]], *, threshold: float = ..., conf_threshold: float = ..., iou_threshold: float = ..., max_detections: int = ..., nms_max_num: int = ..., suppression: Literal['hard', 'soft', 'fast', 'cluster'] = ..., model_to_use: Any = ..., hf: Any = ..., dynamic: Any = ..., ch_l: Any = ..., weight_decay: Any = ..., warmup_steps: Any = ..., warmup_ratio: Any = ..., lr_schedule_T_max: Any = ..., lr_schedule_eta_min: Any = ..., grad_clip: Any = ...) -> BoundingBoxList: ...  # type: ignore[overload-overlap]
    @overload
    def infer(self, image: Sequence[Union[Image, NDArray[Any], str, os.PathLike[str]]], *, threshold: float = ..., conf_threshold: float = ..., iou_threshold: float = ..., max_detections: int = ..., nms_max_num: int = ..., suppression: Literal['hard', 'soft', 'fast', 'cluster'] = ..., model_to_use: Any = ..., hf: Any = ..., dynamic: Any = ..., ch_l: Any = ..., weight_decay: Any = ..., warmup_steps: Any = ..., warmup_ratio: Any = ..., lr_schedule_T_max: Any = ..., lr_schedule_eta_min: Any = ..., grad_clip: Any = ...) -> list[BoundingBoxList]: ...
    @overload
    def infer(self, image: Iterator[Union[Image, NDArray[Any], str, os.PathLike[str]]], *, threshold: float = ..., conf_threshold: float = ..., iou_threshold: float = ..., max_detections: int = ..., nms_max_num: int = ..., suppression: Literal['hard', 'soft', 'fast', 'cluster'] = ..., model_to_use: Any = ..., hf: Any = ..., dynamic: Any = ..., ch_l: Any = ..., weight_decay: Any = ..., warmup_steps: Any = ..., warmup_ratio: Any = ..., lr_schedule_T_max: Any = ..., lr_schedule_eta_min: Any = ..., grad_clip: Any = ...) -> Iterator[BoundingBoxList]: ...
