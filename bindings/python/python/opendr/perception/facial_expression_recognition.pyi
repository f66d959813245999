"""Learners of the task facial_expression_recognition. Made by bindings/python/stubs.py; do not edit."""

import os
from collections.abc import Iterator, Sequence
from typing import Any, Literal, NamedTuple, Optional, Union, overload

from numpy.typing import ArrayLike, NDArray
from opendr._native_learner import NativeLearner
from opendr.engine.data import Image
from opendr.engine.target import Category

class FacialEmotionLearner(NativeLearner):
    """mini-XCEPTION tells which of seven emotions the largest face in a frame shows.

    Task: facial_expression_recognition. ``infer`` takes:

        image: Image.

    and gives: Category.

    Args:
        face_threshold: What the detector scores below this is no face. (default 0.6; 0 to 1)
        picture: What pictures show. (default 'frame'; one of 'frame', 'face'; may change while running, also for
            one call of infer)
        others: OpenDR's arguments, see ``opendr.engine.learners.BaseLearner``.

    Arguments of OpenDR that are taken and have no effect:
        device_ind: no effect: `device` says where.
        validation_interval: no effect: it belongs to training, which this learner does not have.
        max_training_epoch: no effect: it belongs to training, which this learner does not have.
        momentum: no effect: it belongs to training, which this learner does not have.
        ensemble_size: no effect: the network is one, not an ensemble.
        base_path_experiment: no effect: it belongs to training, which this learner does not have.
        name_experiment: no effect: it belongs to training, which this learner does not have.
        dimensional_finetune: no effect: it belongs to training, which this learner does not have.
        categorical_train: no effect: it belongs to training, which this learner does not have.
        base_path_to_dataset: no effect: it belongs to training, which this learner does not have.
        max_tuning_epoch: no effect: it belongs to training, which this learner does not have.
        diversify: no effect: it belongs to training, which this learner does not have.
    """

    face_threshold: float
    picture: Literal['frame', 'face']
    def __init__(self, lr: float = ..., iters: int = ..., batch_size: int = ..., optimizer: str = ..., lr_schedule: str = ..., backbone: str = ..., network_head: str = ..., checkpoint_after_iter: int = ..., checkpoint_load_iter: int = ..., temp_path: str = ..., device: str = ..., threshold: float = ..., scale: float = ..., *, face_threshold: float = ..., picture: Literal['frame', 'face'] = ..., device_ind: Any = ..., validation_interval: Any = ..., max_training_epoch: Any = ..., momentum: Any = ..., ensemble_size: Any = ..., base_path_experiment: Any = ..., name_experiment: Any = ..., dimensional_finetune: Any = ..., categorical_train: Any = ..., base_path_to_dataset: Any = ..., max_tuning_epoch: Any = ..., diversify: Any = ...) -> None: ...
    @overload
    def infer(self, image: Union[Image, NDArray[Any], str, os.PathLike[str]], *, picture: Literal['frame', 'face'] = ..., device_ind: Any = ..., validation_interval: Any = ..., max_training_epoch: Any = ..., momentum: Any = ..., ensemble_size: Any = ..., base_path_experiment: Any = ..., name_experiment: Any = ..., dimensional_finetune: Any = ..., categorical_train: Any = ..., base_path_to_dataset: Any = ..., max_tuning_epoch: Any = ..., diversify: Any = ...) -> Category: ...  # type: ignore[overload-overlap]
    @overload
    def infer(self, image: Sequence[Union[Image, NDArray[Any], str, os.PathLike[str]]], *, picture: Literal['frame', 'face'] = ..., device_ind: Any = ..., validation_interval: Any = ..., max_training_epoch: Any = ..., momentum: Any = ..., ensemble_size: Any = ..., base_path_experiment: Any = ..., name_experiment: Any = ..., dimensional_finetune: Any = ..., categorical_train: Any = ..., base_path_to_dataset: Any = ..., max_tuning_epoch: Any = ..., diversify: Any = ...) -> list[Category]: ...
    @overload
    def infer(self, image: Iterator[Union[Image, NDArray[Any], str, os.PathLike[str]]], *, picture: Literal['frame', 'face'] = ..., device_ind: Any = ..., validation_interval: Any = ..., max_training_epoch: Any = ..., momentum: Any = ..., ensemble_size: Any = ..., base_path_experiment: Any = ..., name_experiment: Any = ..., dimensional_finetune: Any = ..., categorical_train: Any = ..., base_path_to_dataset: Any = ..., max_tuning_epoch: Any = ..., diversify: Any = ...) -> Iterator[Category]: ...
