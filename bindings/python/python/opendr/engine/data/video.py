"""Video clips, for learners that process several frames at once."""

from __future__ import annotations

from typing import ClassVar

from opendr.engine.data.array_data import ArrayData


class Video(ArrayData):
    """A clip ``[channels, time, height, width]``, float32, channels in the order RGB.

    A learner that processes one frame at a time takes :class:`Image` objects instead.
    """

    _axes: ClassVar[tuple[str, ...]] = ("channels", "time", "height", "width")
