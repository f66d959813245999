"""Learners of the task speech_recognition. Made by bindings/python/stubs.py; do not edit."""

# Each learner has the arguments of OpenDR's class of its name.
# mypy: disable-error-code="override"
# pyright: reportIncompatibleMethodOverride=false

import os
from collections.abc import Iterator, Mapping, Sequence
from typing import Any, Literal, NamedTuple, NoReturn, Optional, Union, overload

from numpy.typing import ArrayLike, NDArray
from opendr._native_learner import NativeLearner, PathLike
from opendr._upstream.learners.sounds import Words
from opendr.engine.data import Audio, Timeseries
from opendr.engine.datasets import Dataset
from opendr.engine.learners import Learner
from opendr.engine.target import Category

class EdgeSpeechNetsLearner(NativeLearner):
    """EdgeSpeechNets tell which of a few words was spoken; in four sizes.

    Task: speech_recognition. ``infer`` takes:

        audio: Audio. What was heard; a Timeseries of one feature is taken to be at the learner's sample rate.

    and gives: Category.

    Args:
        architecture: Which network is trained; a loaded model has its own. (default 'A'; one of 'A', 'B', 'C',
            'D')
        output_classes_n: Classes. None: as many as the data name (in OpenDR 20, whatever the data). (default
            None; 2 to 10000)
        preprocess_to_mfcc: Whether cepstra are made of the input; unset, it is a Timeseries of cepstra already,
            as many a frame as the network takes. (default True)
        sample_rate: Samples a second of the sound. (default 16000; 4000 to 384000 Hz)
        voice_activity: A container of `silero_vad`: seconds of a stream in which nobody speaks are then not
            answered, which is the wake-word mode. None: every second is answered. (default None)
        others: OpenDR's arguments, see ``opendr.engine.learners.BaseLearner``.

    Parameters of ``fit``, for one call or, given here, for all of them:
        epochs: How often the data set is gone through. (default 30; 1 to 1e+06; in OpenDR iters)
        max_steps: Optimiser steps after which training ends, whatever the number of epochs; 0 for no limit.
            (default 0; 0 to 1e+09)
        batch_size: Samples a batch. (default 64; 1 to 65536)
        accumulate: Batches whose gradients are added up for one step of the optimiser. (default 1; 1 to 4096; in
            OpenDR batches_per_iter)
        lr: Learning rate at its highest. (default 0.01; 0 to 100)
        optimizer: What turns gradients into steps. (default 'sgd'; one of 'adamw', 'adam', 'sgd', 'rmsprop'; in
            OpenDR optimizer_name)
        momentum: Momentum of `sgd` and `rmsprop`. (default 0.9; 0 to 1)
        weight_decay: Weight decay: decoupled from the gradient in `adamw`, added to it in the others. (default
            0.0; 0 to 10)
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
        num_workers: Threads that read and augment samples. (default 2; 0 to 1024)
        seed: What first weights, order, augmentation and dropout follow from. (default 0)
        dropout: Share of values between layers that are left out at random in each training step. (default 0.2; 0
            to 0.99)
        augment: Whether training sound is shifted, made louder or softer and mixed with noise, and its cepstra
            covered in part, all at random. (default True)
    """

    architecture: Literal['A', 'B', 'C', 'D']
    output_classes_n: Optional[int]
    preprocess_to_mfcc: bool
    sample_rate: int
    voice_activity: Optional[str]
    def __init__(self, lr: float = ..., iters: int = ..., batch_size: int = ..., optimizer: Literal['adamw', 'adam', 'sgd', 'rmsprop'] = ..., checkpoint_after_iter: int = ..., checkpoint_load_iter: int = ..., temp_path: str = ..., device: str = ..., architecture: Literal['A', 'B', 'C', 'D'] = ..., output_classes_n: Optional[int] = ..., momentum: float = ..., preprocess_to_mfcc: bool = ..., sample_rate: int = ..., *, lr_schedule: Literal['constant', 'step', 'cosine', 'linear'] = ..., backbone: str = ..., network_head: str = ..., threshold: float = ..., scale: float = ..., epochs: int = ..., max_steps: int = ..., accumulate: int = ..., batches_per_iter: int = ..., optimizer_name: Literal['adamw', 'adam', 'sgd', 'rmsprop'] = ..., weight_decay: float = ..., warmup_steps: int = ..., warmup_ratio: float = ..., lr_min: float = ..., lr_schedule_eta_min: float = ..., lr_steps: list[Any] = ..., drop_after_epoch: list[Any] = ..., lr_gamma: float = ..., lr_decay: float = ..., grad_clip: float = ..., ema: float = ..., early_stop: int = ..., val_after: int = ..., checkpoint_minutes: float = ..., checkpoints_kept: int = ..., log_after: int = ..., num_workers: int = ..., seed: int = ..., dropout: float = ..., augment: bool = ..., voice_activity: Optional[str] = ...) -> None: ...
    @overload
    def infer(self, audio: Union[Audio, Timeseries]) -> Category: ...
    @overload
    def infer(self, audio: Sequence[Union[Audio, Timeseries]]) -> list[Category]: ...
    @overload
    def infer(self, audio: Iterator[Union[Audio, Timeseries]]) -> Iterator[Category]: ...
    def fit(self, dataset: Dataset, val_dataset: Optional[Dataset] = ..., logging_path: PathLike = ..., silent: bool = ..., verbose: bool = ..., *, out: Optional[PathLike] = ..., resume: bool = ..., split: Optional[str] = ..., val_split: Optional[str] = ..., limit: Optional[int] = ..., teacher: Union[None, str, Learner] = ..., teacher_threshold: Optional[float] = ..., teacher_classes: Sequence[str] = ..., teacher_map: Optional[Mapping[str, str]] = ..., teacher_by_number: bool = ..., keep_empty: bool = ..., skip_broken: bool = ..., epochs: int = ..., iters: int = ..., max_steps: int = ..., batch_size: int = ..., accumulate: int = ..., batches_per_iter: int = ..., lr: float = ..., optimizer: Literal['adamw', 'adam', 'sgd', 'rmsprop'] = ..., optimizer_name: Literal['adamw', 'adam', 'sgd', 'rmsprop'] = ..., momentum: float = ..., weight_decay: float = ..., lr_schedule: Literal['constant', 'step', 'cosine', 'linear'] = ..., warmup_steps: int = ..., warmup_ratio: float = ..., lr_min: float = ..., lr_schedule_eta_min: float = ..., lr_steps: list[Any] = ..., drop_after_epoch: list[Any] = ..., lr_gamma: float = ..., lr_decay: float = ..., grad_clip: float = ..., ema: float = ..., early_stop: int = ..., val_after: int = ..., checkpoint_after_iter: int = ..., checkpoint_minutes: float = ..., checkpoints_kept: int = ..., log_after: int = ..., num_workers: int = ..., seed: int = ..., dropout: float = ..., augment: bool = ...) -> dict[str, Any]: ...

