"""References from predictions to the images that they were predicted from."""

from __future__ import annotations

import os
import weakref
from typing import TYPE_CHECKING, Any, NamedTuple, Optional, Union

from opendr._errors import InvalidInput

if TYPE_CHECKING:
    from opendr.engine.data import Image


class ImageFile(NamedTuple):
    """The file of an image, as it was when it was read."""

    path: str
    modified_ns: int
    bytes: int

    @classmethod
    def at(cls, path: Union[str, os.PathLike[str]]) -> Optional[ImageFile]:
        """Returns the file at a path; None where there is no file."""
        absolute = os.path.abspath(path)
        try:
            about = os.stat(absolute)
        except OSError:
            return None
        return cls(absolute, about.st_mtime_ns, about.st_size)


class ImageReference:
    """A reference to the image of a prediction, which does not keep it in memory.

    The image is the object that was given to ``infer`` while others refer to it, else the file that it was read from while that
    file is unchanged. Changes of the object are visible.
    """

    __slots__ = ("_file", "_object")

    def __init__(self, weak: Optional[weakref.ref[Any]], file: Optional[ImageFile]) -> None:
        self._object = weak
        self._file = file

    @classmethod
    def to(cls, value: Any) -> Optional[ImageReference]:
        """Returns a reference to an image as ``infer`` takes it; None for objects that cannot be referenced, such as lists."""
        if isinstance(value, (str, os.PathLike)):
            return cls(None, ImageFile.at(value))
        try:
            return cls(weakref.ref(value), getattr(value, "_file", None))
        except TypeError:
            return None

    def exists(self) -> bool:
        """Returns whether there still is an image."""
        return self._alive() is not None or self._file is not None and self._file == ImageFile.at(self._file.path)

    def image(self) -> Image:
        """Returns the image.

        Raises:
            opendr.InvalidInput: It is no longer in memory, and has no file, or its file has changed.
        """
        from opendr._input_value import input_value

        image: Image = input_value(self._existing(), "image", "Image")
        return image

    def _alive(self) -> Any:
        return None if self._object is None else self._object()

    def _existing(self) -> Any:
        alive = self._alive()
        if alive is not None:
            return alive
        if self._file is None:
            raise InvalidInput("the image of this prediction is no longer in memory; keep it in a variable, or give it: plot(image)")
        if self._file != ImageFile.at(self._file.path):
            raise InvalidInput(f"the image of this prediction, {self._file.path}, has changed or is gone; give it: plot(image)")
        return self._file.path
