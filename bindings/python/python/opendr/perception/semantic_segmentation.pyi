"""Learners of the task semantic_segmentation. Made by bindings/python/stubs.py; do not edit."""

# Each learner has the arguments of OpenDR's class of its name.
# mypy: disable-error-code="override"
# pyright: reportIncompatibleMethodOverride=false

import os
from collections.abc import Iterator, Mapping, Sequence
from typing import Any, Literal, NamedTuple, NoReturn, Optional, Union, overload

from numpy.typing import ArrayLike, NDArray
from opendr._upstream.segmentation_datasets import CamVidDataset as CamVidDataset
from opendr._native_learner import NativeLearner, PathLike
from opendr.engine.data import Image
from opendr.engine.datasets import Dataset
from opendr.engine.learners import Learner
from opendr.engine.target import Heatmap

class DeeplabLearner(NativeLearner):
    """DeepLab v3 tells the class of every pixel, in 8 bits.

    Task: semantic_segmentation. ``infer`` takes:

        image: Image.

    and gives: Heatmap.

    Args:
        full_size: Whether the map has the size of the picture; else it has the network's. (default True; may
            change while running, also for one call of infer)
        others: OpenDR's arguments, see ``opendr.engine.learners.BaseLearner``.
    """

    full_size: bool
    def __init__(self, lr: float = ..., iters: int = ..., batch_size: int = ..., optimizer: str = ..., lr_schedule: str = ..., backbone: str = ..., network_head: str = ..., checkpoint_after_iter: int = ..., checkpoint_load_iter: int = ..., temp_path: str = ..., device: str = ..., threshold: float = ..., scale: float = ..., *, full_size: bool = ...) -> None: ...
    @overload
    def infer(self, image: Union[Image, NDArray[Any], str, os.PathLike[str]], *, full_size: bool = ...) -> Heatmap: ...  # type: ignore[overload-overlap]
    @overload
    def infer(self, image: Sequence[Union[Image, NDArray[Any], str, os.PathLike[str]]], *, full_size: bool = ...) -> list[Heatmap]: ...
    @overload
    def infer(self, image: Iterator[Union[Image, NDArray[Any], str, os.PathLike[str]]], *, full_size: bool = ...) -> Iterator[Heatmap]: ...

