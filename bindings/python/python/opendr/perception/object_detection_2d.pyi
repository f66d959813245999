"""Learners of the task object_detection_2d. Made by bindings/python/stubs.py; do not edit."""

# Each learner has the arguments of OpenDR's class of its name.
# mypy: disable-error-code="override"
# pyright: reportIncompatibleMethodOverride=false

import os
from collections.abc import Iterator, Mapping, Sequence
from typing import Any, Literal, NamedTuple, NoReturn, Optional, Union, overload

from numpy.typing import ArrayLike, NDArray
from opendr._drawing import draw_bounding_boxes as draw_bounding_boxes
from opendr._upstream.detection_datasets import ConcatDataset as ConcatDataset
from opendr._upstream.detection_datasets import DetectionDataset as DetectionDataset
from opendr._upstream.detection_datasets import MappedDetectionDataset as MappedDetectionDataset
from opendr._upstream.detection_datasets import WiderFaceDataset as WiderFaceDataset
from opendr._upstream.detection_datasets import WiderPersonDataset as WiderPersonDataset
from opendr._upstream.detection_datasets import XMLBasedDataset as XMLBasedDataset
from opendr._upstream.detection_transforms import BoundingBoxListToNumpyArray as BoundingBoxListToNumpyArray
from opendr._upstream.detection_transforms import ImageToNumpyArrayTransform as ImageToNumpyArrayTransform
from opendr._upstream.detection_transforms import ResizeImageAndBoxesTransform as ResizeImageAndBoxesTransform
from opendr._upstream.filtering import FilteredLearnerWrapper as FilteredLearnerWrapper
from opendr._upstream.suppression import ClusterNMS as ClusterNMS
from opendr._upstream.suppression import FastNMS as FastNMS
from opendr._upstream.suppression import NMSCustom as NMSCustom
from opendr._upstream.suppression import SoftNMS as SoftNMS
from opendr._native_learner import NativeLearner, PathLike
from opendr._upstream.learners.detection import Seq2SeqNms, SingleShotDetector
from opendr.engine.data import Image
from opendr.engine.datasets import Dataset
from opendr.engine.learners import Learner
from opendr.engine.target import BoundingBoxList, Category

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

    iou_threshold: float
    max_detections: int
    suppression: Literal['hard', 'soft', 'fast', 'cluster']
    def __init__(self, lr: float = ..., epochs: Any = ..., batch_size: int = ..., device: str = ..., backbone: str = ..., img_size: Any = ..., lr_schedule: str = ..., temp_path: str = ..., checkpoint_after_iter: int = ..., checkpoint_load_iter: int = ..., val_after: Any = ..., log_after: Any = ..., num_workers: Any = ..., weight_decay: Any = ..., momentum: Any = ..., scale: float = ..., wh_weight: Any = ..., center_reg_weight: Any = ..., lr_decay_epoch: Any = ..., lr_decay: Any = ..., warmup_epochs: Any = ..., flip_validation: Any = ..., *, iters: int = ..., optimizer: str = ..., network_head: str = ..., threshold: float = ..., iou_threshold: float = ..., max_detections: int = ..., suppression: Literal['hard', 'soft', 'fast', 'cluster'] = ..., keep_size: Any = ...) -> None: ...
    @overload
    def infer(self, image: Union[Image, NDArray[Any], str, os.PathLike[str]], threshold: float = ..., keep_size: Any = ..., *, iou_threshold: float = ..., max_detections: int = ..., suppression: Literal['hard', 'soft', 'fast', 'cluster'] = ..., img_size: Any = ..., num_workers: Any = ..., epochs: Any = ..., val_after: Any = ..., log_after: Any = ..., weight_decay: Any = ..., momentum: Any = ..., wh_weight: Any = ..., center_reg_weight: Any = ..., lr_decay_epoch: Any = ..., lr_decay: Any = ..., warmup_epochs: Any = ..., flip_validation: Any = ...) -> BoundingBoxList: ...  # type: ignore[overload-overlap]
    @overload
    def infer(self, image: Sequence[Union[Image, NDArray[Any], str, os.PathLike[str]]], threshold: float = ..., keep_size: Any = ..., *, iou_threshold: float = ..., max_detections: int = ..., suppression: Literal['hard', 'soft', 'fast', 'cluster'] = ..., img_size: Any = ..., num_workers: Any = ..., epochs: Any = ..., val_after: Any = ..., log_after: Any = ..., weight_decay: Any = ..., momentum: Any = ..., wh_weight: Any = ..., center_reg_weight: Any = ..., lr_decay_epoch: Any = ..., lr_decay: Any = ..., warmup_epochs: Any = ..., flip_validation: Any = ...) -> list[BoundingBoxList]: ...
    @overload
    def infer(self, image: Iterator[Union[Image, NDArray[Any], str, os.PathLike[str]]], threshold: float = ..., keep_size: Any = ..., *, iou_threshold: float = ..., max_detections: int = ..., suppression: Literal['hard', 'soft', 'fast', 'cluster'] = ..., img_size: Any = ..., num_workers: Any = ..., epochs: Any = ..., val_after: Any = ..., log_after: Any = ..., weight_decay: Any = ..., momentum: Any = ..., wh_weight: Any = ..., center_reg_weight: Any = ..., lr_decay_epoch: Any = ..., lr_decay: Any = ..., warmup_epochs: Any = ..., flip_validation: Any = ...) -> Iterator[BoundingBoxList]: ...
    def eval(self, dataset: Dataset, use_subset: Any = ..., subset_size: Any = ..., verbose: bool = ..., *, metric: Optional[str] = ..., split: Optional[str] = ..., limit: Optional[int] = ..., out: Optional[PathLike] = ..., skip_broken: bool = ..., classes: Optional[Mapping[str, str]] = ..., by_number: bool = ..., resamples: int = ..., **metric_params: Any) -> dict[str, Any]: ...

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
        optimizer: What turns gradients into steps. (default 'adamw'; one of 'adamw', 'adam', 'sgd', 'rmsprop'; in
            OpenDR optimizer_name)
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
        lr_steps: Epochs at which `step` lowers the learning rate. (default []; in OpenDR drop_after_epoch)
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
        seed: What first weights, order, augmentation and dropout follow from. (default 0)

    Arguments of OpenDR that are taken and have no effect:
        model_to_use: no effect: the container that is loaded says which network it is.
        hf: no effect: the runtime chooses the precision.
        dynamic: no effect: the network's input has one size.
        ch_l: no effect: the runtime chooses the memory layout.
        lr_schedule_T_max: no effect: the learning rate falls until the last epoch.
    """

    iou_threshold: float
    max_detections: int
    suppression: Literal['hard', 'soft', 'fast', 'cluster']
    def __init__(self, model_to_use: Any = ..., iters: int = ..., lr: float = ..., batch_size: int = ..., checkpoint_after_iter: int = ..., checkpoint_load_iter: int = ..., temp_path: str = ..., device: str = ..., weight_decay: float = ..., warmup_steps: int = ..., warmup_ratio: float = ..., lr_schedule_T_max: Any = ..., lr_schedule_eta_min: float = ..., grad_clip: float = ..., *, optimizer: Literal['adamw', 'adam', 'sgd', 'rmsprop'] = ..., lr_schedule: Literal['constant', 'step', 'cosine', 'linear'] = ..., backbone: str = ..., network_head: str = ..., threshold: float = ..., scale: float = ..., freeze: Literal['none', 'backbone', 'features'] = ..., augment: bool = ..., epochs: int = ..., max_steps: int = ..., accumulate: int = ..., batches_per_iter: int = ..., optimizer_name: Literal['adamw', 'adam', 'sgd', 'rmsprop'] = ..., momentum: float = ..., lr_min: float = ..., lr_steps: list[Any] = ..., drop_after_epoch: list[Any] = ..., lr_gamma: float = ..., lr_decay: float = ..., ema: float = ..., early_stop: int = ..., val_after: int = ..., checkpoint_minutes: float = ..., checkpoints_kept: int = ..., log_after: int = ..., num_workers: int = ..., seed: int = ..., conf_threshold: float = ..., iou_threshold: float = ..., max_detections: int = ..., nms_max_num: int = ..., suppression: Literal['hard', 'soft', 'fast', 'cluster'] = ..., hf: Any = ..., dynamic: Any = ..., ch_l: Any = ...) -> None: ...
    @overload
    def infer(self, image: Union[Image, NDArray[Any], str, os.PathLike[str]], conf_threshold: float = ..., iou_threshold: float = ..., nms_max_num: int = ..., hf: Any = ..., dynamic: Any = ..., ch_l: Any = ..., *, threshold: float = ..., max_detections: int = ..., suppression: Literal['hard', 'soft', 'fast', 'cluster'] = ..., model_to_use: Any = ..., lr_schedule_T_max: Any = ...) -> BoundingBoxList: ...  # type: ignore[overload-overlap]
    @overload
    def infer(self, image: Sequence[Union[Image, NDArray[Any], str, os.PathLike[str]]], conf_threshold: float = ..., iou_threshold: float = ..., nms_max_num: int = ..., hf: Any = ..., dynamic: Any = ..., ch_l: Any = ..., *, threshold: float = ..., max_detections: int = ..., suppression: Literal['hard', 'soft', 'fast', 'cluster'] = ..., model_to_use: Any = ..., lr_schedule_T_max: Any = ...) -> list[BoundingBoxList]: ...
    @overload
    def infer(self, image: Iterator[Union[Image, NDArray[Any], str, os.PathLike[str]]], conf_threshold: float = ..., iou_threshold: float = ..., nms_max_num: int = ..., hf: Any = ..., dynamic: Any = ..., ch_l: Any = ..., *, threshold: float = ..., max_detections: int = ..., suppression: Literal['hard', 'soft', 'fast', 'cluster'] = ..., model_to_use: Any = ..., lr_schedule_T_max: Any = ...) -> Iterator[BoundingBoxList]: ...
    def fit(self, dataset: Dataset, val_dataset: Optional[Dataset] = ..., logging_path: PathLike = ..., verbose: bool = ..., logging: Any = ..., seed: int = ..., local_rank: Any = ..., *, silent: bool = ..., out: Optional[PathLike] = ..., resume: bool = ..., split: Optional[str] = ..., val_split: Optional[str] = ..., limit: Optional[int] = ..., teacher: Union[None, str, Learner] = ..., teacher_threshold: Optional[float] = ..., teacher_classes: Sequence[str] = ..., teacher_map: Optional[Mapping[str, str]] = ..., teacher_by_number: bool = ..., keep_empty: bool = ..., skip_broken: bool = ..., freeze: Literal['none', 'backbone', 'features'] = ..., augment: bool = ..., epochs: int = ..., iters: int = ..., max_steps: int = ..., batch_size: int = ..., accumulate: int = ..., batches_per_iter: int = ..., lr: float = ..., optimizer: Literal['adamw', 'adam', 'sgd', 'rmsprop'] = ..., optimizer_name: Literal['adamw', 'adam', 'sgd', 'rmsprop'] = ..., momentum: float = ..., weight_decay: float = ..., lr_schedule: Literal['constant', 'step', 'cosine', 'linear'] = ..., warmup_steps: int = ..., warmup_ratio: float = ..., lr_min: float = ..., lr_schedule_eta_min: float = ..., lr_steps: list[Any] = ..., drop_after_epoch: list[Any] = ..., lr_gamma: float = ..., lr_decay: float = ..., grad_clip: float = ..., ema: float = ..., early_stop: int = ..., val_after: int = ..., checkpoint_after_iter: int = ..., checkpoint_minutes: float = ..., checkpoints_kept: int = ..., log_after: int = ..., num_workers: int = ...) -> dict[str, Any]: ...
    def eval(self, dataset: Dataset, verbose: bool = ..., logging: Any = ..., local_rank: Any = ..., *, metric: Optional[str] = ..., split: Optional[str] = ..., limit: Optional[int] = ..., out: Optional[PathLike] = ..., skip_broken: bool = ..., classes: Optional[Mapping[str, str]] = ..., by_number: bool = ..., resamples: int = ..., **metric_params: Any) -> dict[str, Any]: ...
    def optimize(self, export_path: Optional[PathLike] = ..., verbose: bool = ..., optimization: Any = ..., conf_threshold: Any = ..., iou_threshold: Any = ..., nms_max_num: Any = ..., hf: Any = ..., dynamic: Any = ..., ch_l: Any = ..., lazy_load: Any = ..., *, target_device: str = ..., out: Optional[PathLike] = ..., precision: str = ..., calibration: Union[None, Dataset] = ..., validation: Union[None, Dataset] = ..., **options: Any) -> dict[str, Any]: ...
    def optimize_c_model(self, *args: Any, **kwargs: Any) -> NoReturn: ...

class SingleShotDetectorLearner(SingleShotDetector):
    """SSD on MobileNetV1, a small detector that trains on classes of your own.

    Task: object_detection_2d. ``infer`` takes:

        image: Image.

    and gives: BoundingBoxList.

    Args:
        threshold: Detections below this score are dropped. (default 0.2; 0 to 1; may change while running, also
            for one call of infer)
        iou_threshold: Boxes of one class that overlap more than this (intersection over union) are one object.
            (default 0.45; 0 to 1; may change while running, also for one call of infer; in OpenDR nms_thresh)
        max_candidates: So many of the best boxes are looked at before overlapping ones are thinned out. (default
            400; 1 to 1000; may change while running, also for one call of infer; in OpenDR nms_topk)
        max_detections: At most this many boxes a picture. (default 100; 1 to 1000; may change while running, also
            for one call of infer; in OpenDR post_nms)
        suppression: How overlapping boxes are thinned out. (default 'hard'; one of 'hard', 'soft', 'fast',
            'cluster'; may change while running, also for one call of infer; in OpenDR custom_nms)
        others: OpenDR's arguments, see ``opendr.engine.learners.BaseLearner``.

    Parameters of ``fit``, for one call or, given here, for all of them:
        backbone: The network that the detector stands on. (default 'mobilenet0.75'; one of 'mobilenet0.75',
            'mobilenet1.0', 'mobilenet0.5', 'mobilenet0.25')
        img_size: Side of the network's input, a multiple of 32; OpenDR's default of 512 costs two and a half
            times the time. (default 320; 96 to 1024 px)
        fitting: How a picture is brought to that size. (default 'stretch'; one of 'stretch', 'letterbox')
        classes: The classes to find, by their names in the data set; all of it when empty. (default [])
        stride: Pixels of the input from one cell of the finest level to the next, 8 or 16; the coarser ones are
            for larger objects and faster networks. (default 8; 8 to 16 px)
        aspect_ratios: Aspect ratios (width over height) of the anchors. (default [0.4, 1.0, 2.0]; 0.05 to 20)
        anchor_scales: Sides of the anchors of each level, in its strides. (default [3.0, 4.25]; 0.5 to 32)
        backbone_weights: A container or a file (ONNX, safetensors, PyTorch) whose first layers become the
            backbone, e.g. PoseNet's. (default None)
        freeze: So many of the backbone's 14 layers, from the input, stay as they are. (default 0; 0 to 14)
        least_score: Boxes with a lower score, which a teacher was not sure of, are neither object nor background.
            (default 0.5; 0 to 1)
        augment: Whether pictures are changed at random: mosaic, crop, expansion, flip, colour. (default True)
        epochs: How often the data set is gone through. (default 120; 1 to 1e+06; in OpenDR iters)
        max_steps: Optimiser steps after which training ends, whatever the number of epochs; 0 for no limit.
            (default 0; 0 to 1e+09)
        batch_size: Samples a batch. (default 8; 1 to 65536)
        accumulate: Batches whose gradients are added up for one step of the optimiser. (default 1; 1 to 4096; in
            OpenDR batches_per_iter)
        lr: Learning rate at its highest. (default 0.001; 0 to 100)
        optimizer: What turns gradients into steps. (default 'adamw'; one of 'adamw', 'adam', 'sgd', 'rmsprop'; in
            OpenDR optimizer_name)
        momentum: Momentum of `sgd` and `rmsprop`. (default 0.9; 0 to 1)
        weight_decay: Weight decay: decoupled from the gradient in `adamw`, added to it in the others. (default
            0.0005; 0 to 10)
        lr_schedule: How the learning rate goes on after the warm-up. (default 'cosine'; one of 'constant',
            'step', 'cosine', 'linear')
        warmup_steps: Steps over which the learning rate rises from `warmup_ratio` of itself. (default 100; 0 to
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
        val_after: Epochs between validations. (default 5; 1 to 1e+06)
        checkpoint_after_iter: Steps between checkpoints; 0 for none but those by the clock. (default 0; 0 to
            1e+08)
        checkpoint_minutes: Minutes between checkpoints; 0 for none by the clock. (default 10.0; 0 to 10000 min)
        checkpoints_kept: Checkpoints that are kept beside the best. (default 2; 1 to 1000)
        log_after: Steps between lines of the log. (default 100; 1 to 1e+06)
        num_workers: Threads that read and augment samples. (default 8; 0 to 1024)
        seed: What first weights, order, augmentation and dropout follow from. (default 0)

    Arguments of OpenDR that are taken and have no effect:
        keep_size: no effect: the network's input has one size.
        extract_maps: no effect: the feature maps stay inside the network.
        temp_path: no effect: what fit writes lies in its output folder.
        checkpoint_load_iter: no effect: fit goes on from the last checkpoint of its output folder.
    """

    iou_threshold: float
    max_candidates: int
    max_detections: int
    suppression: Literal['hard', 'soft', 'fast', 'cluster']
    def __init__(self, lr: float = ..., epochs: int = ..., batch_size: int = ..., device: str = ..., backbone: Literal['mobilenet0.75', 'mobilenet1.0', 'mobilenet0.5', 'mobilenet0.25'] = ..., img_size: int = ..., lr_schedule: Literal['constant', 'step', 'cosine', 'linear'] = ..., temp_path: str = ..., checkpoint_after_iter: int = ..., checkpoint_load_iter: int = ..., val_after: int = ..., log_after: int = ..., num_workers: int = ..., weight_decay: float = ..., momentum: float = ..., *, iters: int = ..., optimizer: Literal['adamw', 'adam', 'sgd', 'rmsprop'] = ..., network_head: str = ..., threshold: float = ..., scale: float = ..., fitting: Literal['stretch', 'letterbox'] = ..., classes: list[Any] = ..., stride: int = ..., aspect_ratios: list[Any] = ..., anchor_scales: list[Any] = ..., backbone_weights: Optional[str] = ..., freeze: int = ..., least_score: float = ..., augment: bool = ..., max_steps: int = ..., accumulate: int = ..., batches_per_iter: int = ..., optimizer_name: Literal['adamw', 'adam', 'sgd', 'rmsprop'] = ..., warmup_steps: int = ..., warmup_ratio: float = ..., lr_min: float = ..., lr_schedule_eta_min: float = ..., lr_steps: list[Any] = ..., drop_after_epoch: list[Any] = ..., lr_gamma: float = ..., lr_decay: float = ..., grad_clip: float = ..., ema: float = ..., early_stop: int = ..., checkpoint_minutes: float = ..., checkpoints_kept: int = ..., seed: int = ..., iou_threshold: float = ..., nms_thresh: float = ..., max_candidates: int = ..., nms_topk: int = ..., max_detections: int = ..., post_nms: int = ..., suppression: Literal['hard', 'soft', 'fast', 'cluster'] = ..., custom_nms: Literal['hard', 'soft', 'fast', 'cluster'] = ..., keep_size: Any = ..., extract_maps: Any = ...) -> None: ...
    @overload
    def infer(self, image: Union[Image, NDArray[Any], str, os.PathLike[str]], threshold: float = ..., keep_size: Any = ..., custom_nms: Any = ..., nms_thresh: float = ..., nms_topk: int = ..., post_nms: int = ..., extract_maps: Any = ..., *, iou_threshold: float = ..., max_candidates: int = ..., max_detections: int = ..., suppression: Literal['hard', 'soft', 'fast', 'cluster'] = ..., temp_path: Any = ..., checkpoint_load_iter: Any = ...) -> BoundingBoxList: ...  # type: ignore[overload-overlap]
    @overload
    def infer(self, image: Sequence[Union[Image, NDArray[Any], str, os.PathLike[str]]], threshold: float = ..., keep_size: Any = ..., custom_nms: Any = ..., nms_thresh: float = ..., nms_topk: int = ..., post_nms: int = ..., extract_maps: Any = ..., *, iou_threshold: float = ..., max_candidates: int = ..., max_detections: int = ..., suppression: Literal['hard', 'soft', 'fast', 'cluster'] = ..., temp_path: Any = ..., checkpoint_load_iter: Any = ...) -> list[BoundingBoxList]: ...
    @overload
    def infer(self, image: Iterator[Union[Image, NDArray[Any], str, os.PathLike[str]]], threshold: float = ..., keep_size: Any = ..., custom_nms: Any = ..., nms_thresh: float = ..., nms_topk: int = ..., post_nms: int = ..., extract_maps: Any = ..., *, iou_threshold: float = ..., max_candidates: int = ..., max_detections: int = ..., suppression: Literal['hard', 'soft', 'fast', 'cluster'] = ..., temp_path: Any = ..., checkpoint_load_iter: Any = ...) -> Iterator[BoundingBoxList]: ...
    def fit(self, dataset: Dataset, val_dataset: Optional[Dataset] = ..., logging_path: PathLike = ..., silent: bool = ..., verbose: bool = ..., *, out: Optional[PathLike] = ..., resume: bool = ..., split: Optional[str] = ..., val_split: Optional[str] = ..., limit: Optional[int] = ..., teacher: Union[None, str, Learner] = ..., teacher_threshold: Optional[float] = ..., teacher_classes: Sequence[str] = ..., teacher_map: Optional[Mapping[str, str]] = ..., teacher_by_number: bool = ..., keep_empty: bool = ..., skip_broken: bool = ..., backbone: Literal['mobilenet0.75', 'mobilenet1.0', 'mobilenet0.5', 'mobilenet0.25'] = ..., img_size: int = ..., fitting: Literal['stretch', 'letterbox'] = ..., classes: list[Any] = ..., stride: int = ..., aspect_ratios: list[Any] = ..., anchor_scales: list[Any] = ..., backbone_weights: Optional[str] = ..., freeze: int = ..., least_score: float = ..., augment: bool = ..., epochs: int = ..., iters: int = ..., max_steps: int = ..., batch_size: int = ..., accumulate: int = ..., batches_per_iter: int = ..., lr: float = ..., optimizer: Literal['adamw', 'adam', 'sgd', 'rmsprop'] = ..., optimizer_name: Literal['adamw', 'adam', 'sgd', 'rmsprop'] = ..., momentum: float = ..., weight_decay: float = ..., lr_schedule: Literal['constant', 'step', 'cosine', 'linear'] = ..., warmup_steps: int = ..., warmup_ratio: float = ..., lr_min: float = ..., lr_schedule_eta_min: float = ..., lr_steps: list[Any] = ..., drop_after_epoch: list[Any] = ..., lr_gamma: float = ..., lr_decay: float = ..., grad_clip: float = ..., ema: float = ..., early_stop: int = ..., val_after: int = ..., checkpoint_after_iter: int = ..., checkpoint_minutes: float = ..., checkpoints_kept: int = ..., log_after: int = ..., num_workers: int = ..., seed: int = ...) -> dict[str, Any]: ...
    def eval(self, dataset: Dataset, use_subset: Any = ..., subset_size: Any = ..., verbose: bool = ..., nms_thresh: Any = ..., nms_topk: Any = ..., post_nms: Any = ..., *, metric: Optional[str] = ..., split: Optional[str] = ..., limit: Optional[int] = ..., out: Optional[PathLike] = ..., skip_broken: bool = ..., classes: Optional[Mapping[str, str]] = ..., by_number: bool = ..., resamples: int = ..., **metric_params: Any) -> dict[str, Any]: ...

class TiledDetectionLearner(NativeLearner):
    """Looks at large pictures in tiles with any detector, where it is worth it, within a time budget.

    Task: object_detection_2d. ``infer`` takes:

        image: Image.

    and gives: BoundingBoxList.

    Args:
        threshold: Detections below this score are dropped; the detector is not asked for any below 0.1. (default
            0.35; 0 to 1; may change while running, also for one call of infer)
        iou_threshold: Boxes of one class from different tiles that overlap more than this (intersection over
            union) are one object. (default 0.5; 0 to 1; may change while running, also for one call of infer)
        max_detections: At most this many boxes a picture. (default 500; 1 to 2000; may change while running, also
            for one call of infer)
        tile: Side of a tile in the picture. What is looked for should fill a tenth of it or more. (default 256;
            32 to 4096 px; may change while running, also for one call of infer)
        tile_overlap: What neighbouring tiles share: what is smaller lies whole in one of them. At most half of a
            tile counts. (default 48; 0 to 2048 px; may change while running, also for one call of infer)
        whole: Whether the whole picture is looked at, too: for what is larger than a tile. (default True; may
            change while running, also for one call of infer)
        time_budget: Time for one picture; a tile that has begun is finished, and one is always looked at. 0: no
            limit, and answers that depend on nothing but the pictures. (default 0.0; 0 to 60000 ms; may change
            while running, also for one call of infer)
        max_tiles: At most so many tiles of one picture are looked at, the others in the next ones; 0: no limit.
            (default 0; 0 to 100000; may change while running, also for one call of infer)
        detail_threshold: A tile in which brightness differs by no more than this within 16 pixels, 0..=255, is
            empty; 0: no tile is. (default 16.0; 0 to 255; may change while running, also for one call of infer)
        change_threshold: A tile is looked at again once the brightness of 16 x 16 pixels in it changed by more
            than this, 0..=255; until then its last answer holds. 0: always. (default 6.0; 0 to 255; may change
            while running, also for one call of infer)
        memory: For so many pictures the answer of a tile that changed holds, if there was no time to look again.
            (default 5; 0 to 1000; may change while running, also for one call of infer)
        rotation: In every so-manyth picture the tile that was not looked at for longest is, be there anything or
            not; 0: never. (default 4; 0 to 1000; may change while running, also for one call of infer)
        parallel_tiles: Tiles that are looked at side by side, each on a thread with a copy of the network; 0: as
            many as there are cores, at most four. (default 0; 0 to 64)
        others: OpenDR's arguments, see ``opendr.engine.learners.BaseLearner``.
    """

    iou_threshold: float
    max_detections: int
    tile: int
    tile_overlap: int
    whole: bool
    time_budget: float
    max_tiles: int
    detail_threshold: float
    change_threshold: float
    memory: int
    rotation: int
    parallel_tiles: int
    def __init__(self, lr: float = ..., iters: int = ..., batch_size: int = ..., optimizer: str = ..., lr_schedule: str = ..., backbone: str = ..., network_head: str = ..., checkpoint_after_iter: int = ..., checkpoint_load_iter: int = ..., temp_path: str = ..., device: str = ..., threshold: float = ..., scale: float = ..., *, iou_threshold: float = ..., max_detections: int = ..., tile: int = ..., tile_overlap: int = ..., whole: bool = ..., time_budget: float = ..., max_tiles: int = ..., detail_threshold: float = ..., change_threshold: float = ..., memory: int = ..., rotation: int = ..., parallel_tiles: int = ...) -> None: ...
    @overload
    def infer(self, image: Union[Image, NDArray[Any], str, os.PathLike[str]], *, threshold: float = ..., iou_threshold: float = ..., max_detections: int = ..., tile: int = ..., tile_overlap: int = ..., whole: bool = ..., time_budget: float = ..., max_tiles: int = ..., detail_threshold: float = ..., change_threshold: float = ..., memory: int = ..., rotation: int = ...) -> BoundingBoxList: ...  # type: ignore[overload-overlap]
    @overload
    def infer(self, image: Sequence[Union[Image, NDArray[Any], str, os.PathLike[str]]], *, threshold: float = ..., iou_threshold: float = ..., max_detections: int = ..., tile: int = ..., tile_overlap: int = ..., whole: bool = ..., time_budget: float = ..., max_tiles: int = ..., detail_threshold: float = ..., change_threshold: float = ..., memory: int = ..., rotation: int = ...) -> list[BoundingBoxList]: ...
    @overload
    def infer(self, image: Iterator[Union[Image, NDArray[Any], str, os.PathLike[str]]], *, threshold: float = ..., iou_threshold: float = ..., max_detections: int = ..., tile: int = ..., tile_overlap: int = ..., whole: bool = ..., time_budget: float = ..., max_tiles: int = ..., detail_threshold: float = ..., change_threshold: float = ..., memory: int = ..., rotation: int = ...) -> Iterator[BoundingBoxList]: ...

class Seq2SeqNMSLearner(Seq2SeqNms):
    """Tells which of a detector's overlapping boxes to keep, by how they lie and look; it trains.

    Task: object_detection_2d. ``infer`` takes:

        image: Image. The picture.
        detections: BoundingBoxList. Its boxes before suppression; boxes of classes that the model does not know
            are left out.

    and gives: BoundingBoxList.

    Args:
        threshold: Boxes whose new score is below this are dropped. (default 0.1; 0 to 1; may change while
            running, also for one call of infer)
        iou_filtering: Of boxes that overlap more than this (intersection over union) only the best is looked at.
            (default 0.8; 0 to 1; may change while running, also for one call of infer)
        max_dt_boxes: So many of the best boxes are looked at. (default 400; 1 to 1000; may change while running,
            also for one call of infer; in OpenDR top_k)
        others: OpenDR's arguments, see ``opendr.engine.learners.BaseLearner``.

    Parameters of ``fit``, for one call or, given here, for all of them:
        epochs: How often the data set is gone through. (default 8; 1 to 1e+06; in OpenDR iters)
        max_steps: Optimiser steps after which training ends, whatever the number of epochs; 0 for no limit.
            (default 0; 0 to 1e+09)
        batch_size: Samples a batch. (default 8; 1 to 65536)
        accumulate: Batches whose gradients are added up for one step of the optimiser. (default 1; 1 to 4096; in
            OpenDR batches_per_iter)
        lr: Learning rate at its highest. (default 0.0001; 0 to 100)
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
        lr_min: Learning rate at the end of `cosine` and `linear`. (default 1e-06; 0 to 100; in OpenDR
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
        num_workers: Threads that read and augment samples. (default 2; 0 to 1024)
        seed: What first weights, order, augmentation and dropout follow from. (default 0)
        variant: How large the network is; going on from a model, its own. (default 'medium'; one of 'medium',
            'light', 'full')
        dropout: Share of features that are left out at random. (default 0.025; 0 to 0.9)
        classes: The classes whose boxes are suppressed, by their names in the data set; all of it when empty.
            (default [])
        nms_gt_iou: From this intersection over union on, a box can stand for an object. (default 0.5; 0.05 to
            0.95)
        positive_weight: How much a box counts that stands for an object, against one that does not. (default 2.0;
            0.01 to 100)
        detector: A container of a detector that finds boxes in the pictures, its suppression switched off:
            NanoDet, CenterNet, SSD, or a finder of faces. (default None)
        versions: With a detector: so many versions of each picture, all but the first mirrored, cropped and
            recoloured at random. (default 1; 1 to 1000)

    Arguments of OpenDR that are taken and have no effect:
        app_feats: no effect: boxes are always described by FMoD.
        fmod_map_type: no effect: FMoD always looks at edges.
        fmod_map_bin: no effect: a place has an edge or has none.
        app_input_dim: no effect: it follows from the variant.
        temp_path: no effect: what fit writes lies in its output folder.
        checkpoint_load_iter: no effect: fit goes on from the last checkpoint of its output folder.
    """

    iou_filtering: float
    max_dt_boxes: int
    def __init__(self, lr: float = ..., epochs: int = ..., device: str = ..., temp_path: str = ..., checkpoint_after_iter: int = ..., checkpoint_load_iter: int = ..., log_after: int = ..., variant: Literal['medium', 'light', 'full'] = ..., iou_filtering: float = ..., dropout: float = ..., app_feats: Any = ..., fmod_map_type: Any = ..., fmod_map_bin: Any = ..., app_input_dim: Any = ..., *, iters: int = ..., batch_size: int = ..., optimizer: Literal['adamw', 'adam', 'sgd', 'rmsprop'] = ..., lr_schedule: Literal['constant', 'step', 'cosine', 'linear'] = ..., backbone: str = ..., network_head: str = ..., threshold: float = ..., scale: float = ..., max_steps: int = ..., accumulate: int = ..., batches_per_iter: int = ..., optimizer_name: Literal['adamw', 'adam', 'sgd', 'rmsprop'] = ..., momentum: float = ..., weight_decay: float = ..., warmup_steps: int = ..., warmup_ratio: float = ..., lr_min: float = ..., lr_schedule_eta_min: float = ..., lr_steps: list[Any] = ..., drop_after_epoch: list[Any] = ..., lr_gamma: float = ..., lr_decay: float = ..., grad_clip: float = ..., ema: float = ..., early_stop: int = ..., val_after: int = ..., checkpoint_minutes: float = ..., checkpoints_kept: int = ..., num_workers: int = ..., seed: int = ..., classes: list[Any] = ..., nms_gt_iou: float = ..., positive_weight: float = ..., detector: Optional[str] = ..., versions: int = ..., max_dt_boxes: int = ..., top_k: int = ...) -> None: ...
    def infer(self, image: Union[Image, NDArray[Any], str, os.PathLike[str]], detections: BoundingBoxList, *, threshold: float = ..., iou_filtering: float = ..., max_dt_boxes: int = ..., top_k: int = ..., app_feats: Any = ..., fmod_map_type: Any = ..., fmod_map_bin: Any = ..., app_input_dim: Any = ..., temp_path: Any = ..., checkpoint_load_iter: Any = ...) -> BoundingBoxList: ...
    def fit(self, dataset: Dataset, logging_path: PathLike = ..., logging_flush_secs: Any = ..., silent: bool = ..., verbose: bool = ..., nms_gt_iou: float = ..., max_dt_boxes: Any = ..., datasets_folder: Any = ..., use_ssd: Any = ..., ssd_model: Any = ..., lr_step: Any = ..., *, val_dataset: Optional[Dataset] = ..., out: Optional[PathLike] = ..., resume: bool = ..., split: Optional[str] = ..., val_split: Optional[str] = ..., limit: Optional[int] = ..., teacher: Union[None, str, Learner] = ..., teacher_threshold: Optional[float] = ..., teacher_classes: Sequence[str] = ..., teacher_map: Optional[Mapping[str, str]] = ..., teacher_by_number: bool = ..., keep_empty: bool = ..., skip_broken: bool = ..., epochs: int = ..., iters: int = ..., max_steps: int = ..., batch_size: int = ..., accumulate: int = ..., batches_per_iter: int = ..., lr: float = ..., optimizer: Literal['adamw', 'adam', 'sgd', 'rmsprop'] = ..., optimizer_name: Literal['adamw', 'adam', 'sgd', 'rmsprop'] = ..., momentum: float = ..., weight_decay: float = ..., lr_schedule: Literal['constant', 'step', 'cosine', 'linear'] = ..., warmup_steps: int = ..., warmup_ratio: float = ..., lr_min: float = ..., lr_schedule_eta_min: float = ..., lr_steps: list[Any] = ..., drop_after_epoch: list[Any] = ..., lr_gamma: float = ..., lr_decay: float = ..., grad_clip: float = ..., ema: float = ..., early_stop: int = ..., val_after: int = ..., checkpoint_after_iter: int = ..., checkpoint_minutes: float = ..., checkpoints_kept: int = ..., log_after: int = ..., num_workers: int = ..., seed: int = ..., variant: Literal['medium', 'light', 'full'] = ..., dropout: float = ..., classes: list[Any] = ..., positive_weight: float = ..., detector: Optional[str] = ..., versions: int = ...) -> dict[str, Any]: ...
    def eval(self, dataset: Dataset, split: Optional[str] = ..., verbose: bool = ..., max_dt_boxes: Any = ..., threshold: Any = ..., datasets_folder: Any = ..., use_ssd: Any = ..., ssd_model: Any = ..., *, metric: Optional[str] = ..., limit: Optional[int] = ..., out: Optional[PathLike] = ..., skip_broken: bool = ..., classes: Optional[Mapping[str, str]] = ..., by_number: bool = ..., resamples: int = ..., **metric_params: Any) -> dict[str, Any]: ...
    @classmethod
    def download(cls, path: Optional[PathLike] = ..., model_name: Any = ..., verbose: bool = ..., url: Optional[str] = ..., *, mode: str = ..., variant: Optional[str] = ...) -> str: ...

class GemLearnerOutputs(NamedTuple):
    boxes: BoundingBoxList
    sensors: Category

class GemLearner(NativeLearner):
    """Finds objects by a colour and an infrared camera and tells which of them to trust; it trains.

    Task: object_detection_2d. ``infer`` takes:

        colour: Image. The picture in colour. Boxes are in its pixels.
        infrared: Image. The picture of the infrared sensor (or of another, as in training), of the same view:
            sizes may differ, what it shows at a share of its width and height may not.

    and gives: BoundingBoxList, Category.

    Args:
        threshold: Detections below this score are dropped. OpenDR's default of 0.7 is for the scores of DETR.
            (default 0.3; 0 to 1; may change while running, also for one call of infer)
        iou_threshold: Boxes of one class that overlap more than this (intersection over union) are one object.
            (default 0.45; 0 to 1; may change while running, also for one call of infer)
        max_detections: At most this many boxes a pair of pictures. (default 100; 1 to 1000; may change while
            running, also for one call of infer)
        others: OpenDR's arguments, see ``opendr.engine.learners.BaseLearner``.

    Parameters of ``fit``, for one call or, given here, for all of them:
        backbone: The network that sees each sensor, twice: they share no weights. (default 'mobilenet0.75'; one
            of 'mobilenet0.75', 'mobilenet1.0', 'mobilenet0.5', 'mobilenet0.25')
        img_size: Side of the network's inputs, a multiple of 32. (default 320; 96 to 1024 px)
        fitting: How pictures are brought to that size. (default 'stretch'; one of 'stretch', 'letterbox')
        classes: The classes to find, by their names in the data set; all of it when empty. (default [])
        stride: Pixels of the input from one cell of the finest level to the next, 8 or 16. (default 8; 8 to 16
            px)
        aspect_ratios: Aspect ratios (width over height) of the anchors. (default [0.4, 1.0, 2.0]; 0.05 to 20)
        anchor_scales: Sides of the anchors of each level, in its strides. (default [3.0, 4.25]; 0.5 to 32)
        drop_sensor: The share of samples of which one sensor, at random, sees nothing, so that either may fail.
            (default 0.3; 0 to 1)
        augment: Whether pictures are mirrored and moved at random, both alike. (default True)
        epochs: How often the data set is gone through. (default 120; 1 to 1e+06; in OpenDR iters)
        max_steps: Optimiser steps after which training ends, whatever the number of epochs; 0 for no limit.
            (default 0; 0 to 1e+09)
        batch_size: Samples a batch. (default 8; 1 to 65536)
        accumulate: Batches whose gradients are added up for one step of the optimiser. (default 1; 1 to 4096; in
            OpenDR batches_per_iter)
        lr: Learning rate at its highest. (default 0.001; 0 to 100)
        optimizer: What turns gradients into steps. (default 'adamw'; one of 'adamw', 'adam', 'sgd', 'rmsprop'; in
            OpenDR optimizer_name)
        momentum: Momentum of `sgd` and `rmsprop`. (default 0.9; 0 to 1)
        weight_decay: Weight decay: decoupled from the gradient in `adamw`, added to it in the others. (default
            0.0005; 0 to 10)
        lr_schedule: How the learning rate goes on after the warm-up. (default 'cosine'; one of 'constant',
            'step', 'cosine', 'linear')
        warmup_steps: Steps over which the learning rate rises from `warmup_ratio` of itself. (default 100; 0 to
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
        val_after: Epochs between validations. (default 5; 1 to 1e+06)
        checkpoint_after_iter: Steps between checkpoints; 0 for none but those by the clock. (default 0; 0 to
            1e+08)
        checkpoint_minutes: Minutes between checkpoints; 0 for none by the clock. (default 10.0; 0 to 10000 min)
        checkpoints_kept: Checkpoints that are kept beside the best. (default 2; 1 to 1000)
        log_after: Steps between lines of the log. (default 10; 1 to 1e+06)
        num_workers: Threads that read and augment samples. (default 2; 0 to 1024)
        seed: What first weights, order, augmentation and dropout follow from. (default 0)

    Arguments of OpenDR that are taken and have no effect:
        model_config_path: no effect: what the model is made of are parameters of fit.
        dataset_config_path: no effect: the data set says it itself.
        num_classes: no effect: the classes of the data set are trained.
        panoptic_segmentation: no effect: it finds boxes alone.
        temp_path: no effect: what fit writes lies in its output folder.
        checkpoint_load_iter: no effect: fit goes on from the last checkpoint of its output folder.
    """

    iou_threshold: float
    max_detections: int
    def __init__(self, model_config_path: Any = ..., dataset_config_path: Any = ..., iters: int = ..., lr: float = ..., batch_size: int = ..., optimizer: Literal['adamw', 'adam', 'sgd', 'rmsprop'] = ..., backbone: Literal['mobilenet0.75', 'mobilenet1.0', 'mobilenet0.5', 'mobilenet0.25'] = ..., checkpoint_after_iter: int = ..., checkpoint_load_iter: int = ..., temp_path: str = ..., device: str = ..., threshold: float = ..., num_classes: Any = ..., panoptic_segmentation: Any = ..., *, lr_schedule: Literal['constant', 'step', 'cosine', 'linear'] = ..., network_head: str = ..., scale: float = ..., img_size: int = ..., fitting: Literal['stretch', 'letterbox'] = ..., classes: list[Any] = ..., stride: int = ..., aspect_ratios: list[Any] = ..., anchor_scales: list[Any] = ..., drop_sensor: float = ..., augment: bool = ..., epochs: int = ..., max_steps: int = ..., accumulate: int = ..., batches_per_iter: int = ..., optimizer_name: Literal['adamw', 'adam', 'sgd', 'rmsprop'] = ..., momentum: float = ..., weight_decay: float = ..., warmup_steps: int = ..., warmup_ratio: float = ..., lr_min: float = ..., lr_schedule_eta_min: float = ..., lr_steps: list[Any] = ..., drop_after_epoch: list[Any] = ..., lr_gamma: float = ..., lr_decay: float = ..., grad_clip: float = ..., ema: float = ..., early_stop: int = ..., val_after: int = ..., checkpoint_minutes: float = ..., checkpoints_kept: int = ..., log_after: int = ..., num_workers: int = ..., seed: int = ..., iou_threshold: float = ..., max_detections: int = ...) -> None: ...
    def infer(self, colour: Union[Image, NDArray[Any], str, os.PathLike[str]], infrared: Union[Image, NDArray[Any], str, os.PathLike[str]], *, threshold: float = ..., iou_threshold: float = ..., max_detections: int = ..., model_config_path: Any = ..., dataset_config_path: Any = ..., num_classes: Any = ..., panoptic_segmentation: Any = ..., temp_path: Any = ..., checkpoint_load_iter: Any = ...) -> GemLearnerOutputs: ...
    def fit(self, m1_train_edataset: Dataset = ..., m2_train_edataset: Any = ..., annotations_folder: Any = ..., m1_train_annotations_file: Any = ..., m2_train_annotations_file: Any = ..., m1_train_images_folder: Optional[str] = ..., m2_train_images_folder: Any = ..., out_dir: Optional[PathLike] = ..., trial_dir: Any = ..., logging_path: PathLike = ..., silent: bool = ..., verbose: bool = ..., m1_val_edataset: Optional[Dataset] = ..., m2_val_edataset: Any = ..., m1_val_annotations_file: Any = ..., m2_val_annotations_file: Any = ..., m1_val_images_folder: Optional[str] = ..., m2_val_images_folder: Any = ..., *, dataset: Dataset = ..., val_dataset: Optional[Dataset] = ..., out: Optional[PathLike] = ..., resume: bool = ..., split: Optional[str] = ..., val_split: Optional[str] = ..., limit: Optional[int] = ..., teacher: Union[None, str, Learner] = ..., teacher_threshold: Optional[float] = ..., teacher_classes: Sequence[str] = ..., teacher_map: Optional[Mapping[str, str]] = ..., teacher_by_number: bool = ..., keep_empty: bool = ..., skip_broken: bool = ..., backbone: Literal['mobilenet0.75', 'mobilenet1.0', 'mobilenet0.5', 'mobilenet0.25'] = ..., img_size: int = ..., fitting: Literal['stretch', 'letterbox'] = ..., classes: list[Any] = ..., stride: int = ..., aspect_ratios: list[Any] = ..., anchor_scales: list[Any] = ..., drop_sensor: float = ..., augment: bool = ..., epochs: int = ..., iters: int = ..., max_steps: int = ..., batch_size: int = ..., accumulate: int = ..., batches_per_iter: int = ..., lr: float = ..., optimizer: Literal['adamw', 'adam', 'sgd', 'rmsprop'] = ..., optimizer_name: Literal['adamw', 'adam', 'sgd', 'rmsprop'] = ..., momentum: float = ..., weight_decay: float = ..., lr_schedule: Literal['constant', 'step', 'cosine', 'linear'] = ..., warmup_steps: int = ..., warmup_ratio: float = ..., lr_min: float = ..., lr_schedule_eta_min: float = ..., lr_steps: list[Any] = ..., drop_after_epoch: list[Any] = ..., lr_gamma: float = ..., lr_decay: float = ..., grad_clip: float = ..., ema: float = ..., early_stop: int = ..., val_after: int = ..., checkpoint_after_iter: int = ..., checkpoint_minutes: float = ..., checkpoints_kept: int = ..., log_after: int = ..., num_workers: int = ..., seed: int = ...) -> dict[str, Any]: ...
    def eval(self, m1_edataset: Dataset = ..., m2_edataset: Any = ..., m1_images_folder: Optional[str] = ..., m2_images_folder: Any = ..., annotations_folder: Any = ..., m1_annotations_file: Any = ..., m2_annotations_file: Any = ..., verbose: bool = ..., *, dataset: Dataset = ..., metric: Optional[str] = ..., split: Optional[str] = ..., limit: Optional[int] = ..., out: Optional[PathLike] = ..., skip_broken: bool = ..., classes: Optional[Mapping[str, str]] = ..., by_number: bool = ..., resamples: int = ..., **metric_params: Any) -> dict[str, Any]: ...

class Dataset_NMS:
    """Not here yet: give fit of Seq2SeqNMSLearner an ExternalDataset, and `detector` for the boxes."""

    def __init__(self, *args: Any, **kwargs: Any) -> NoReturn: ...

class Detectron2Learner:
    """Not here yet: use CenterNetDetectorLearner for boxes, BodyPixLearner for masks of persons."""

    def __init__(self, *args: Any, **kwargs: Any) -> NoReturn: ...

class DetrLearner:
    """Not here yet: use CenterNetDetectorLearner, which finds the same classes of COCO."""

    def __init__(self, *args: Any, **kwargs: Any) -> NoReturn: ...

class FSeq2NMSLearner:
    """Not here yet: use Seq2SeqNMSLearner, which looks at edges instead of the detector's maps."""

    def __init__(self, *args: Any, **kwargs: Any) -> NoReturn: ...

class ImageToNDArrayTransform:
    """Not here yet: there is no MXNet; use ImageToNumpyArrayTransform."""

    def __init__(self, *args: Any, **kwargs: Any) -> NoReturn: ...

class RetinaFaceLearner:
    """Not here yet: use YunetLearner of face_detection, its variant `masked` for faces in masks."""

    def __init__(self, *args: Any, **kwargs: Any) -> NoReturn: ...

class YOLOv3DetectorLearner:
    """Not here yet: use CenterNetDetectorLearner or NanodetLearner."""

    def __init__(self, *args: Any, **kwargs: Any) -> NoReturn: ...

class YOLOv5DetectorLearner:
    """Not here yet: use NanodetLearner, which is as light."""

    def __init__(self, *args: Any, **kwargs: Any) -> NoReturn: ...