class QuadraticSelfOnnLearner(Words):
    """Two layers of quadratic neurons tell which of a few words was spoken.

    Task: speech_recognition. ``infer`` takes:

        audio: Audio. What was heard; a Timeseries of one feature is taken to be at the learner's sample rate.

    and gives: Category.

    Args:
        expansion_order: Up to which power neurons take their input, in the network that is trained; a loaded
            model has its own. (default 3; 1 to 9)
        output_classes_n: Classes. None: as many as the data name (in OpenDR 20, whatever the data). (default
            None; 2 to 10000)
        preprocess_to_mfcc: Whether cepstra are made of the input; unset, it is a Timeseries of cepstra already,
            as many a frame as the network takes. (default True)
        sample_rate: Samples a second of the sound. (default 16000; 4000 to 384000 Hz)
        voice_activity: A container of `silero_vad`: seconds of a stream in which nobody speaks are then not
            answered, which is the wake-word mode. None: every second is answered. (default None)
        others: OpenDR's arguments, see ``opendr.engine.learners.BaseLearner``.

    Parameters of ``fit``, for one call or, given here, for all of them:
        epochs: How often the data set is gone through. (default 30; 1 to 1e+06; in OpenDR iters)
        max_steps: Optimiser steps after which training ends, whatever the number of epochs; 0 for no limit.
            (default 0; 0 to 1e+09)
        batch_size: Samples a batch. (default 64; 1 to 65536)
        accumulate: Batches whose gradients are added up for one step of the optimiser. (default 1; 1 to 4096; in
            OpenDR batches_per_iter)
        lr: Learning rate at its highest. (default 0.01; 0 to 100)
        optimizer: What turns gradients into steps. (default 'sgd'; one of 'adamw', 'adam', 'sgd', 'rmsprop'; in
            OpenDR optimizer_name)
        momentum: Momentum of `sgd` and `rmsprop`. (default 0.9; 0 to 1)
        weight_decay: Weight decay: decoupled from the gradient in `adamw`, added to it in the others. (default
            0.0; 0 to 10)
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
        num_workers: Threads that read and augment samples. (default 2; 0 to 1024)
        seed: What first weights, order, augmentation and dropout follow from. (default 0)
        dropout: Share of values between layers that are left out at random in each training step. (default 0.2; 0
            to 0.99)
        augment: Whether training sound is shifted, made louder or softer and mixed with noise, and its cepstra
            covered in part, all at random. (default True)
    """

    expansion_order: int
    output_classes_n: Optional[int]
    preprocess_to_mfcc: bool
    sample_rate: int
    voice_activity: Optional[str]
    def __init__(self, lr: float = ..., iters: int = ..., batch_size: int = ..., optimizer: Literal['adamw', 'adam', 'sgd', 'rmsprop'] = ..., checkpoint_after_iter: int = ..., checkpoint_load_iter: int = ..., temp_path: str = ..., device: str = ..., expansion_order: int = ..., output_classes_n: Optional[int] = ..., momentum: float = ..., preprocess_to_mfcc: bool = ..., sample_rate: int = ..., *, lr_schedule: Literal['constant', 'step', 'cosine', 'linear'] = ..., backbone: str = ..., network_head: str = ..., threshold: float = ..., scale: float = ..., epochs: int = ..., max_steps: int = ..., accumulate: int = ..., batches_per_iter: int = ..., optimizer_name: Literal['adamw', 'adam', 'sgd', 'rmsprop'] = ..., weight_decay: float = ..., warmup_steps: int = ..., warmup_ratio: float = ..., lr_min: float = ..., lr_schedule_eta_min: float = ..., lr_steps: list[Any] = ..., drop_after_epoch: list[Any] = ..., lr_gamma: float = ..., lr_decay: float = ..., grad_clip: float = ..., ema: float = ..., early_stop: int = ..., val_after: int = ..., checkpoint_minutes: float = ..., checkpoints_kept: int = ..., log_after: int = ..., num_workers: int = ..., seed: int = ..., dropout: float = ..., augment: bool = ..., voice_activity: Optional[str] = ...) -> None: ...
    @overload
    def infer(self, audio: Union[Audio, Timeseries]) -> Category: ...
    @overload
    def infer(self, audio: Sequence[Union[Audio, Timeseries]]) -> list[Category]: ...
    @overload
    def infer(self, audio: Iterator[Union[Audio, Timeseries]]) -> Iterator[Category]: ...
    def fit(self, dataset: Dataset, val_dataset: Optional[Dataset] = ..., logging_path: PathLike = ..., silent: bool = ..., verbose: bool = ..., *, out: Optional[PathLike] = ..., resume: bool = ..., split: Optional[str] = ..., val_split: Optional[str] = ..., limit: Optional[int] = ..., teacher: Union[None, str, Learner] = ..., teacher_threshold: Optional[float] = ..., teacher_classes: Sequence[str] = ..., teacher_map: Optional[Mapping[str, str]] = ..., teacher_by_number: bool = ..., keep_empty: bool = ..., skip_broken: bool = ..., epochs: int = ..., iters: int = ..., max_steps: int = ..., batch_size: int = ..., accumulate: int = ..., batches_per_iter: int = ..., lr: float = ..., optimizer: Literal['adamw', 'adam', 'sgd', 'rmsprop'] = ..., optimizer_name: Literal['adamw', 'adam', 'sgd', 'rmsprop'] = ..., momentum: float = ..., weight_decay: float = ..., lr_schedule: Literal['constant', 'step', 'cosine', 'linear'] = ..., warmup_steps: int = ..., warmup_ratio: float = ..., lr_min: float = ..., lr_schedule_eta_min: float = ..., lr_steps: list[Any] = ..., drop_after_epoch: list[Any] = ..., lr_gamma: float = ..., lr_decay: float = ..., grad_clip: float = ..., ema: float = ..., early_stop: int = ..., val_after: int = ..., checkpoint_after_iter: int = ..., checkpoint_minutes: float = ..., checkpoints_kept: int = ..., log_after: int = ..., num_workers: int = ..., seed: int = ..., dropout: float = ..., augment: bool = ...) -> dict[str, Any]: ...

