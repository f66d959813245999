"""Learners of the task pose_estimation. Made by bindings/python/stubs.py; do not edit."""

# Each learner has the arguments of OpenDR's class of its name.
# mypy: disable-error-code="override"
# pyright: reportIncompatibleMethodOverride=false

import os
from collections.abc import Iterator, Mapping, Sequence
from typing import Any, Literal, NamedTuple, NoReturn, Optional, Union, overload

from numpy.typing import ArrayLike, NDArray
from opendr._drawing import draw as draw
from opendr._drawing import get_bbox as get_bbox
from opendr._upstream.pose_datasets import CocoTrainDataset as CocoTrainDataset
from opendr._upstream.pose_datasets import CocoValDataset as CocoValDataset
from opendr._native_learner import NativeLearner, PathLike
from opendr._upstream.learners.people import HighResolutionPoses
from opendr.engine.data import Image
from opendr.engine.datasets import Dataset
from opendr.engine.learners import Learner
from opendr.engine.target import PoseList

class MovenetLearner(NativeLearner):
    """MoveNet finds 18 joints of one person (lightning) or of up to six (multipose).

    Task: pose_estimation. ``infer`` takes:

        image: Image.

    and gives: PoseList.

    Args:
        threshold: Persons below this score are dropped. (default 0.2; 0 to 1; may change while running, also for
            one call of infer)
        keypoint_threshold: Joints below this score are missing. (default 0.1; 0 to 1; may change while running,
            also for one call of infer)
        size: Longer side of the input of MultiPose; a multiple of 32. Larger finds smaller persons. (default 256;
            128 to 1024 px)
        others: OpenDR's arguments, see ``opendr.engine.learners.BaseLearner``.
    """

    keypoint_threshold: float
    size: int
    def __init__(self, lr: float = ..., iters: int = ..., batch_size: int = ..., optimizer: str = ..., lr_schedule: str = ..., backbone: str = ..., network_head: str = ..., checkpoint_after_iter: int = ..., checkpoint_load_iter: int = ..., temp_path: str = ..., device: str = ..., threshold: float = ..., scale: float = ..., *, keypoint_threshold: float = ..., size: int = ...) -> None: ...
    @overload
    def infer(self, image: Union[Image, NDArray[Any], str, os.PathLike[str]], *, threshold: float = ..., keypoint_threshold: float = ...) -> PoseList: ...  # type: ignore[overload-overlap]
    @overload
    def infer(self, image: Sequence[Union[Image, NDArray[Any], str, os.PathLike[str]]], *, threshold: float = ..., keypoint_threshold: float = ...) -> list[PoseList]: ...
    @overload
    def infer(self, image: Iterator[Union[Image, NDArray[Any], str, os.PathLike[str]]], *, threshold: float = ..., keypoint_threshold: float = ...) -> Iterator[PoseList]: ...

class PosenetLearner(NativeLearner):
    """PoseNet finds 18 joints of any number of persons; convolutions only.

    Task: pose_estimation. ``infer`` takes:

        image: Image.

    and gives: PoseList.

    Args:
        threshold: Persons below this score are dropped. (default 0.25; 0 to 1; may change while running, also for
            one call of infer)
        keypoint_threshold: Joints below this score are missing. (default 0.1; 0 to 1; may change while running,
            also for one call of infer)
        peak_threshold: Joints below this score start no person. (default 0.5; 0.01 to 0.99; may change while
            running, also for one call of infer)
        nms_radius: Joints of one kind nearer than this belong to one person, in pixels of the network's input.
            (default 20.0; 0 to 200 px; may change while running, also for one call of infer)
        max_detections: At most this many persons a picture. (default 20; 1 to 100; may change while running, also
            for one call of infer)
        others: OpenDR's arguments, see ``opendr.engine.learners.BaseLearner``.
    """

    keypoint_threshold: float
    peak_threshold: float
    nms_radius: float
    max_detections: int
    def __init__(self, lr: float = ..., iters: int = ..., batch_size: int = ..., optimizer: str = ..., lr_schedule: str = ..., backbone: str = ..., network_head: str = ..., checkpoint_after_iter: int = ..., checkpoint_load_iter: int = ..., temp_path: str = ..., device: str = ..., threshold: float = ..., scale: float = ..., *, keypoint_threshold: float = ..., peak_threshold: float = ..., nms_radius: float = ..., max_detections: int = ...) -> None: ...
    @overload
    def infer(self, image: Union[Image, NDArray[Any], str, os.PathLike[str]], *, threshold: float = ..., keypoint_threshold: float = ..., peak_threshold: float = ..., nms_radius: float = ..., max_detections: int = ...) -> PoseList: ...  # type: ignore[overload-overlap]
    @overload
    def infer(self, image: Sequence[Union[Image, NDArray[Any], str, os.PathLike[str]]], *, threshold: float = ..., keypoint_threshold: float = ..., peak_threshold: float = ..., nms_radius: float = ..., max_detections: int = ...) -> list[PoseList]: ...
    @overload
    def infer(self, image: Iterator[Union[Image, NDArray[Any], str, os.PathLike[str]]], *, threshold: float = ..., keypoint_threshold: float = ..., peak_threshold: float = ..., nms_radius: float = ..., max_detections: int = ...) -> Iterator[PoseList]: ...

