"""An image with detections, for learners that process these further."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, ClassVar, Union

from opendr.engine.data.image import Image
from opendr.engine.target import BoundingBoxList

if TYPE_CHECKING:
    from numpy.typing import ArrayLike


class ImageWithDetections(Image):
    """An image with detected boxes.

    Args:
        image: The image, or an array as for :class:`Image`. The time stamp and frame id of an :class:`Image` are kept.
        boundingBoxList: The boxes.
        *args: Further arguments of :class:`Image`.
        **kwargs: Further arguments of :class:`Image`.

    Raises:
        TypeError: The boxes are not a :class:`BoundingBoxList`.
    """

    _fields: ClassVar[tuple[str, ...]] = ("data", "boundingBoxList")

    def __init__(
        self, image: Union[Image, ArrayLike], boundingBoxList: BoundingBoxList, *args: Any, **kwargs: Any
    ) -> None:
        if not isinstance(boundingBoxList, BoundingBoxList):
            raise TypeError(f"boundingBoxList should be a BoundingBoxList, not {boundingBoxList!r:.200}")
        super().__init__(image, *args, **kwargs)
        #: The boxes.
        self.boundingBoxList = boundingBoxList

    @property
    def boxes(self) -> BoundingBoxList:
        """The boxes."""
        return self.boundingBoxList

    def __str__(self) -> str:
        return f"ImageWithDetections {super().__str__()}{self.boundingBoxList}"
