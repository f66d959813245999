"""Learners of the task voice_activity_detection. Made by bindings/python/stubs.py; do not edit."""

# Each learner has the arguments of OpenDR's class of its name.
# mypy: disable-error-code="override"
# pyright: reportIncompatibleMethodOverride=false

import os
from collections.abc import Iterator, Mapping, Sequence
from typing import Any, Literal, NamedTuple, NoReturn, Optional, Union, overload

from numpy.typing import ArrayLike, NDArray
from opendr._native_learner import NativeLearner
from opendr.engine.data import Audio, Timeseries
from opendr.engine.target import Category

class SileroVadLearner(NativeLearner):
    """Silero VAD tells whether somebody speaks, 32 ms at a time.

    Task: voice_activity_detection. ``infer`` takes:

        audio: Audio. What was heard; a Timeseries of one feature is taken to be at the learner's sample rate.

    and gives: Category.

    Args:
        threshold: The least probability that speech begins with; it is quiet again 0.15 below. (default 0.5; 0 to
            1; may change while running, also for one call of infer)
        min_silence_duration_ms: How long it must be quiet until speech is over. (default 100; 0 to 60000 ms; may
            change while running, also for one call of infer)
        others: OpenDR's arguments, see ``opendr.engine.learners.BaseLearner``.
    """

    min_silence_duration_ms: int
    def __init__(self, lr: float = ..., iters: int = ..., batch_size: int = ..., optimizer: str = ..., lr_schedule: str = ..., backbone: str = ..., network_head: str = ..., checkpoint_after_iter: int = ..., checkpoint_load_iter: int = ..., temp_path: str = ..., device: str = ..., threshold: float = ..., scale: float = ..., *, min_silence_duration_ms: int = ...) -> None: ...
    @overload
    def infer(self, audio: Union[Audio, Timeseries], *, threshold: float = ..., min_silence_duration_ms: int = ...) -> Category: ...
    @overload
    def infer(self, audio: Sequence[Union[Audio, Timeseries]], *, threshold: float = ..., min_silence_duration_ms: int = ...) -> list[Category]: ...
    @overload
    def infer(self, audio: Iterator[Union[Audio, Timeseries]], *, threshold: float = ..., min_silence_duration_ms: int = ...) -> Iterator[Category]: ...