class LightweightOpenPoseLearner(NativeLearner):
    """Lightweight OpenPose finds 18 joints of any number of persons and follows them; it trains.

    Task: pose_estimation. ``infer`` takes:

        image: Image.

    and gives: PoseList.

    Args:
        threshold: Persons below this score are dropped. The score is the mean of those of the 18 joints; missing
            ones count as 0. (default 0.1; 0 to 1; may change while running, also for one call of infer)
        keypoint_threshold: Joints below this score are missing. (default 0.1; 0.01 to 1; may change while
            running, also for one call of infer)
        base_height: Height of the network's input; the width follows from the picture. Larger finds smaller
            persons. (default 256; 64 to 2048 px; may change while running, also for one call of infer)
        upsample_ratio: Steps between the cells of the heat maps in which joints are looked for. (default 4; 1 to
            8; may change while running, also for one call of infer)
        track: Whether persons keep their identity from frame to frame. (default True; may change while running,
            also for one call of infer)
        smooth: Whether joints are smoothed over frames; needs `track`. (default True; may change while running,
            also for one call of infer)
        others: OpenDR's arguments, see ``opendr.engine.learners.BaseLearner``.

    Parameters of ``fit``, for one call or, given here, for all of them:
        epochs: How often the data set is gone through. (default 280; 1 to 1e+06; in OpenDR iters)
        max_steps: Optimiser steps after which training ends, whatever the number of epochs; 0 for no limit.
            (default 0; 0 to 1e+09)
        batch_size: Samples a batch. (default 80; 1 to 65536)
        accumulate: Batches whose gradients are added up for one step of the optimiser. (default 1; 1 to 4096; in
            OpenDR batches_per_iter)
        lr: Learning rate at its highest. (default 4e-05; 0 to 100)
        optimizer: What turns gradients into steps. (default 'adam'; one of 'adamw', 'adam', 'sgd', 'rmsprop'; in
            OpenDR optimizer_name)
        momentum: Momentum of `sgd` and `rmsprop`. (default 0.9; 0 to 1)
        weight_decay: Weight decay: decoupled from the gradient in `adamw`, added to it in the others. (default
            0.0005; 0 to 10)
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
        checkpoint_after_iter: Steps between checkpoints; 0 for none but those by the clock. (default 5000; 0 to
            1e+08)
        checkpoint_minutes: Minutes between checkpoints; 0 for none by the clock. (default 10.0; 0 to 10000 min)
        checkpoints_kept: Checkpoints that are kept beside the best. (default 2; 1 to 1000)
        log_after: Steps between lines of the log. (default 100; 1 to 1e+06)
        num_workers: Threads that read and augment samples. (default 2; 0 to 1024)
        seed: What first weights, order, augmentation and dropout follow from. (default 0)
        backbone: Where the backbone begins: `mobilenet`, with random weights; else a container or file of weights
            whose first layers are a MobileNetV1 of this width, such as PoseNet's (width 0.75, 2 extra blocks).
            (default 'mobilenet')
        freeze: Whether the backbone keeps its weights. (default False)
        width: Factor on the channels of the backbone. (default 1.0; 0.1 to 2; in OpenDR mobilenetv2_width)
        extra_blocks: Blocks of the backbone after those of the paper. (default 0; 0 to 8)
        channels: Channels of the stages; fewer make a smaller network. (default 128; 4 to 1024)
        separable: Whether the convolutions of the stages are separable: a seventh of their weights. (default
            False)
        num_refinement_stages: Stages that refine the maps of the first. (default 2; 0 to 8)
        crop_size: Side of the pictures that are trained on; a multiple of 8. (default 368; 32 to 2048 px)
        augment: Whether pictures are cut around persons, turned, scaled, mirrored and recoloured at random.
            (default True)

    Arguments of OpenDR that are taken and have no effect:
        mobilenet_use_stride: no effect: the maps lie at every 8th pixel.
        shufflenet_groups: no effect: the backbone is MobileNet.
        experiment_name: no effect: the folder of a training says it.
        weights_only: no effect: `resume` of `fit` says it.
        output_name: no effect: `eval` says where answers are written.
        multiscale: no effect: a larger `base_height` finds smaller persons.
        scales: no effect: a larger `base_height` finds smaller persons.
        visualize: no effect: `draw` shows poses.
        img_mean: no effect: the network says what it takes.
        img_scale: no effect: the network says what it takes.
        pad_value: no effect: the network says what it takes.
        half_precision: no effect: the runtime chooses the precision.
    """

    keypoint_threshold: float
    base_height: int
    upsample_ratio: int
    track: bool
    smooth: bool
    def __init__(self, lr: float = ..., epochs: int = ..., batch_size: int = ..., device: str = ..., backbone: str = ..., lr_schedule: Literal['constant', 'step', 'cosine', 'linear'] = ..., temp_path: str = ..., checkpoint_after_iter: int = ..., checkpoint_load_iter: int = ..., val_after: int = ..., log_after: int = ..., mobilenet_use_stride: Any = ..., mobilenetv2_width: float = ..., shufflenet_groups: Any = ..., num_refinement_stages: int = ..., batches_per_iter: int = ..., experiment_name: Any = ..., num_workers: int = ..., weights_only: Any = ..., output_name: Any = ..., multiscale: Any = ..., scales: Any = ..., visualize: Any = ..., base_height: int = ..., img_mean: Any = ..., img_scale: Any = ..., pad_value: Any = ..., half_precision: Any = ..., *, iters: int = ..., optimizer: Literal['adamw', 'adam', 'sgd', 'rmsprop'] = ..., network_head: str = ..., threshold: float = ..., scale: float = ..., max_steps: int = ..., accumulate: int = ..., optimizer_name: Literal['adamw', 'adam', 'sgd', 'rmsprop'] = ..., momentum: float = ..., weight_decay: float = ..., warmup_steps: int = ..., warmup_ratio: float = ..., lr_min: float = ..., lr_schedule_eta_min: float = ..., lr_steps: list[Any] = ..., drop_after_epoch: list[Any] = ..., lr_gamma: float = ..., lr_decay: float = ..., grad_clip: float = ..., ema: float = ..., early_stop: int = ..., checkpoint_minutes: float = ..., checkpoints_kept: int = ..., seed: int = ..., freeze: bool = ..., width: float = ..., extra_blocks: int = ..., channels: int = ..., separable: bool = ..., crop_size: int = ..., augment: bool = ..., keypoint_threshold: float = ..., upsample_ratio: int = ..., track: bool = ..., smooth: bool = ...) -> None: ...
    @overload
    def infer(self, image: Union[Image, NDArray[Any], str, os.PathLike[str]], upsample_ratio: int = ..., track: bool = ..., smooth: bool = ..., *, threshold: float = ..., keypoint_threshold: float = ..., base_height: int = ..., mobilenet_use_stride: Any = ..., shufflenet_groups: Any = ..., experiment_name: Any = ..., weights_only: Any = ..., output_name: Any = ..., multiscale: Any = ..., scales: Any = ..., visualize: Any = ..., img_mean: Any = ..., img_scale: Any = ..., pad_value: Any = ..., half_precision: Any = ...) -> PoseList: ...  # type: ignore[overload-overlap]
    @overload
    def infer(self, image: Sequence[Union[Image, NDArray[Any], str, os.PathLike[str]]], upsample_ratio: int = ..., track: bool = ..., smooth: bool = ..., *, threshold: float = ..., keypoint_threshold: float = ..., base_height: int = ..., mobilenet_use_stride: Any = ..., shufflenet_groups: Any = ..., experiment_name: Any = ..., weights_only: Any = ..., output_name: Any = ..., multiscale: Any = ..., scales: Any = ..., visualize: Any = ..., img_mean: Any = ..., img_scale: Any = ..., pad_value: Any = ..., half_precision: Any = ...) -> list[PoseList]: ...
    @overload
    def infer(self, image: Iterator[Union[Image, NDArray[Any], str, os.PathLike[str]]], upsample_ratio: int = ..., track: bool = ..., smooth: bool = ..., *, threshold: float = ..., keypoint_threshold: float = ..., base_height: int = ..., mobilenet_use_stride: Any = ..., shufflenet_groups: Any = ..., experiment_name: Any = ..., weights_only: Any = ..., output_name: Any = ..., multiscale: Any = ..., scales: Any = ..., visualize: Any = ..., img_mean: Any = ..., img_scale: Any = ..., pad_value: Any = ..., half_precision: Any = ...) -> Iterator[PoseList]: ...
    def fit(self, dataset: Dataset, val_dataset: Optional[Dataset] = ..., logging_path: PathLike = ..., logging_flush_secs: Any = ..., silent: bool = ..., verbose: bool = ..., epochs: int = ..., use_val_subset: Any = ..., val_subset_size: Any = ..., images_folder_name: Optional[str] = ..., annotations_filename: Any = ..., val_images_folder_name: Optional[str] = ..., val_annotations_filename: Any = ..., *, out: Optional[PathLike] = ..., resume: bool = ..., split: Optional[str] = ..., val_split: Optional[str] = ..., limit: Optional[int] = ..., teacher: Union[None, str, Learner] = ..., teacher_threshold: Optional[float] = ..., teacher_classes: Sequence[str] = ..., teacher_map: Optional[Mapping[str, str]] = ..., teacher_by_number: bool = ..., keep_empty: bool = ..., skip_broken: bool = ..., iters: int = ..., max_steps: int = ..., batch_size: int = ..., accumulate: int = ..., batches_per_iter: int = ..., lr: float = ..., optimizer: Literal['adamw', 'adam', 'sgd', 'rmsprop'] = ..., optimizer_name: Literal['adamw', 'adam', 'sgd', 'rmsprop'] = ..., momentum: float = ..., weight_decay: float = ..., lr_schedule: Literal['constant', 'step', 'cosine', 'linear'] = ..., warmup_steps: int = ..., warmup_ratio: float = ..., lr_min: float = ..., lr_schedule_eta_min: float = ..., lr_steps: list[Any] = ..., drop_after_epoch: list[Any] = ..., lr_gamma: float = ..., lr_decay: float = ..., grad_clip: float = ..., ema: float = ..., early_stop: int = ..., val_after: int = ..., checkpoint_after_iter: int = ..., checkpoint_minutes: float = ..., checkpoints_kept: int = ..., log_after: int = ..., num_workers: int = ..., seed: int = ..., backbone: str = ..., freeze: bool = ..., width: float = ..., mobilenetv2_width: float = ..., extra_blocks: int = ..., channels: int = ..., separable: bool = ..., num_refinement_stages: int = ..., crop_size: int = ..., augment: bool = ...) -> dict[str, Any]: ...
    def eval(self, dataset: Dataset, silent: Any = ..., verbose: bool = ..., use_subset: Any = ..., subset_size: Any = ..., images_folder_name: Optional[str] = ..., annotations_filename: Any = ..., *, metric: Optional[str] = ..., split: Optional[str] = ..., limit: Optional[int] = ..., out: Optional[PathLike] = ..., skip_broken: bool = ..., classes: Optional[Mapping[str, str]] = ..., by_number: bool = ..., resamples: int = ..., **metric_params: Any) -> dict[str, Any]: ...
    def optimize(self, do_constant_folding: Any = ..., *, target_device: str = ..., out: Optional[PathLike] = ..., precision: str = ..., calibration: Union[None, Dataset] = ..., validation: Union[None, Dataset] = ..., verbose: bool = ..., **options: Any) -> dict[str, Any]: ...

