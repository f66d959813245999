"""Learners of the task object_tracking_2d. Made by bindings/python/stubs.py; do not edit."""

# Each learner has the arguments of OpenDR's class of its name.
# mypy: disable-error-code="override"
# pyright: reportIncompatibleMethodOverride=false

import os
from collections.abc import Iterator, Mapping, Sequence
from typing import Any, Literal, NamedTuple, NoReturn, Optional, Union, overload

from numpy.typing import ArrayLike, NDArray
from opendr._drawing import draw_bounding_boxes as draw_bounding_boxes
from opendr._upstream.tracking_datasets import Market1501Dataset as Market1501Dataset
from opendr._upstream.tracking_datasets import Market1501DatasetIterator as Market1501DatasetIterator
from opendr._upstream.tracking_datasets import MotDataset as MotDataset
from opendr._upstream.tracking_datasets import MotDatasetIterator as MotDatasetIterator
from opendr._upstream.tracking_datasets import RawMotDatasetIterator as RawMotDatasetIterator
from opendr._upstream.tracking_datasets import RawMotWithDetectionsDatasetIterator as RawMotWithDetectionsDatasetIterator
from opendr._native_learner import NativeLearner, PathLike
from opendr._upstream.learners.tracking import DeepSort, NumberedFrames, SingleObject
from opendr.engine.data import Image
from opendr.engine.datasets import Dataset
from opendr.engine.learners import Learner
from opendr.engine.target import BoundingBoxList, TrackingAnnotationList

class SortLearner(NativeLearner):
    """SORT follows what a detector finds by motion and overlap alone, at next to no cost.

    Task: object_tracking_2d. ``infer`` takes:

        detections: BoundingBoxList. What was found in the frame; the confidences count.
        image: Image (may be left out). The frame, which tells how the camera moved. All frames of a stream, or
            none.

    and gives: TrackingAnnotationList.

    Args:
        threshold: Detections below this score are left out. (default 0.3; 0 to 1; may change while running, also
            for one call of infer)
        iou_threshold: A track and a detection may be one object when they overlap at least this much
            (intersection over union). (default 0.3; 0.01 to 1; may change while running, also for one call of
            infer)
        max_age: Frames for which an object may be out of sight. (default 1; 0 to 1000; may change while running,
            also for one call of infer)
        min_hits: An object is told once it was seen in so many frames in a row; in the first frames of a stream
            at once. (default 3; 1 to 100; may change while running, also for one call of infer)
        per_class: Only boxes of the same class can be one object. (default True; may change while running, also
            for one call of infer)
        others: OpenDR's arguments, see ``opendr.engine.learners.BaseLearner``.
    """

    iou_threshold: float
    max_age: int
    min_hits: int
    per_class: bool
    def __init__(self, lr: float = ..., iters: int = ..., batch_size: int = ..., optimizer: str = ..., lr_schedule: str = ..., backbone: str = ..., network_head: str = ..., checkpoint_after_iter: int = ..., checkpoint_load_iter: int = ..., temp_path: str = ..., device: str = ..., threshold: float = ..., scale: float = ..., *, iou_threshold: float = ..., max_age: int = ..., min_hits: int = ..., per_class: bool = ...) -> None: ...
    def infer(self, detections: BoundingBoxList, image: Optional[Union[Image, NDArray[Any], str, os.PathLike[str]]] = ..., *, threshold: float = ..., iou_threshold: float = ..., max_age: int = ..., min_hits: int = ..., per_class: bool = ...) -> TrackingAnnotationList: ...

