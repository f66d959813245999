"""Image files, folders, videos and cameras as one iterator of images."""

from __future__ import annotations

import os
from collections.abc import Iterator
from typing import Optional, Union

from opendr import _opendr
from opendr.engine.data import Image

PathLike = Union[str, "os.PathLike[str]"]


class Source(Iterator[Image]):
    """The images of image files, folders, patterns (``"photos/**/*.jpg"``), videos and cameras (``"camera:0"``).

    Videos are decoded by an installed ``ffmpeg``. Every frame of a file is returned; a camera returns its newest frame.
    A file that cannot be read raises when it is reached; the next step of the iteration continues with the next file.

    Args:
        inputs: Files, folders, patterns and cameras, which are read in order.

    Raises:
        FileNotFoundError: An input does not exist, or contains nothing to read.
        opendr.Unsupported: An input needs a program or system that is not available.
    """

    def __init__(self, *inputs: PathLike) -> None:
        self._frames = _opendr.Source([os.fspath(path) for path in inputs])
        self._read = 0
        #: The file or device of the last image; None before the first.
        self.path: Optional[str] = None
        #: Index of the last image in its video or camera, from 0; 0 for an image file.
        self.number: int = 0

    def __next__(self) -> Image:
        image, path, self.number = next(self._frames)
        self._read += 1
        self.path = os.fspath(path)
        return image

    def __length_hint__(self) -> int:
        """Returns the number of images that are left."""
        return NotImplemented if self.length is None else max(self.length - self._read, 0)

    @property
    def length(self) -> Optional[int]:
        """Number of images; None when unknown."""
        return self._frames.length

    @property
    def live(self) -> bool:
        """Whether frames are dropped when the caller is slower than the source."""
        return self._frames.live