class HighResolutionPoseEstimationLearner(HighResolutionPoses):
    """Looks at large pictures twice: coarsely, then closer where persons may be.

    Task: pose_estimation. ``infer`` takes:

        image: Image.

    and gives: PoseList.

    Args:
        first_pass_height: Height of the network's input for the whole picture. (default 360; 64 to 2048 px; may
            change while running, also for one call of infer)
        second_pass_height: Height of the network's input for a part of it, at most; small parts are magnified
            three times. (default 540; 64 to 2048 px; may change while running, also for one call of infer)
        method: How parts of the picture are chosen. (default 'adaptive'; one of 'adaptive', 'primary'; may change
            while running, also for one call of infer)
        percentage_around_crop: What is added around a part on each side, as a share of its longer side. (default
            0.3; 0 to 2; may change while running, also for one call of infer)
        heatmap_threshold: Where the coarse heat maps are above this, a closer look is worth it. (default 0.1;
            0.01 to 1; may change while running, also for one call of infer)
        detail_threshold: Where brightness differs by more than this within 4 pixels of the coarse picture, a
            closer look is worth it too, 0..=255; 256 switches it off. (default 32.0; 1 to 256; may change while
            running, also for one call of infer)
        max_regions: At most this many parts are looked at in one picture; the others follow in the next frames.
            (default 4; 1 to 64; may change while running, also for one call of infer)
        max_pixels: The parts that are looked at in one picture have at most so many pixels for the network, but
            for the first of them. (default 300000; 1 to 1e+08 px; may change while running, also for one call of
            infer)
        threshold: Persons below this score are dropped. (default 0.1; 0 to 1; may change while running, also for
            one call of infer)
        keypoint_threshold: Joints below this score are missing. (default 0.1; 0.01 to 1; may change while
            running, also for one call of infer)
        upsample_ratio: Steps between the cells of the heat maps in which joints are looked for. (default 4; 1 to
            8; may change while running, also for one call of infer)
        track: Whether persons keep their identity from frame to frame. (default True; may change while running,
            also for one call of infer)
        smooth: Whether joints are smoothed over frames; needs `track`. (default True; may change while running,
            also for one call of infer)
        others: OpenDR's arguments, see ``opendr.engine.learners.BaseLearner``.

    Arguments of OpenDR that are taken and have no effect:
        base_height: no effect: `first_pass_height` and `second_pass_height` say it.
        mobilenet_use_stride: no effect: the maps lie at every 8th pixel.
        shufflenet_groups: no effect: the backbone is MobileNet.
        experiment_name: no effect: it does not train: `lightweight_open_pose` does.
        weights_only: no effect: it does not train: `lightweight_open_pose` does.
        output_name: no effect: `eval` says where answers are written.
        multiscale: no effect: parts are looked at larger than the whole.
        scales: no effect: parts are looked at larger than the whole.
        visualize: no effect: `draw` shows poses.
        img_mean: no effect: the network says what it takes.
        img_scale: no effect: the network says what it takes.
        pad_value: no effect: the network says what it takes.
        half_precision: no effect: the runtime chooses the precision.
    """

    first_pass_height: int
    second_pass_height: int
    method: Literal['adaptive', 'primary']
    percentage_around_crop: float
    heatmap_threshold: float
    detail_threshold: float
    max_regions: int
    max_pixels: int
    keypoint_threshold: float
    upsample_ratio: int
    track: bool
    smooth: bool
    def __init__(self, device: str = ..., backbone: str = ..., temp_path: str = ..., mobilenet_use_stride: Any = ..., mobilenetv2_width: Any = ..., shufflenet_groups: Any = ..., num_refinement_stages: Any = ..., batches_per_iter: Any = ..., base_height: Any = ..., first_pass_height: int = ..., second_pass_height: int = ..., method: Literal['adaptive', 'primary'] = ..., percentage_around_crop: float = ..., heatmap_threshold: float = ..., experiment_name: Any = ..., num_workers: Any = ..., weights_only: Any = ..., output_name: Any = ..., multiscale: Any = ..., scales: Any = ..., visualize: Any = ..., img_mean: Any = ..., img_scale: Any = ..., pad_value: Any = ..., half_precision: Any = ..., *, lr: float = ..., iters: int = ..., batch_size: int = ..., optimizer: str = ..., lr_schedule: str = ..., network_head: str = ..., checkpoint_after_iter: int = ..., checkpoint_load_iter: int = ..., threshold: float = ..., scale: float = ..., detail_threshold: float = ..., max_regions: int = ..., max_pixels: int = ..., keypoint_threshold: float = ..., upsample_ratio: int = ..., track: bool = ..., smooth: bool = ...) -> None: ...
    @overload
    def infer(self, image: Union[Image, NDArray[Any], str, os.PathLike[str]], upsample_ratio: int = ..., stride: Any = ..., track: bool = ..., smooth: bool = ..., multiscale: Any = ..., *, first_pass_height: int = ..., second_pass_height: int = ..., method: Literal['adaptive', 'primary'] = ..., percentage_around_crop: float = ..., heatmap_threshold: float = ..., detail_threshold: float = ..., max_regions: int = ..., max_pixels: int = ..., threshold: float = ..., keypoint_threshold: float = ..., base_height: Any = ..., mobilenet_use_stride: Any = ..., shufflenet_groups: Any = ..., experiment_name: Any = ..., weights_only: Any = ..., output_name: Any = ..., scales: Any = ..., visualize: Any = ..., img_mean: Any = ..., img_scale: Any = ..., pad_value: Any = ..., half_precision: Any = ...) -> PoseList: ...  # type: ignore[overload-overlap]
    @overload
    def infer(self, image: Sequence[Union[Image, NDArray[Any], str, os.PathLike[str]]], upsample_ratio: int = ..., stride: Any = ..., track: bool = ..., smooth: bool = ..., multiscale: Any = ..., *, first_pass_height: int = ..., second_pass_height: int = ..., method: Literal['adaptive', 'primary'] = ..., percentage_around_crop: float = ..., heatmap_threshold: float = ..., detail_threshold: float = ..., max_regions: int = ..., max_pixels: int = ..., threshold: float = ..., keypoint_threshold: float = ..., base_height: Any = ..., mobilenet_use_stride: Any = ..., shufflenet_groups: Any = ..., experiment_name: Any = ..., weights_only: Any = ..., output_name: Any = ..., scales: Any = ..., visualize: Any = ..., img_mean: Any = ..., img_scale: Any = ..., pad_value: Any = ..., half_precision: Any = ...) -> list[PoseList]: ...
    @overload
    def infer(self, image: Iterator[Union[Image, NDArray[Any], str, os.PathLike[str]]], upsample_ratio: int = ..., stride: Any = ..., track: bool = ..., smooth: bool = ..., multiscale: Any = ..., *, first_pass_height: int = ..., second_pass_height: int = ..., method: Literal['adaptive', 'primary'] = ..., percentage_around_crop: float = ..., heatmap_threshold: float = ..., detail_threshold: float = ..., max_regions: int = ..., max_pixels: int = ..., threshold: float = ..., keypoint_threshold: float = ..., base_height: Any = ..., mobilenet_use_stride: Any = ..., shufflenet_groups: Any = ..., experiment_name: Any = ..., weights_only: Any = ..., output_name: Any = ..., scales: Any = ..., visualize: Any = ..., img_mean: Any = ..., img_scale: Any = ..., pad_value: Any = ..., half_precision: Any = ...) -> Iterator[PoseList]: ...
    def fit(self, dataset: Dataset, val_dataset: Optional[Dataset] = ..., logging_path: PathLike = ..., logging_flush_secs: Any = ..., silent: bool = ..., verbose: bool = ..., epochs: Any = ..., use_val_subset: Any = ..., val_subset_size: Any = ..., images_folder_name: Optional[str] = ..., annotations_filename: Any = ..., val_images_folder_name: Optional[str] = ..., val_annotations_filename: Any = ..., *, out: Optional[PathLike] = ..., resume: bool = ..., split: Optional[str] = ..., val_split: Optional[str] = ..., limit: Optional[int] = ..., teacher: Union[None, str, Learner] = ..., teacher_threshold: Optional[float] = ..., teacher_classes: Sequence[str] = ..., teacher_map: Optional[Mapping[str, str]] = ..., teacher_by_number: bool = ..., keep_empty: bool = ..., skip_broken: bool = ...) -> dict[str, Any]: ...
    def eval(self, dataset: Dataset, silent: Any = ..., verbose: bool = ..., use_subset: Any = ..., subset_size: Any = ..., upsample_ratio: Any = ..., images_folder_name: Optional[str] = ..., annotations_filename: Any = ..., *, metric: Optional[str] = ..., split: Optional[str] = ..., limit: Optional[int] = ..., out: Optional[PathLike] = ..., skip_broken: bool = ..., classes: Optional[Mapping[str, str]] = ..., by_number: bool = ..., resamples: int = ..., **metric_params: Any) -> dict[str, Any]: ...
    def optimize(self, do_constant_folding: Any = ..., *, target_device: str = ..., out: Optional[PathLike] = ..., precision: str = ..., calibration: Union[None, Dataset] = ..., validation: Union[None, Dataset] = ..., verbose: bool = ..., **options: Any) -> dict[str, Any]: ...
    @classmethod
    def download(cls, path: Optional[PathLike] = ..., mode: str = ..., verbose: bool = ..., url: Optional[str] = ..., image_resolution: Any = ..., *, variant: Optional[str] = ...) -> str: ...