class MatchboxNetLearner(Words):
    """MatchboxNet tells which of a few words was spoken; small and quick.

    Task: speech_recognition. ``infer`` takes:

        audio: Audio. What was heard; a Timeseries of one feature is taken to be at the learner's sample rate.

    and gives: Category.

    Args:
        number_of_blocks: Blocks with a way past them (B in the paper). (default 3; 1 to 64)
        number_of_subblocks: Convolutions in a block (R in the paper). (default 1; 1 to 64)
        number_of_channels: Channels of the blocks (C in the paper). (default 64; 1 to 4096)
        output_classes_n: Classes. None: as many as the data name (in OpenDR 20, whatever the data). (default
            None; 2 to 10000)
        preprocess_to_mfcc: Whether cepstra are made of the input; unset, it is a Timeseries of cepstra already,
            as many a frame as the network takes. (default True)
        sample_rate: Samples a second of the sound. (default 16000; 4000 to 384000 Hz)
        voice_activity: A container of `silero_vad`: seconds of a stream in which nobody speaks are then not
            answered, which is the wake-word mode. None: every second is answered. (default None)
        others: OpenDR's arguments, see ``opendr.engine.learners.BaseLearner``.

    Parameters of ``fit``, for one call or, given here, for all of them:
        epochs: How often the data set is gone through. (default 30; 1 to 1e+06; in OpenDR iters)
        max_steps: Optimiser steps after which training ends, whatever the number of epochs; 0 for no limit.
            (default 0; 0 to 1e+09)
        batch_size: Samples a batch. (default 64; 1 to 65536)
        accumulate: Batches whose gradients are added up for one step of the optimiser. (default 1; 1 to 4096; in
            OpenDR batches_per_iter)
        lr: Learning rate at its highest. (default 0.0003; 0 to 100)
        optimizer: What turns gradients into steps. (default 'adam'; one of 'adamw', 'adam', 'sgd', 'rmsprop'; in
            OpenDR optimizer_name)
        momentum: Momentum of `sgd` and `rmsprop`. (default 0.9; 0 to 1)
        weight_decay: Weight decay: decoupled from the gradient in `adamw`, added to it in the others. (default
            0.0; 0 to 10)
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
        num_workers: Threads that read and augment samples. (default 2; 0 to 1024)
        seed: What first weights, order, augmentation and dropout follow from. (default 0)
        dropout: Share of values between layers that are left out at random in each training step. (default 0.2; 0
            to 0.99)
        augment: Whether training sound is shifted, made louder or softer and mixed with noise, and its cepstra
            covered in part, all at random. (default True)
    """

    number_of_blocks: int
    number_of_subblocks: int
    number_of_channels: int
    output_classes_n: Optional[int]
    preprocess_to_mfcc: bool
    sample_rate: int
    voice_activity: Optional[str]
    def __init__(self, lr: float = ..., iters: int = ..., batch_size: int = ..., optimizer: Literal['adamw', 'adam', 'sgd', 'rmsprop'] = ..., checkpoint_after_iter: int = ..., checkpoint_load_iter: int = ..., temp_path: str = ..., device: str = ..., number_of_blocks: int = ..., number_of_subblocks: int = ..., number_of_channels: int = ..., output_classes_n: Optional[int] = ..., momentum: float = ..., preprocess_to_mfcc: bool = ..., sample_rate: int = ..., *, lr_schedule: Literal['constant', 'step', 'cosine', 'linear'] = ..., backbone: str = ..., network_head: str = ..., threshold: float = ..., scale: float = ..., epochs: int = ..., max_steps: int = ..., accumulate: int = ..., batches_per_iter: int = ..., optimizer_name: Literal['adamw', 'adam', 'sgd', 'rmsprop'] = ..., weight_decay: float = ..., warmup_steps: int = ..., warmup_ratio: float = ..., lr_min: float = ..., lr_schedule_eta_min: float = ..., lr_steps: list[Any] = ..., drop_after_epoch: list[Any] = ..., lr_gamma: float = ..., lr_decay: float = ..., grad_clip: float = ..., ema: float = ..., early_stop: int = ..., val_after: int = ..., checkpoint_minutes: float = ..., checkpoints_kept: int = ..., log_after: int = ..., num_workers: int = ..., seed: int = ..., dropout: float = ..., augment: bool = ..., voice_activity: Optional[str] = ...) -> None: ...
    @overload
    def infer(self, audio: Union[Audio, Timeseries]) -> Category: ...
    @overload
    def infer(self, audio: Sequence[Union[Audio, Timeseries]]) -> list[Category]: ...
    @overload
    def infer(self, audio: Iterator[Union[Audio, Timeseries]]) -> Iterator[Category]: ...
    def fit(self, dataset: Dataset, val_dataset: Optional[Dataset] = ..., logging_path: PathLike = ..., silent: bool = ..., verbose: bool = ..., *, out: Optional[PathLike] = ..., resume: bool = ..., split: Optional[str] = ..., val_split: Optional[str] = ..., limit: Optional[int] = ..., teacher: Union[None, str, Learner] = ..., teacher_threshold: Optional[float] = ..., teacher_classes: Sequence[str] = ..., teacher_map: Optional[Mapping[str, str]] = ..., teacher_by_number: bool = ..., keep_empty: bool = ..., skip_broken: bool = ..., epochs: int = ..., iters: int = ..., max_steps: int = ..., batch_size: int = ..., accumulate: int = ..., batches_per_iter: int = ..., lr: float = ..., optimizer: Literal['adamw', 'adam', 'sgd', 'rmsprop'] = ..., optimizer_name: Literal['adamw', 'adam', 'sgd', 'rmsprop'] = ..., momentum: float = ..., weight_decay: float = ..., lr_schedule: Literal['constant', 'step', 'cosine', 'linear'] = ..., warmup_steps: int = ..., warmup_ratio: float = ..., lr_min: float = ..., lr_schedule_eta_min: float = ..., lr_steps: list[Any] = ..., drop_after_epoch: list[Any] = ..., lr_gamma: float = ..., lr_decay: float = ..., grad_clip: float = ..., ema: float = ..., early_stop: int = ..., val_after: int = ..., checkpoint_after_iter: int = ..., checkpoint_minutes: float = ..., checkpoints_kept: int = ..., log_after: int = ..., num_workers: int = ..., seed: int = ..., dropout: float = ..., augment: bool = ...) -> dict[str, Any]: ...

