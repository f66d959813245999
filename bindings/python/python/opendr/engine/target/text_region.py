"""Text in images."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any, ClassVar, Optional

from opendr.engine._arrays import array_of
from opendr.engine._checks import Real, real
from opendr.engine._checks import text as checked_text
from opendr.engine.target._table import Column, Table, floats, texts
from opendr.engine.target.base_target import Target
from opendr.engine.target.target_list import TargetList

if TYPE_CHECKING:
    import supervision
    from numpy.typing import ArrayLike, NDArray


class TextRegion(Target):
    """A line of text in an image; ``data`` is the same as ``text``.

    Args:
        text: The text; ``"###"`` in the annotation of a text that cannot be read.
        corners: ``[4, 2]``, x and y in pixels, clockwise from the top left corner of the text.
        confidence: Score of the text, in [0, 1].

    Raises:
        TypeError: The text is not a ``str``, or a value is not a number.
        ValueError: The corners have another shape, or a number is not finite.
    """

    _fields: ClassVar[tuple[str, ...]] = ("text", "corners", "confidence")

    def __init__(self, text: str, corners: ArrayLike, confidence: Real = 0.0) -> None:
        self.data = text
        self.corners = corners
        self.confidence = real(confidence, "confidence")

    @property
    def data(self) -> str:
        """The text."""
        return str(self._data)

    @data.setter
    def data(self, data: str) -> None:
        self._data = checked_text(data, "text")

    @property
    def text(self) -> str:
        """The text."""
        return self.data

    @property
    def corners(self) -> NDArray[Any]:
        """``[4, 2]``, pixels, float32."""
        return self._corners

    @corners.setter
    def corners(self, corners: ArrayLike) -> None:
        import numpy as np

        points = array_of(corners, "float32", "corners")
        if points.shape != (4, 2) or not np.isfinite(points).all():
            raise ValueError(f"corners of shape {points.shape} should be finite numbers [4, 2]; give x and y of each corner")
        self._corners: NDArray[Any] = points


class TextRegionList(TargetList[TextRegion]):
    """The lines of text in an image, in reading order.

    Args:
        regions: The regions.
    """

    _item = TextRegion

    def __init__(self, regions: Optional[Iterable[TextRegion]] = None) -> None:
        super().__init__(regions)

    @property
    def regions(self) -> list[TextRegion]:
        """The regions; the same list as ``data``."""
        return self.data

    @property
    def text(self) -> str:
        """The texts, a line each."""
        return "\n".join(region.text for region in self.data)

    def to_supervision(self) -> supervision.Detections:
        """Returns the regions as ``supervision.Detections`` of class 0: the boxes around the corners, which are in
        ``data["xyxyxyxy"]``, and the texts in ``data["class_name"]``, as of EasyOCR.

        Raises:
            ImportError: The package supervision is not installed.
        """
        from opendr.engine.target._supervision import text_detections

        return text_detections(self.data)

    def _is_drawn(self) -> bool:
        return True

    def _table(self) -> Table:
        sides = {f"{axis}{corner}": (corner, at) for corner in range(4) for at, axis in enumerate("xy")}
        return {
            "text": texts(region.text for region in self.data),
            "confidence": floats(region.confidence for region in self.data),
            **{name: Column([region.corners[at] for region in self.data], "float32") for name, at in sides.items()},
        }