class BlazePoseLearner(NativeLearner):
    """BlazePose finds 33 points of one person and follows them; hands, feet and face among them.

    Task: pose_estimation. ``infer`` takes:

        image: Image.

    and gives: PoseList.

    Args:
        threshold: A person below this score is dropped, and followed no longer. (default 0.5; 0 to 1; may change
            while running, also for one call of infer)
        keypoint_threshold: Points that are visible with less than this probability are missing. (default 0.1; 0
            to 1; may change while running, also for one call of infer)
        looks: How often a person who is not followed yet is looked at: each look starts from where the one before
            saw the person. (default 2; 1 to 4; may change while running, also for one call of infer)
        track: Whether the person is followed from frame to frame. Switch it off for single pictures. (default
            True; may change while running, also for one call of infer)
        others: OpenDR's arguments, see ``opendr.engine.learners.BaseLearner``.
    """

    keypoint_threshold: float
    looks: int
    track: bool
    def __init__(self, lr: float = ..., iters: int = ..., batch_size: int = ..., optimizer: str = ..., lr_schedule: str = ..., backbone: str = ..., network_head: str = ..., checkpoint_after_iter: int = ..., checkpoint_load_iter: int = ..., temp_path: str = ..., device: str = ..., threshold: float = ..., scale: float = ..., *, keypoint_threshold: float = ..., looks: int = ..., track: bool = ...) -> None: ...
    @overload
    def infer(self, image: Union[Image, NDArray[Any], str, os.PathLike[str]], *, threshold: float = ..., keypoint_threshold: float = ..., looks: int = ..., track: bool = ...) -> PoseList: ...  # type: ignore[overload-overlap]
    @overload
    def infer(self, image: Sequence[Union[Image, NDArray[Any], str, os.PathLike[str]]], *, threshold: float = ..., keypoint_threshold: float = ..., looks: int = ..., track: bool = ...) -> list[PoseList]: ...
    @overload
    def infer(self, image: Iterator[Union[Image, NDArray[Any], str, os.PathLike[str]]], *, threshold: float = ..., keypoint_threshold: float = ..., looks: int = ..., track: bool = ...) -> Iterator[PoseList]: ...

class FilteredPose:
    """Not here yet: infer(img, track=True, smooth=True) of LightweightOpenPoseLearner smooths poses."""

    def __init__(self, *args: Any, **kwargs: Any) -> NoReturn: ...