class ByteTrackLearner(NativeLearner):
    """ByteTrack follows what a detector finds, through crowds too: detections of low confidence count.

    Task: object_tracking_2d. ``infer`` takes:

        detections: BoundingBoxList. What was found in the frame; the confidences count.
        image: Image (may be left out). The frame, which tells how the camera moved. All frames of a stream, or
            none.

    and gives: TrackingAnnotationList.

    Args:
        threshold: Detections from this score on are paired first. (default 0.6; 0 to 1; may change while running,
            also for one call of infer)
        low_threshold: Detections from this score on only go on with tracks. (default 0.1; 0 to 1; may change
            while running, also for one call of infer)
        new_threshold: A detection begins a track from this score on. (default 0.7; 0 to 1; may change while
            running, also for one call of infer)
        iou_threshold: A track and a detection may be one object when their overlap times the score is at least
            this. (default 0.2; 0.01 to 1; may change while running, also for one call of infer)
        low_iou_threshold: The same for detections of a low score, by overlap alone. (default 0.5; 0.01 to 1; may
            change while running, also for one call of infer)
        track_buffer: Frames for which an object may be out of sight. (default 30; 0 to 1000; may change while
            running, also for one call of infer)
        min_hits: An object is told once it was seen in so many frames in a row; in the first frames of a stream
            at once. (default 2; 1 to 100; may change while running, also for one call of infer)
        per_class: Only boxes of the same class can be one object. (default True; may change while running, also
            for one call of infer)
        others: OpenDR's arguments, see ``opendr.engine.learners.BaseLearner``.
    """

    low_threshold: float
    new_threshold: float
    iou_threshold: float
    low_iou_threshold: float
    track_buffer: int
    min_hits: int
    per_class: bool
    def __init__(self, lr: float = ..., iters: int = ..., batch_size: int = ..., optimizer: str = ..., lr_schedule: str = ..., backbone: str = ..., network_head: str = ..., checkpoint_after_iter: int = ..., checkpoint_load_iter: int = ..., temp_path: str = ..., device: str = ..., threshold: float = ..., scale: float = ..., *, low_threshold: float = ..., new_threshold: float = ..., iou_threshold: float = ..., low_iou_threshold: float = ..., track_buffer: int = ..., min_hits: int = ..., per_class: bool = ...) -> None: ...
    def infer(self, detections: BoundingBoxList, image: Optional[Union[Image, NDArray[Any], str, os.PathLike[str]]] = ..., *, threshold: float = ..., low_threshold: float = ..., new_threshold: float = ..., iou_threshold: float = ..., low_iou_threshold: float = ..., track_buffer: int = ..., min_hits: int = ..., per_class: bool = ...) -> TrackingAnnotationList: ...

class OcSortLearner(NativeLearner):
    """OC-SORT follows what a detector finds, through occlusions and uneven motion.

    Task: object_tracking_2d. ``infer`` takes:

        detections: BoundingBoxList. What was found in the frame; the confidences count.
        image: Image (may be left out). The frame, which tells how the camera moved. All frames of a stream, or
            none.

    and gives: TrackingAnnotationList.

    Args:
        threshold: Detections below this score are left out. (default 0.6; 0 to 1; may change while running, also
            for one call of infer)
        iou_threshold: A track and a detection may be one object when they overlap at least this much
            (intersection over union). (default 0.3; 0.01 to 1; may change while running, also for one call of
            infer)
        max_age: Frames for which an object may be out of sight. (default 30; 0 to 1000; may change while running,
            also for one call of infer)
        min_hits: An object is told once it was seen in so many frames in a row; in the first frames of a stream
            at once. (default 3; 1 to 100; may change while running, also for one call of infer)
        delta_t: Over so many frames directions are measured. (default 3; 1 to 10; may change while running, also
            for one call of infer)
        inertia: How much the direction counts beside the overlap. (default 0.2; 0 to 1; may change while running,
            also for one call of infer)
        per_class: Only boxes of the same class can be one object. (default True; may change while running, also
            for one call of infer)
        others: OpenDR's arguments, see ``opendr.engine.learners.BaseLearner``.
    """

    iou_threshold: float
    max_age: int
    min_hits: int
    delta_t: int
    inertia: float
    per_class: bool
    def __init__(self, lr: float = ..., iters: int = ..., batch_size: int = ..., optimizer: str = ..., lr_schedule: str = ..., backbone: str = ..., network_head: str = ..., checkpoint_after_iter: int = ..., checkpoint_load_iter: int = ..., temp_path: str = ..., device: str = ..., threshold: float = ..., scale: float = ..., *, iou_threshold: float = ..., max_age: int = ..., min_hits: int = ..., delta_t: int = ..., inertia: float = ..., per_class: bool = ...) -> None: ...
    def infer(self, detections: BoundingBoxList, image: Optional[Union[Image, NDArray[Any], str, os.PathLike[str]]] = ..., *, threshold: float = ..., iou_threshold: float = ..., max_age: int = ..., min_hits: int = ..., delta_t: int = ..., inertia: float = ..., per_class: bool = ...) -> TrackingAnnotationList: ...

