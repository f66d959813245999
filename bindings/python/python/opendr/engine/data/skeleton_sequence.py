"""Skeletons over time, for action recognition."""

from __future__ import annotations

from typing import ClassVar

from opendr.engine.data.array_data import ArrayData


class SkeletonSequence(ArrayData):
    """Joints of persons over time, ``[samples, channels, frames, joints, persons]``, float32.

    The channels are x, y and score (pixels) or x, y, z (metres).
    """

    _axes: ClassVar[tuple[str, ...]] = ("samples", "channels", "frames", "joints", "persons")
