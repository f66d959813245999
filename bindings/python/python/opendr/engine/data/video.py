"""Clips for learners that look at many pictures at once."""

from __future__ import annotations

from typing import ClassVar

from opendr.engine.data.array_data import ArrayData


class Video(ArrayData):
    """A clip ``[channels, time, height, width]``, float32, channels in the order RGB.

    A learner that looks at one picture after the other takes :class:`Image` objects instead.
    """

    _axes: ClassVar[tuple[str, ...]] = ("channels", "time", "height", "width")
