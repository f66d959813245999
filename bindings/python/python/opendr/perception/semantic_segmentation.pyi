"""Learners of the task semantic_segmentation. Made by bindings/python/stubs.py; do not edit."""

import os
from collections.abc import Iterator, Sequence
from typing import Any, Literal, NamedTuple, Optional, Union, overload

from numpy.typing import ArrayLike, NDArray
from opendr._native_learner import NativeLearner
from opendr.engine.data import Image
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
