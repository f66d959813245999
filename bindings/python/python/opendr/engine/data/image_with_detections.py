"""A picture with boxes found before, for learners that look at these again."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, ClassVar, Union

from opendr.engine.data.image import Image
from opendr.engine.target import BoundingBoxList

if TYPE_CHECKING:
    from numpy.typing import ArrayLike


class ImageWithDetections(Image):
    """A picture with boxes in it.

    Args:
        image: The picture, or an array as :class:`Image` takes it. Of an :class:`Image`, the time stamp and frame
            are kept.
        boundingBoxList: The boxes.
        *args: Further arguments of :class:`Image`.
        **kwargs: Further arguments of :class:`Image`.

    Raises:
        TypeError: The boxes are no :class:`BoundingBoxList`.
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