class BisenetLearner(NativeLearner):
    """BiSeNet tells the class of every pixel; it is trained on a user's own masks.

    Task: semantic_segmentation. ``infer`` takes:

        image: Image.

    and gives: Heatmap.

    Args:
        full_size: Whether the map has the size of the picture; else it has the network's. (default True; may
            change while running, also for one call of infer)
        num_classes: Classes. None: as many as the data name. (default None; 2 to 255)
        others: OpenDR's arguments, see ``opendr.engine.learners.BaseLearner``.

    Parameters of ``fit``, for one call or, given here, for all of them:
        crop_height: Height of the network's input, a multiple of 32. (default 192; 32 to 2048 px)
        crop_width: Width of the network's input, a multiple of 32. (default 256; 32 to 2048 px)
        width: Channels of the first layers; the last have eight times as many. (default 16; 4 to 128)
        crop: The least share of a picture that a random crop shows; 1 for no crops. (default 0.5; 0.05 to 1)
        flip: How often a picture is mirrored. (default 0.5; 0 to 1)
        epochs: How often the data set is gone through. (default 100; 1 to 1e+06; in OpenDR iters)
        max_steps: Optimiser steps after which training ends, whatever the number of epochs; 0 for no limit.
            (default 0; 0 to 1e+09)
        batch_size: Samples a batch. (default 8; 1 to 65536)
        accumulate: Batches whose gradients are added up for one step of the optimiser. (default 1; 1 to 4096; in
            OpenDR batches_per_iter)
        lr: Learning rate at its highest. (default 0.002; 0 to 100)
        optimizer: What turns gradients into steps. (default 'adamw'; one of 'adamw', 'adam', 'sgd', 'rmsprop'; in
            OpenDR optimizer_name)
        momentum: Momentum of `sgd` and `rmsprop`. (default 0.9; 0 to 1)
        weight_decay: Weight decay: decoupled from the gradient in `adamw`, added to it in the others. (default
            0.0005; 0 to 10)
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
        context_path: no effect: the context path is a small residual network of its own.
        drop_last: no effect: the last batch of an epoch counts as any other.
        pin_memory: no effect: there is no other memory to copy to.
    """

    full_size: bool
    num_classes: Optional[int]
    def __init__(self, lr: float = ..., iters: int = ..., batch_size: int = ..., optimizer: Literal['adamw', 'adam', 'sgd', 'rmsprop'] = ..., temp_path: str = ..., checkpoint_after_iter: int = ..., checkpoint_load_iter: int = ..., device: str = ..., val_after: int = ..., weight_decay: float = ..., momentum: float = ..., drop_last: Any = ..., pin_memory: Any = ..., num_workers: int = ..., num_classes: Optional[int] = ..., crop_height: int = ..., crop_width: int = ..., context_path: Any = ..., *, lr_schedule: Literal['constant', 'step', 'cosine', 'linear'] = ..., backbone: str = ..., network_head: str = ..., threshold: float = ..., scale: float = ..., width: int = ..., crop: float = ..., flip: float = ..., epochs: int = ..., max_steps: int = ..., accumulate: int = ..., batches_per_iter: int = ..., optimizer_name: Literal['adamw', 'adam', 'sgd', 'rmsprop'] = ..., warmup_steps: int = ..., warmup_ratio: float = ..., lr_min: float = ..., lr_schedule_eta_min: float = ..., lr_steps: list[Any] = ..., drop_after_epoch: list[Any] = ..., lr_gamma: float = ..., lr_decay: float = ..., grad_clip: float = ..., ema: float = ..., early_stop: int = ..., checkpoint_minutes: float = ..., checkpoints_kept: int = ..., log_after: int = ..., seed: int = ..., full_size: bool = ...) -> None: ...
    @overload
    def infer(self, image: Union[Image, NDArray[Any], str, os.PathLike[str]], *, full_size: bool = ..., context_path: Any = ..., drop_last: Any = ..., pin_memory: Any = ...) -> Heatmap: ...  # type: ignore[overload-overlap]
    @overload
    def infer(self, image: Sequence[Union[Image, NDArray[Any], str, os.PathLike[str]]], *, full_size: bool = ..., context_path: Any = ..., drop_last: Any = ..., pin_memory: Any = ...) -> list[Heatmap]: ...
    @overload
    def infer(self, image: Iterator[Union[Image, NDArray[Any], str, os.PathLike[str]]], *, full_size: bool = ..., context_path: Any = ..., drop_last: Any = ..., pin_memory: Any = ...) -> Iterator[Heatmap]: ...
    def fit(self, dataset: Dataset, val_dataset: Optional[Dataset] = ..., silent: bool = ..., verbose: bool = ..., *, logging_path: PathLike = ..., out: Optional[PathLike] = ..., resume: bool = ..., split: Optional[str] = ..., val_split: Optional[str] = ..., limit: Optional[int] = ..., teacher: Union[None, str, Learner] = ..., teacher_threshold: Optional[float] = ..., teacher_classes: Sequence[str] = ..., teacher_map: Optional[Mapping[str, str]] = ..., teacher_by_number: bool = ..., keep_empty: bool = ..., skip_broken: bool = ..., crop_height: int = ..., crop_width: int = ..., width: int = ..., crop: float = ..., flip: float = ..., epochs: int = ..., iters: int = ..., max_steps: int = ..., batch_size: int = ..., accumulate: int = ..., batches_per_iter: int = ..., lr: float = ..., optimizer: Literal['adamw', 'adam', 'sgd', 'rmsprop'] = ..., optimizer_name: Literal['adamw', 'adam', 'sgd', 'rmsprop'] = ..., momentum: float = ..., weight_decay: float = ..., lr_schedule: Literal['constant', 'step', 'cosine', 'linear'] = ..., warmup_steps: int = ..., warmup_ratio: float = ..., lr_min: float = ..., lr_schedule_eta_min: float = ..., lr_steps: list[Any] = ..., drop_after_epoch: list[Any] = ..., lr_gamma: float = ..., lr_decay: float = ..., grad_clip: float = ..., ema: float = ..., early_stop: int = ..., val_after: int = ..., checkpoint_after_iter: int = ..., checkpoint_minutes: float = ..., checkpoints_kept: int = ..., log_after: int = ..., num_workers: int = ..., seed: int = ...) -> dict[str, Any]: ...
    def eval(self, dataset: Dataset, silent: Any = ..., verbose: bool = ..., *, metric: Optional[str] = ..., split: Optional[str] = ..., limit: Optional[int] = ..., out: Optional[PathLike] = ..., skip_broken: bool = ..., classes: Optional[Mapping[str, str]] = ..., by_number: bool = ..., resamples: int = ..., **metric_params: Any) -> dict[str, Any]: ...

