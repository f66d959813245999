"""Learners of the task multimodal_human_centric. Made by bindings/python/stubs.py; do not edit."""

# Each learner has the arguments of OpenDR's class of its name.
# mypy: disable-error-code="override"
# pyright: reportIncompatibleMethodOverride=false

import os
from collections.abc import Iterator, Mapping, Sequence
from typing import Any, Literal, NamedTuple, NoReturn, Optional, Union, overload

from numpy.typing import ArrayLike, NDArray
from opendr._native_learner import NativeLearner, PathLike
from opendr._upstream.learners.sounds import AudiovisualEmotion
from opendr.engine.data import Audio, Image, Timeseries, Video
from opendr.engine.datasets import Dataset
from opendr.engine.learners import Learner
from opendr.engine.target import Category

class AudiovisualEmotionLearner(AudiovisualEmotion):
    """Tells an emotion by the voice and the face; it trains.

    Task: multimodal_human_centric. ``infer`` takes:

        audio: Audio. The voice, at the learner's sample rate.
        video: Video (may be left out). The face, cut out, `[3, frames, height, width]`.

    and gives: Category.

    Args:
        num_class: Classes. None: as many as the data name. (default None; 2 to 10000)
        seq_length: Frames of the faces, evenly spaced over the video. (default 15; 2 to 256)
        fusion: How the branches learn of each other. (default 'ia'; one of 'ia', 'it', 'lt')
        sample_rate: Samples of the sound a second. (default 22050; 8000 to 48000 Hz)
        seconds: Sound that is looked at, from its begin; what is shorter is filled up. (default 3.6; 0.2 to 60 s)
        others: OpenDR's arguments, see ``opendr.engine.learners.BaseLearner``.

    Parameters of ``fit``, for one call or, given here, for all of them:
        epochs: How often the data set is gone through. (default 100; 1 to 1e+06; in OpenDR iters)
        max_steps: Optimiser steps after which training ends, whatever the number of epochs; 0 for no limit.
            (default 0; 0 to 1e+09)
        batch_size: Samples a batch. (default 8; 1 to 65536)
        accumulate: Batches whose gradients are added up for one step of the optimiser. (default 1; 1 to 4096; in
            OpenDR batches_per_iter)
        lr: Learning rate at its highest. (default 0.04; 0 to 100)
        optimizer: What turns gradients into steps. (default 'sgd'; one of 'adamw', 'adam', 'sgd', 'rmsprop'; in
            OpenDR optimizer_name)
        momentum: Momentum of `sgd` and `rmsprop`. (default 0.9; 0 to 1)
        weight_decay: Weight decay: decoupled from the gradient in `adamw`, added to it in the others. (default
            0.001; 0 to 10)
        lr_schedule: How the learning rate goes on after the warm-up. (default 'step'; one of 'constant', 'step',
            'cosine', 'linear')
        warmup_steps: Steps over which the learning rate rises from `warmup_ratio` of itself. (default 0; 0 to
            1e+08)
        warmup_ratio: What share of the learning rate the warm-up begins with. (default 0.1; 0 to 1)
        lr_min: Learning rate at the end of `cosine` and `linear`. (default 0.0; 0 to 100; in OpenDR
            lr_schedule_eta_min)
        lr_steps: Epochs at which `step` lowers the learning rate. (default [40, 55, 65, 70, 200, 250]; in OpenDR
            drop_after_epoch)
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
        mod_drop: What training does so that one sense alone is enough. (default 'zerodrop'; one of 'zerodrop',
            'nodrop')
        side: Side of the network's faces; frames are stretched to it. (default 64; 16 to 512 px)
        width: Channels of the first block for faces; the others have up to twice as many. (default 32; 4 to 1024)
        dropout: Share of the features that are left out at random. (default 0.2; 0 to 0.9)

    Arguments of OpenDR that are taken and have no effect:
        pretr_ef: no effect: frames are looked at by a network that is trained along.
        dampening: no effect: it belongs to training, which this learner does not have.
        n_workers: no effect: it belongs to training, which this learner does not have.
    """

    num_class: Optional[int]
    seq_length: int
    fusion: Literal['ia', 'it', 'lt']
    sample_rate: int
    seconds: float
    def __init__(self, num_class: Optional[int] = ..., seq_length: int = ..., fusion: Literal['ia', 'it', 'lt'] = ..., mod_drop: Literal['zerodrop', 'nodrop'] = ..., pretr_ef: Any = ..., lr: float = ..., lr_steps: list[Any] = ..., momentum: float = ..., dampening: Any = ..., weight_decay: float = ..., iters: int = ..., batch_size: int = ..., n_workers: Any = ..., device: str = ..., *, optimizer: Literal['adamw', 'adam', 'sgd', 'rmsprop'] = ..., lr_schedule: Literal['constant', 'step', 'cosine', 'linear'] = ..., backbone: str = ..., network_head: str = ..., checkpoint_after_iter: int = ..., checkpoint_load_iter: int = ..., temp_path: str = ..., threshold: float = ..., scale: float = ..., epochs: int = ..., max_steps: int = ..., accumulate: int = ..., batches_per_iter: int = ..., optimizer_name: Literal['adamw', 'adam', 'sgd', 'rmsprop'] = ..., warmup_steps: int = ..., warmup_ratio: float = ..., lr_min: float = ..., lr_schedule_eta_min: float = ..., drop_after_epoch: list[Any] = ..., lr_gamma: float = ..., lr_decay: float = ..., grad_clip: float = ..., ema: float = ..., early_stop: int = ..., val_after: int = ..., checkpoint_minutes: float = ..., checkpoints_kept: int = ..., log_after: int = ..., num_workers: int = ..., seed: int = ..., side: int = ..., width: int = ..., dropout: float = ..., sample_rate: int = ..., seconds: float = ...) -> None: ...
    def infer(self, audio: Union[Audio, Timeseries], video: Optional[Union[Video, ArrayLike]] = ..., *, pretr_ef: Any = ..., dampening: Any = ..., n_workers: Any = ...) -> Category: ...
    def fit(self, dataset: Dataset, val_dataset: Optional[Dataset] = ..., logging_path: PathLike = ..., silent: bool = ..., verbose: bool = ..., eval_mode: Any = ..., restore_best: Any = ..., *, out: Optional[PathLike] = ..., resume: bool = ..., split: Optional[str] = ..., val_split: Optional[str] = ..., limit: Optional[int] = ..., teacher: Union[None, str, Learner] = ..., teacher_threshold: Optional[float] = ..., teacher_classes: Sequence[str] = ..., teacher_map: Optional[Mapping[str, str]] = ..., teacher_by_number: bool = ..., keep_empty: bool = ..., skip_broken: bool = ..., epochs: int = ..., iters: int = ..., max_steps: int = ..., batch_size: int = ..., accumulate: int = ..., batches_per_iter: int = ..., lr: float = ..., optimizer: Literal['adamw', 'adam', 'sgd', 'rmsprop'] = ..., optimizer_name: Literal['adamw', 'adam', 'sgd', 'rmsprop'] = ..., momentum: float = ..., weight_decay: float = ..., lr_schedule: Literal['constant', 'step', 'cosine', 'linear'] = ..., warmup_steps: int = ..., warmup_ratio: float = ..., lr_min: float = ..., lr_schedule_eta_min: float = ..., lr_steps: list[Any] = ..., drop_after_epoch: list[Any] = ..., lr_gamma: float = ..., lr_decay: float = ..., grad_clip: float = ..., ema: float = ..., early_stop: int = ..., val_after: int = ..., checkpoint_after_iter: int = ..., checkpoint_minutes: float = ..., checkpoints_kept: int = ..., log_after: int = ..., num_workers: int = ..., seed: int = ..., mod_drop: Literal['zerodrop', 'nodrop'] = ..., side: int = ..., width: int = ..., dropout: float = ...) -> dict[str, Any]: ...
    def eval(self, dataset: Dataset, silent: Any = ..., verbose: bool = ..., mode: Any = ..., *, metric: Optional[str] = ..., split: Optional[str] = ..., limit: Optional[int] = ..., out: Optional[PathLike] = ..., skip_broken: bool = ..., classes: Optional[Mapping[str, str]] = ..., by_number: bool = ..., resamples: int = ..., **metric_params: Any) -> dict[str, Any]: ...

