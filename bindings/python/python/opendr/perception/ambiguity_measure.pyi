"""Learners of the task ambiguity_measure. Made by bindings/python/stubs.py; do not edit."""

# Each learner has the arguments of OpenDR's class of its name.
# mypy: disable-error-code="override"
# pyright: reportIncompatibleMethodOverride=false

import os
from collections.abc import Iterator, Mapping, Sequence
from typing import Any, Literal, NamedTuple, NoReturn, Optional, Union, overload

from numpy.typing import ArrayLike, NDArray
from opendr._native_learner import NativeLearner
from opendr.engine.target import Category, Heatmap

class AmbiguityMeasureLearnerOutputs(NamedTuple):
    category: Category
    peaks: Heatmap

class AmbiguityMeasureLearner(NativeLearner):
    """Tells whether a map of values leaves a doubt where the best place is.

    Task: ambiguity_measure. ``infer`` takes:

        heatmap: Heatmap.

    and gives: Category, Heatmap.

    Args:
        threshold: A map is ambiguous where what is left beside the best peak has this probability. (default 0.5;
            0 to 0.999999; may change while running, also for one call of infer)
        temperature: Of the softmax; larger ones make maps more ambiguous. (default 1.0; 1e-06 to 1e+06; may
            change while running, also for one call of infer)
        others: OpenDR's arguments, see ``opendr.engine.learners.BaseLearner``.
    """

    temperature: float
    def __init__(self, lr: float = ..., iters: int = ..., batch_size: int = ..., optimizer: str = ..., lr_schedule: str = ..., backbone: str = ..., network_head: str = ..., checkpoint_after_iter: int = ..., checkpoint_load_iter: int = ..., temp_path: str = ..., device: str = ..., threshold: float = ..., scale: float = ..., *, temperature: float = ...) -> None: ...
    @overload
    def infer(self, heatmap: Heatmap, *, threshold: float = ..., temperature: float = ...) -> AmbiguityMeasureLearnerOutputs: ...
    @overload
    def infer(self, heatmap: Sequence[Heatmap], *, threshold: float = ..., temperature: float = ...) -> list[AmbiguityMeasureLearnerOutputs]: ...
    @overload
    def infer(self, heatmap: Iterator[Heatmap], *, threshold: float = ..., temperature: float = ...) -> Iterator[AmbiguityMeasureLearnerOutputs]: ...