class DsCnnLearner(NativeLearner):
    """DS-CNN tells twelve words apart, in 52 kB and 8 bits.

    Task: speech_recognition. ``infer`` takes:

        audio: Audio. What was heard; a Timeseries of one feature is taken to be at the learner's sample rate.

    and gives: Category.

    Args:
        voice_activity: A container of `silero_vad`: seconds of a stream in which nobody speaks are then not
            answered, which is the wake-word mode. None: every second is answered. (default None)
        others: OpenDR's arguments, see ``opendr.engine.learners.BaseLearner``.
    """

    voice_activity: Optional[str]
    def __init__(self, lr: float = ..., iters: int = ..., batch_size: int = ..., optimizer: str = ..., lr_schedule: str = ..., backbone: str = ..., network_head: str = ..., checkpoint_after_iter: int = ..., checkpoint_load_iter: int = ..., temp_path: str = ..., device: str = ..., threshold: float = ..., scale: float = ..., *, voice_activity: Optional[str] = ...) -> None: ...
    @overload
    def infer(self, audio: Union[Audio, Timeseries]) -> Category: ...
    @overload
    def infer(self, audio: Sequence[Union[Audio, Timeseries]]) -> list[Category]: ...
    @overload
    def infer(self, audio: Iterator[Union[Audio, Timeseries]]) -> Iterator[Category]: ...
