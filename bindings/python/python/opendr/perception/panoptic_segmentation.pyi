"""Learners of the task panoptic_segmentation. Made by bindings/python/stubs.py; do not edit."""

import os
from collections.abc import Iterator, Sequence
from typing import Any, Literal, NamedTuple, Optional, Union, overload

from numpy.typing import ArrayLike, NDArray
from opendr._native_learner import NativeLearner
from opendr.engine.data import Image
from opendr.engine.target import Heatmap

class EfficientPsLearnerOutputs(NamedTuple):
    instance: Heatmap
    semantic: Heatmap

class EfficientPsLearner(NativeLearner):
    """Tells class and object of every pixel, by fusing DeepLab, CenterNet and BodyPix.

    Task: panoptic_segmentation. ``infer`` takes:

        image: Image.

    and gives: Heatmap, Heatmap.

    Args:
        threshold: Objects below this score are dropped. (default 0.3; 0 to 1; may change while running, also for
            one call of infer)
        box_masks: Whether objects of classes that no map of classes knows are the whole of their boxes; else they
            are left out. (default True; may change while running, also for one call of infer)
        min_overlap: Objects are dropped of whose box the map of classes confirms a smaller share. (default 0.1; 0
            to 1; may change while running, also for one call of infer)
        min_leftover: Regions of a countable class outside of all boxes are objects from this share of the picture
            on. (default 0.1; 0 to 1; may change while running, also for one call of infer)
        min_stuff: Regions that are not countable are told from this share of the picture on. (default 0.02; 0 to
            1; may change while running, also for one call of infer)
        others: OpenDR's arguments, see ``opendr.engine.learners.BaseLearner``.

    Arguments of OpenDR that are taken and have no effect:
        config_file: no effect: there is no network of its own to configure.
        lr: no effect: it belongs to training, which this learner does not have.
        iters: no effect: it belongs to training, which this learner does not have.
        batch_size: no effect: it belongs to training, which this learner does not have.
        optimizer: no effect: it belongs to training, which this learner does not have.
        lr_schedule: no effect: it belongs to training, which this learner does not have.
        momentum: no effect: it belongs to training, which this learner does not have.
        weight_decay: no effect: it belongs to training, which this learner does not have.
        optimizer_config: no effect: it belongs to training, which this learner does not have.
        checkpoint_after_iter: no effect: it belongs to training, which this learner does not have.
        num_workers: no effect: it belongs to training, which this learner does not have.
        seed: no effect: it belongs to training, which this learner does not have.
    """

    box_masks: bool
    min_overlap: float
    min_leftover: float
    min_stuff: float
    def __init__(self, lr: float = ..., iters: int = ..., batch_size: int = ..., optimizer: str = ..., lr_schedule: str = ..., backbone: str = ..., network_head: str = ..., checkpoint_after_iter: int = ..., checkpoint_load_iter: int = ..., temp_path: str = ..., device: str = ..., threshold: float = ..., scale: float = ..., *, box_masks: bool = ..., min_overlap: float = ..., min_leftover: float = ..., min_stuff: float = ..., config_file: Any = ..., momentum: Any = ..., weight_decay: Any = ..., optimizer_config: Any = ..., num_workers: Any = ..., seed: Any = ...) -> None: ...
    @overload
    def infer(self, image: Union[Image, NDArray[Any], str, os.PathLike[str]], *, threshold: float = ..., box_masks: bool = ..., min_overlap: float = ..., min_leftover: float = ..., min_stuff: float = ..., config_file: Any = ..., lr: Any = ..., iters: Any = ..., batch_size: Any = ..., optimizer: Any = ..., lr_schedule: Any = ..., momentum: Any = ..., weight_decay: Any = ..., optimizer_config: Any = ..., checkpoint_after_iter: Any = ..., num_workers: Any = ..., seed: Any = ...) -> EfficientPsLearnerOutputs: ...  # type: ignore[overload-overlap]
    @overload
    def infer(self, image: Sequence[Union[Image, NDArray[Any], str, os.PathLike[str]]], *, threshold: float = ..., box_masks: bool = ..., min_overlap: float = ..., min_leftover: float = ..., min_stuff: float = ..., config_file: Any = ..., lr: Any = ..., iters: Any = ..., batch_size: Any = ..., optimizer: Any = ..., lr_schedule: Any = ..., momentum: Any = ..., weight_decay: Any = ..., optimizer_config: Any = ..., checkpoint_after_iter: Any = ..., num_workers: Any = ..., seed: Any = ...) -> list[EfficientPsLearnerOutputs]: ...
    @overload
    def infer(self, image: Iterator[Union[Image, NDArray[Any], str, os.PathLike[str]]], *, threshold: float = ..., box_masks: bool = ..., min_overlap: float = ..., min_leftover: float = ..., min_stuff: float = ..., config_file: Any = ..., lr: Any = ..., iters: Any = ..., batch_size: Any = ..., optimizer: Any = ..., lr_schedule: Any = ..., momentum: Any = ..., weight_decay: Any = ..., optimizer_config: Any = ..., checkpoint_after_iter: Any = ..., num_workers: Any = ..., seed: Any = ...) -> Iterator[EfficientPsLearnerOutputs]: ...
