"""Pictures, folders, videos and cameras as one iterator of images."""

from __future__ import annotations

import os
from collections.abc import Iterator
from typing import Optional, Union

from opendr import _opendr
from opendr.engine.data import Image

PathLike = Union[str, "os.PathLike[str]"]


class Source(Iterator[Image]):
    """The images of picture files, folders, patterns (``"photos/**/*.jpg"``), videos and cameras (``"camera:0"``).

    Videos are read by an installed ``ffmpeg``. Of files no frame is left out; of a camera you get the newest one.
    A file that cannot be read raises when its turn comes; the next step of the iteration goes on with the next file.

    Args:
        inputs: What to read, one after the other.

    Raises:
        FileNotFoundError: An input does not exist, or holds nothing to read.
        opendr.Unsupported: It takes a program or system that is not there.
    """

    def __init__(self, *inputs: PathLike) -> None:
        self._frames = _opendr.Source([os.fspath(path) for path in inputs])
        #: The file or device of the last image; None before the first.
        self.path: Optional[str] = None
        #: The last image's number in its video or camera, from 0; 0 for a picture file.
        self.number: int = 0

    def __next__(self) -> Image:
        image, path, self.number = next(self._frames)
        self.path = os.fspath(path)
        return image

    @property
    def length(self) -> Optional[int]:
        """How many images there will be; None when that is not known."""
        return self._frames.length

    @property
    def live(self) -> bool:
        """Whether frames are dropped that nobody has time for."""
        return self._frames.live