class RgbdHandGestureLearner(NativeLearner):
    """Tells a hand's gesture by its colour and its distance; it trains.

    Task: multimodal_human_centric. ``infer`` takes:

        image: Image. The picture.
        depth: Image. Distances of the same view, one channel: floats in metres, 16 bits in millimetres, 8 bits in
            centimetres. What is not above 0 is not known.

    and gives: Category.

    Args:
        n_class: Classes. None: as many as the data name. (default None; 2 to 10000)
        architecture: The network. (default 'small'; one of 'small')
        others: OpenDR's arguments, see ``opendr.engine.learners.BaseLearner``.

    Parameters of ``fit``, for one call or, given here, for all of them:
        epochs: How often the data set is gone through. (default 200; 1 to 1e+06; in OpenDR iters)
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
        side: Side of the network's input; pictures are stretched to it. (default 64; 8 to 1024 px)
        width: Channels of the first block; the others have up to twice as many. (default 32; 4 to 1024)
        dropout: Share of the features that are left out at random. (default 0.1; 0 to 0.9)
        drop_depth: Whether each batch is also learnt without its depth, so that pictures without it are told by
            their colours. (default True)

    Arguments of OpenDR that are taken and have no effect:
        pretrained: no effect: there are no weights of others for its network.
        n_workers: no effect: it belongs to training, which this learner does not have.
        test_mode: no effect: it made OpenDR's own tests short.
    """

    n_class: Optional[int]
    architecture: Literal['small']
    def __init__(self, n_class: Optional[int] = ..., architecture: Literal['small'] = ..., pretrained: Any = ..., lr_scheduler: Any = ..., optimizer: Literal['adamw', 'adam', 'sgd', 'rmsprop'] = ..., weight_decay: float = ..., iters: int = ..., batch_size: int = ..., n_workers: Any = ..., checkpoint_after_iter: int = ..., checkpoint_load_iter: int = ..., temp_path: str = ..., device: str = ..., test_mode: Any = ..., *, lr: float = ..., lr_schedule: Literal['constant', 'step', 'cosine', 'linear'] = ..., backbone: str = ..., network_head: str = ..., threshold: float = ..., scale: float = ..., epochs: int = ..., max_steps: int = ..., accumulate: int = ..., batches_per_iter: int = ..., optimizer_name: Literal['adamw', 'adam', 'sgd', 'rmsprop'] = ..., momentum: float = ..., warmup_steps: int = ..., warmup_ratio: float = ..., lr_min: float = ..., lr_schedule_eta_min: float = ..., lr_steps: list[Any] = ..., drop_after_epoch: list[Any] = ..., lr_gamma: float = ..., lr_decay: float = ..., grad_clip: float = ..., ema: float = ..., early_stop: int = ..., val_after: int = ..., checkpoint_minutes: float = ..., checkpoints_kept: int = ..., log_after: int = ..., num_workers: int = ..., seed: int = ..., side: int = ..., width: int = ..., dropout: float = ..., drop_depth: bool = ...) -> None: ...
    def infer(self, image: Union[Image, NDArray[Any], str, os.PathLike[str]], depth: Union[Image, NDArray[Any], str, os.PathLike[str]], *, pretrained: Any = ..., n_workers: Any = ..., test_mode: Any = ...) -> Category: ...
    def fit(self, train_set: Dataset = ..., val_set: Optional[Dataset] = ..., test_set: Any = ..., logging_path: PathLike = ..., silent: bool = ..., verbose: bool = ..., *, dataset: Dataset = ..., val_dataset: Optional[Dataset] = ..., out: Optional[PathLike] = ..., resume: bool = ..., split: Optional[str] = ..., val_split: Optional[str] = ..., limit: Optional[int] = ..., teacher: Union[None, str, Learner] = ..., teacher_threshold: Optional[float] = ..., teacher_classes: Sequence[str] = ..., teacher_map: Optional[Mapping[str, str]] = ..., teacher_by_number: bool = ..., keep_empty: bool = ..., skip_broken: bool = ..., epochs: int = ..., iters: int = ..., max_steps: int = ..., batch_size: int = ..., accumulate: int = ..., batches_per_iter: int = ..., lr: float = ..., optimizer: Literal['adamw', 'adam', 'sgd', 'rmsprop'] = ..., optimizer_name: Literal['adamw', 'adam', 'sgd', 'rmsprop'] = ..., momentum: float = ..., weight_decay: float = ..., lr_schedule: Literal['constant', 'step', 'cosine', 'linear'] = ..., warmup_steps: int = ..., warmup_ratio: float = ..., lr_min: float = ..., lr_schedule_eta_min: float = ..., lr_steps: list[Any] = ..., drop_after_epoch: list[Any] = ..., lr_gamma: float = ..., lr_decay: float = ..., grad_clip: float = ..., ema: float = ..., early_stop: int = ..., val_after: int = ..., checkpoint_after_iter: int = ..., checkpoint_minutes: float = ..., checkpoints_kept: int = ..., log_after: int = ..., num_workers: int = ..., seed: int = ..., side: int = ..., width: int = ..., dropout: float = ..., drop_depth: bool = ...) -> dict[str, Any]: ...
    def eval(self, dataset: Dataset, silent: Any = ..., verbose: bool = ..., *, metric: Optional[str] = ..., split: Optional[str] = ..., limit: Optional[int] = ..., out: Optional[PathLike] = ..., skip_broken: bool = ..., classes: Optional[Mapping[str, str]] = ..., by_number: bool = ..., resamples: int = ..., **metric_params: Any) -> dict[str, Any]: ...

class IntentRecognitionLearner:
    """Not here yet: AudiovisualEmotionLearner takes sound and video, WhisperLearner gives the words."""

    def __init__(self, *args: Any, **kwargs: Any) -> NoReturn: ...

class MIntRecDataset:
    """Not here yet: there is no learner of intents yet; AudiovisualEmotionLearner takes sound and video."""

    def __init__(self, *args: Any, **kwargs: Any) -> NoReturn: ...

class RavdessDataset:
    """Not here yet: give fit a DatasetIterator of pairs ((Audio, Video), Category)."""

    def __init__(self, *args: Any, **kwargs: Any) -> NoReturn: ...

class RgbdDataset:
    """Not here yet: use ExternalDataset(path, "hands"), which reads HANDS."""

    def __init__(self, *args: Any, **kwargs: Any) -> NoReturn: ...

def get_audiovisual_emotion_dataset(*args: Any, **kwargs: Any) -> NoReturn: ...

def get_hand_gesture_dataset(*args: Any, **kwargs: Any) -> NoReturn: ...