class ObjectTracking2DDeepSortLearner(DeepSort):
    """DeepSORT follows the persons that a detector finds and knows them again by how they look.

    Task: object_tracking_2d. ``infer`` takes:

        image: Image. The frame.
        detections: BoundingBoxList. What was found in it.

    and gives: TrackingAnnotationList.

    Args:
        max_dist: Two boxes may show one object when their looks differ at most this much (1 less the cosine).
            (default 0.2; 0 to 2; may change while running, also for one call of infer)
        min_confidence: Detections below this score are left out. (default 0.3; 0 to 1; may change while running,
            also for one call of infer; in OpenDR threshold)
        nms_max_overlap: Of boxes that overlap more than this (intersection over union) the best is taken.
            (default 0.5; 0 to 1; may change while running, also for one call of infer)
        max_iou_distance: Without looks, a track and a box may be one object when 1 less their overlap is at most
            this. (default 0.7; 0 to 0.99; may change while running, also for one call of infer)
        max_age: Frames for which an object may be out of sight. (default 70; 0 to 1000; may change while running,
            also for one call of infer)
        n_init: An object is told once it was seen in so many frames in a row; in the first frames of a stream at
            once. (default 3; 1 to 100; may change while running, also for one call of infer)
        nn_budget: Looks that are remembered of each object. (default 100; 1 to 200; may change while running,
            also for one call of infer)
        per_class: Only boxes of the same class can be one object. (default True; may change while running, also
            for one call of infer)
        others: OpenDR's arguments, see ``opendr.engine.learners.BaseLearner``.

    Arguments of OpenDR that are taken and have no effect:
        lr: no effect: it belongs to training, which this learner does not have.
        iters: no effect: it belongs to training, which this learner does not have.
        batch_size: no effect: it belongs to training, which this learner does not have.
        optimizer: no effect: it belongs to training, which this learner does not have.
        checkpoint_after_iter: no effect: it belongs to training, which this learner does not have.
        checkpoint_load_iter: no effect: it belongs to training, which this learner does not have.
    """

    max_dist: float
    min_confidence: float
    nms_max_overlap: float
    max_iou_distance: float
    max_age: int
    n_init: int
    nn_budget: int
    per_class: bool
    def __init__(self, lr: float = ..., iters: int = ..., batch_size: int = ..., optimizer: str = ..., checkpoint_after_iter: int = ..., checkpoint_load_iter: int = ..., temp_path: str = ..., device: str = ..., max_dist: float = ..., min_confidence: float = ..., nms_max_overlap: float = ..., max_iou_distance: float = ..., max_age: int = ..., n_init: int = ..., nn_budget: int = ..., *, lr_schedule: str = ..., backbone: str = ..., network_head: str = ..., threshold: float = ..., scale: float = ..., per_class: bool = ...) -> None: ...
    def fit(self, dataset: Dataset, epochs: Any = ..., val_dataset: Optional[Dataset] = ..., val_epochs: Any = ..., logging_path: PathLike = ..., silent: bool = ..., verbose: bool = ..., train_transforms: Any = ..., val_transforms: Any = ..., *, out: Optional[PathLike] = ..., resume: bool = ..., split: Optional[str] = ..., val_split: Optional[str] = ..., limit: Optional[int] = ..., teacher: Union[None, str, Learner] = ..., teacher_threshold: Optional[float] = ..., teacher_classes: Sequence[str] = ..., teacher_map: Optional[Mapping[str, str]] = ..., teacher_by_number: bool = ..., keep_empty: bool = ..., skip_broken: bool = ...) -> dict[str, Any]: ...
    def eval(self, dataset: Any, logging_path: Any = ..., silent: Any = ..., verbose: Any = ..., **options: Any) -> dict[str, Any]: ...
    def optimize(self, do_constant_folding: Any = ..., img_size: Any = ..., *, target_device: str = ..., out: Optional[PathLike] = ..., precision: str = ..., calibration: Union[None, Dataset] = ..., validation: Union[None, Dataset] = ..., verbose: bool = ..., **options: Any) -> dict[str, Any]: ...
    @classmethod
    def download(cls, model_name: Any = ..., path: Optional[PathLike] = ..., server_url: Optional[str] = ..., *, mode: str = ..., verbose: bool = ..., url: Optional[str] = ..., variant: Optional[str] = ...) -> str: ...