class SelfieSegmentationLearner(NativeLearner):
    """Tells a person near the camera from what is behind.

    Task: semantic_segmentation. ``infer`` takes:

        image: Image.

    and gives: Heatmap.

    Args:
        threshold: Pixels from this probability on are a person's. (default 0.5; 0 to 1; may change while running,
            also for one call of infer)
        probabilities: Whether the map holds probabilities, for blending, instead of classes. (default False; may
            change while running, also for one call of infer)
        others: OpenDR's arguments, see ``opendr.engine.learners.BaseLearner``.
    """

    probabilities: bool
    def __init__(self, lr: float = ..., iters: int = ..., batch_size: int = ..., optimizer: str = ..., lr_schedule: str = ..., backbone: str = ..., network_head: str = ..., checkpoint_after_iter: int = ..., checkpoint_load_iter: int = ..., temp_path: str = ..., device: str = ..., threshold: float = ..., scale: float = ..., *, probabilities: bool = ...) -> None: ...
    @overload
    def infer(self, image: Union[Image, NDArray[Any], str, os.PathLike[str]], *, threshold: float = ..., probabilities: bool = ...) -> Heatmap: ...  # type: ignore[overload-overlap]
    @overload
    def infer(self, image: Sequence[Union[Image, NDArray[Any], str, os.PathLike[str]]], *, threshold: float = ..., probabilities: bool = ...) -> list[Heatmap]: ...
    @overload
    def infer(self, image: Iterator[Union[Image, NDArray[Any], str, os.PathLike[str]]], *, threshold: float = ..., probabilities: bool = ...) -> Iterator[Heatmap]: ...

class TiledSegmentationLearner(NativeLearner):
    """Tells the class of every pixel of large pictures in tiles, within a time budget.

    Task: semantic_segmentation. ``infer`` takes:

        image: Image.

    and gives: Heatmap.

    Args:
        tile: Side of a tile in the picture. What is looked for should fill a tenth of it or more. (default 512;
            32 to 4096 px; may change while running, also for one call of infer)
        tile_overlap: What neighbouring tiles share: what is smaller lies whole in one of them. At most half of a
            tile counts. (default 64; 0 to 2048 px; may change while running, also for one call of infer)
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
    def __init__(self, lr: float = ..., iters: int = ..., batch_size: int = ..., optimizer: str = ..., lr_schedule: str = ..., backbone: str = ..., network_head: str = ..., checkpoint_after_iter: int = ..., checkpoint_load_iter: int = ..., temp_path: str = ..., device: str = ..., threshold: float = ..., scale: float = ..., *, tile: int = ..., tile_overlap: int = ..., whole: bool = ..., time_budget: float = ..., max_tiles: int = ..., detail_threshold: float = ..., change_threshold: float = ..., memory: int = ..., rotation: int = ..., parallel_tiles: int = ...) -> None: ...
    @overload
    def infer(self, image: Union[Image, NDArray[Any], str, os.PathLike[str]], *, tile: int = ..., tile_overlap: int = ..., whole: bool = ..., time_budget: float = ..., max_tiles: int = ..., detail_threshold: float = ..., change_threshold: float = ..., memory: int = ..., rotation: int = ...) -> Heatmap: ...  # type: ignore[overload-overlap]
    @overload
    def infer(self, image: Sequence[Union[Image, NDArray[Any], str, os.PathLike[str]]], *, tile: int = ..., tile_overlap: int = ..., whole: bool = ..., time_budget: float = ..., max_tiles: int = ..., detail_threshold: float = ..., change_threshold: float = ..., memory: int = ..., rotation: int = ...) -> list[Heatmap]: ...
    @overload
    def infer(self, image: Iterator[Union[Image, NDArray[Any], str, os.PathLike[str]]], *, tile: int = ..., tile_overlap: int = ..., whole: bool = ..., time_budget: float = ..., max_tiles: int = ..., detail_threshold: float = ..., change_threshold: float = ..., memory: int = ..., rotation: int = ...) -> Iterator[Heatmap]: ...

class YOLOv8SegLearner:
    """Not here yet: use DeeplabLearner for classes, BodyPixLearner of instance_segmentation for persons."""

    def __init__(self, *args: Any, **kwargs: Any) -> NoReturn: ...
