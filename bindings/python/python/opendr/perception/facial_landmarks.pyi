"""Learners of the task facial_landmarks. Made by bindings/python/stubs.py; do not edit."""

# Each learner has the arguments of OpenDR's class of its name.
# mypy: disable-error-code="override"
# pyright: reportIncompatibleMethodOverride=false

import os
from collections.abc import Iterator, Mapping, Sequence
from typing import Any, Literal, NamedTuple, NoReturn, Optional, Union, overload

from numpy.typing import ArrayLike, NDArray
from opendr._drawing import draw as draw
from opendr._drawing import get_bbox as get_bbox
from opendr._native_learner import NativeLearner, PathLike
from opendr.engine.data import Image
from opendr.engine.target import PoseList

class FaceMeshLearner(NativeLearner):
    """MediaPipe's face mesh: 468 points of a face and its irises, followed from frame to frame.

    Task: facial_landmarks. ``infer`` takes:

        image: Image.

    and gives: PoseList.

    Args:
        threshold: Faces of which the mesh is surer than this are answered. (default 0.5; 0 to 1; may change while
            running, also for one call of infer)
        face_threshold: What the detector scores below this is no face. (default 0.6; 0 to 1)
        max_faces: At most this many faces a picture; the detector runs on frames that show fewer. (default 1; 1
            to 50; may change while running, also for one call of infer)
        track: Whether faces are followed from frame to frame; else each frame is looked at anew. (default True;
            may change while running, also for one call of infer)
        others: OpenDR's arguments, see ``opendr.engine.learners.BaseLearner``.
    """

    face_threshold: float
    max_faces: int
    track: bool
    def __init__(self, lr: float = ..., iters: int = ..., batch_size: int = ..., optimizer: str = ..., lr_schedule: str = ..., backbone: str = ..., network_head: str = ..., checkpoint_after_iter: int = ..., checkpoint_load_iter: int = ..., temp_path: str = ..., device: str = ..., threshold: float = ..., scale: float = ..., *, face_threshold: float = ..., max_faces: int = ..., track: bool = ...) -> None: ...
    @overload
    def infer(self, image: Union[Image, NDArray[Any], str, os.PathLike[str]], *, threshold: float = ..., max_faces: int = ..., track: bool = ...) -> PoseList: ...  # type: ignore[overload-overlap]
    @overload
    def infer(self, image: Sequence[Union[Image, NDArray[Any], str, os.PathLike[str]]], *, threshold: float = ..., max_faces: int = ..., track: bool = ...) -> list[PoseList]: ...
    @overload
    def infer(self, image: Iterator[Union[Image, NDArray[Any], str, os.PathLike[str]]], *, threshold: float = ..., max_faces: int = ..., track: bool = ...) -> Iterator[PoseList]: ...