class ObjectTracking2DFairMotLearner(NumberedFrames):
    """NanoDet and ByteTrack in one call follow the persons in a video.

    Task: object_tracking_2d. ``infer`` takes:

        image: Image.

    and gives: TrackingAnnotationList.

    Args:
        threshold: Detections from this score on are paired first; 0.1 more begins a track. (default 0.3; 0.1 to
            1; may change while running, also for one call of infer)
        track_buffer: Frames for which an object may be out of sight. (default 30; 0 to 1000; may change while
            running, also for one call of infer)
        min_box_area: Smaller boxes are left out. (default 100.0; 0 to 1e+06 px^2; may change while running, also
            for one call of infer)
        every_class: Whether all classes of the detector are followed, or persons alone. (default False; may
            change while running, also for one call of infer)
        camera_motion: Whether frames tell how the camera moved; a camera that stands still needs it not. (default
            True; may change while running, also for one call of infer)
        others: OpenDR's arguments, see ``opendr.engine.learners.BaseLearner``.

    Arguments of OpenDR that are taken and have no effect:
        backbone: no effect: the detector is NanoDet.
        network_head: no effect: the detector is NanoDet.
        scale: no effect: the detector scales frames itself.
        num_classes: no effect: `every_class` says whether more than persons are followed.
        max_objs: no effect: the detector finds at most a hundred.
        frame_rate: no effect: `track_buffer` counts frames.
        image_mean: no effect: the detector knows it.
        image_std: no effect: the detector knows it.
        lr: no effect: it belongs to training, which this learner does not have.
        iters: no effect: it belongs to training, which this learner does not have.
        batch_size: no effect: it belongs to training, which this learner does not have.
        optimizer: no effect: it belongs to training, which this learner does not have.
        lr_schedule: no effect: it belongs to training, which this learner does not have.
        lr_step: no effect: it belongs to training, which this learner does not have.
        num_epochs: no effect: it belongs to training, which this learner does not have.
        checkpoint_after_iter: no effect: it belongs to training, which this learner does not have.
        checkpoint_load_iter: no effect: it belongs to training, which this learner does not have.
        num_workers: no effect: it belongs to training, which this learner does not have.
        gpus: no effect: it belongs to training, which this learner does not have.
        mse_loss: no effect: it belongs to training, which this learner does not have.
        reg_loss: no effect: it belongs to training, which this learner does not have.
        hm_weight: no effect: it belongs to training, which this learner does not have.
        wh_weight: no effect: it belongs to training, which this learner does not have.
        off_weight: no effect: it belongs to training, which this learner does not have.
        id_weight: no effect: it belongs to training, which this learner does not have.
        head_conv: no effect: the detector is NanoDet.
        ltrb: no effect: the detector is NanoDet.
        reg_offset: no effect: the detector is NanoDet.
        dense_wh: no effect: the detector is NanoDet.
        cat_spec_wh: no effect: the detector is NanoDet.
        norm_wh: no effect: the detector is NanoDet.
        reid_dim: no effect: the detector is NanoDet.
        down_ratio: no effect: the detector is NanoDet.
        use_pretrained_backbone: no effect: it belongs to training, which this learner does not have.
    """

    track_buffer: int
    min_box_area: float
    every_class: bool
    camera_motion: bool
    def __init__(self, lr: float = ..., iters: int = ..., batch_size: int = ..., optimizer: str = ..., lr_schedule: str = ..., backbone: str = ..., network_head: str = ..., checkpoint_after_iter: int = ..., checkpoint_load_iter: int = ..., temp_path: str = ..., device: str = ..., threshold: float = ..., scale: float = ..., lr_step: Any = ..., head_conv: Any = ..., ltrb: Any = ..., num_classes: Any = ..., reg_offset: Any = ..., gpus: Any = ..., num_workers: Any = ..., mse_loss: Any = ..., reg_loss: Any = ..., dense_wh: Any = ..., cat_spec_wh: Any = ..., reid_dim: Any = ..., norm_wh: Any = ..., wh_weight: Any = ..., off_weight: Any = ..., id_weight: Any = ..., num_epochs: Any = ..., hm_weight: Any = ..., down_ratio: Any = ..., max_objs: Any = ..., track_buffer: int = ..., image_mean: Any = ..., image_std: Any = ..., frame_rate: Any = ..., min_box_area: float = ..., use_pretrained_backbone: Any = ..., *, every_class: bool = ..., camera_motion: bool = ...) -> None: ...
    @overload
    def infer(self, image: Union[Image, NDArray[Any], str, os.PathLike[str]], frame_ids: Any = ..., img_size: Any = ..., *, threshold: float = ..., track_buffer: int = ..., min_box_area: float = ..., every_class: bool = ..., camera_motion: bool = ..., backbone: Any = ..., network_head: Any = ..., scale: Any = ..., num_classes: Any = ..., max_objs: Any = ..., frame_rate: Any = ..., image_mean: Any = ..., image_std: Any = ..., lr: Any = ..., iters: Any = ..., batch_size: Any = ..., optimizer: Any = ..., lr_schedule: Any = ..., lr_step: Any = ..., num_epochs: Any = ..., checkpoint_after_iter: Any = ..., checkpoint_load_iter: Any = ..., num_workers: Any = ..., gpus: Any = ..., mse_loss: Any = ..., reg_loss: Any = ..., hm_weight: Any = ..., wh_weight: Any = ..., off_weight: Any = ..., id_weight: Any = ..., head_conv: Any = ..., ltrb: Any = ..., reg_offset: Any = ..., dense_wh: Any = ..., cat_spec_wh: Any = ..., norm_wh: Any = ..., reid_dim: Any = ..., down_ratio: Any = ..., use_pretrained_backbone: Any = ...) -> TrackingAnnotationList: ...  # type: ignore[overload-overlap]
    @overload
    def infer(self, image: Sequence[Union[Image, NDArray[Any], str, os.PathLike[str]]], frame_ids: Any = ..., img_size: Any = ..., *, threshold: float = ..., track_buffer: int = ..., min_box_area: float = ..., every_class: bool = ..., camera_motion: bool = ..., backbone: Any = ..., network_head: Any = ..., scale: Any = ..., num_classes: Any = ..., max_objs: Any = ..., frame_rate: Any = ..., image_mean: Any = ..., image_std: Any = ..., lr: Any = ..., iters: Any = ..., batch_size: Any = ..., optimizer: Any = ..., lr_schedule: Any = ..., lr_step: Any = ..., num_epochs: Any = ..., checkpoint_after_iter: Any = ..., checkpoint_load_iter: Any = ..., num_workers: Any = ..., gpus: Any = ..., mse_loss: Any = ..., reg_loss: Any = ..., hm_weight: Any = ..., wh_weight: Any = ..., off_weight: Any = ..., id_weight: Any = ..., head_conv: Any = ..., ltrb: Any = ..., reg_offset: Any = ..., dense_wh: Any = ..., cat_spec_wh: Any = ..., norm_wh: Any = ..., reid_dim: Any = ..., down_ratio: Any = ..., use_pretrained_backbone: Any = ...) -> list[TrackingAnnotationList]: ...
    @overload
    def infer(self, image: Iterator[Union[Image, NDArray[Any], str, os.PathLike[str]]], frame_ids: Any = ..., img_size: Any = ..., *, threshold: float = ..., track_buffer: int = ..., min_box_area: float = ..., every_class: bool = ..., camera_motion: bool = ..., backbone: Any = ..., network_head: Any = ..., scale: Any = ..., num_classes: Any = ..., max_objs: Any = ..., frame_rate: Any = ..., image_mean: Any = ..., image_std: Any = ..., lr: Any = ..., iters: Any = ..., batch_size: Any = ..., optimizer: Any = ..., lr_schedule: Any = ..., lr_step: Any = ..., num_epochs: Any = ..., checkpoint_after_iter: Any = ..., checkpoint_load_iter: Any = ..., num_workers: Any = ..., gpus: Any = ..., mse_loss: Any = ..., reg_loss: Any = ..., hm_weight: Any = ..., wh_weight: Any = ..., off_weight: Any = ..., id_weight: Any = ..., head_conv: Any = ..., ltrb: Any = ..., reg_offset: Any = ..., dense_wh: Any = ..., cat_spec_wh: Any = ..., norm_wh: Any = ..., reid_dim: Any = ..., down_ratio: Any = ..., use_pretrained_backbone: Any = ...) -> Iterator[TrackingAnnotationList]: ...
    def fit(self, dataset: Dataset, val_dataset: Optional[Dataset] = ..., val_epochs: Any = ..., logging_path: PathLike = ..., silent: bool = ..., verbose: bool = ..., train_split_paths: Any = ..., val_split_paths: Any = ..., resume_optimizer: Any = ..., nID: Any = ..., *, out: Optional[PathLike] = ..., resume: bool = ..., split: Optional[str] = ..., val_split: Optional[str] = ..., limit: Optional[int] = ..., teacher: Union[None, str, Learner] = ..., teacher_threshold: Optional[float] = ..., teacher_classes: Sequence[str] = ..., teacher_map: Optional[Mapping[str, str]] = ..., teacher_by_number: bool = ..., keep_empty: bool = ..., skip_broken: bool = ...) -> dict[str, Any]: ...
    def eval(self, dataset: Dataset, val_split_paths: Any = ..., logging_path: Any = ..., silent: Any = ..., verbose: bool = ..., *, metric: Optional[str] = ..., split: Optional[str] = ..., limit: Optional[int] = ..., out: Optional[PathLike] = ..., skip_broken: bool = ..., classes: Optional[Mapping[str, str]] = ..., by_number: bool = ..., resamples: int = ..., **metric_params: Any) -> dict[str, Any]: ...
    def optimize(self, do_constant_folding: Any = ..., img_size: Any = ..., optimizable_dcn_v2: Any = ..., *, target_device: str = ..., out: Optional[PathLike] = ..., precision: str = ..., calibration: Union[None, Dataset] = ..., validation: Union[None, Dataset] = ..., verbose: bool = ..., **options: Any) -> dict[str, Any]: ...
    @classmethod
    def download(cls, model_name: Any = ..., path: Optional[PathLike] = ..., server_url: Optional[str] = ..., *, mode: str = ..., verbose: bool = ..., url: Optional[str] = ..., variant: Optional[str] = ...) -> str: ...

class SiamRPNLearner(SingleObject):
    """NanoTrack follows one object of any kind from a box in the first frame.

    Task: object_tracking_2d. ``infer`` takes:

        image: Image. The frame.
        init_box: BoundingBoxList (with the first input of a stream). What is to be followed from this frame on:
            its first box.

    and gives: TrackingAnnotationList.

    Args:
        window_influence: How much a place far from where the object was is marked down. (default 0.455; 0 to 1;
            may change while running, also for one call of infer)
        penalty: How much another size or shape than before is marked down. (default 0.138; 0 to 1; may change
            while running, also for one call of infer)
        size_rate: How fast the size of the box follows what is seen. (default 0.348; 0 to 1; may change while
            running, also for one call of infer)
        others: OpenDR's arguments, see ``opendr.engine.learners.BaseLearner``.

    Arguments of OpenDR that are taken and have no effect:
        n_epochs: no effect: it belongs to training, which this learner does not have.
        num_workers: no effect: it belongs to training, which this learner does not have.
        warmup_epochs: no effect: it belongs to training, which this learner does not have.
        lr: no effect: it belongs to training, which this learner does not have.
        weight_decay: no effect: it belongs to training, which this learner does not have.
        momentum: no effect: it belongs to training, which this learner does not have.
        cls_weight: no effect: it belongs to training, which this learner does not have.
        loc_weight: no effect: it belongs to training, which this learner does not have.
        batch_size: no effect: it belongs to training, which this learner does not have.
    """

    window_influence: float
    penalty: float
    size_rate: float
    def __init__(self, device: str = ..., n_epochs: Any = ..., num_workers: Any = ..., warmup_epochs: Any = ..., lr: float = ..., weight_decay: Any = ..., momentum: Any = ..., cls_weight: Any = ..., loc_weight: Any = ..., batch_size: int = ..., temp_path: str = ..., *, iters: int = ..., optimizer: str = ..., lr_schedule: str = ..., backbone: str = ..., network_head: str = ..., checkpoint_after_iter: int = ..., checkpoint_load_iter: int = ..., threshold: float = ..., scale: float = ..., window_influence: float = ..., penalty: float = ..., size_rate: float = ...) -> None: ...
    def fit(self, dataset: Dataset, log_interval: Any = ..., n_gpus: Any = ..., val_dataset: Optional[Dataset] = ..., logging_path: PathLike = ..., silent: bool = ..., verbose: bool = ..., *, out: Optional[PathLike] = ..., resume: bool = ..., split: Optional[str] = ..., val_split: Optional[str] = ..., limit: Optional[int] = ..., teacher: Union[None, str, Learner] = ..., teacher_threshold: Optional[float] = ..., teacher_classes: Sequence[str] = ..., teacher_map: Optional[Mapping[str, str]] = ..., teacher_by_number: bool = ..., keep_empty: bool = ..., skip_broken: bool = ...) -> dict[str, Any]: ...
    @classmethod
    def download(cls, path: Optional[PathLike] = ..., mode: str = ..., verbose: bool = ..., url: Optional[str] = ..., overwrite: Any = ..., *, variant: Optional[str] = ...) -> str: ...

class OTBTrainDataset:
    """Not here yet: SiamRPNLearner follows any object without training."""

    def __init__(self, *args: Any, **kwargs: Any) -> NoReturn: ...
