"""Images."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, Any, Optional, Union

from opendr import _opendr
from opendr.engine._arrays import array_of
from opendr.engine._image_reference import ImageFile
from opendr.engine.data.array_data import ArrayData

if TYPE_CHECKING:
    import PIL.Image
    from numpy.typing import ArrayLike, DTypeLike, NDArray

_DTYPES = ("uint8", "uint16", "float32")


class Image(ArrayData):
    """An image ``[channels, height, width]``: greyscale, RGB or RGBA.

    Samples are uint8 in [0, 255]; with ``dtype``, uint16 (depth in millimetres, thermal counts) or float32 (depth in
    metres, or colours in the range of their source).

    An array of the right type is referenced, not copied, in any layout: later changes of it take effect. ``data`` is
    this array, ``numpy()`` a copy.

    With ``guess_format``, the layout is guessed from the shape by OpenDR's rule:

    * last axis 3: ``[height, width, 3]`` in OpenCV's order **BGR**,
    * last axis smaller than both others: ``[height, width, channels]``, the channels in order,
    * everything else: ``[channels, height, width]``, RGB.

    A ``[3, height, 3]`` array, an image three pixels wide, is therefore taken for OpenCV's; pass ``guess_format=False``.

    Args:
        data: An array of 3 axes, or another :class:`Image`.
        dtype: uint8, uint16 or float32. Numbers of another type are converted when they are in range.
        guess_format: Whether to guess the layout; otherwise it is ``[channels, height, width]``, RGB.

    Raises:
        TypeError: The data are not numbers.
        ValueError: The data are None, have other axes, no pixel or not 1, 3 or 4 channels, or do not fit the type.
    """

    #: The image in native memory, until other data are set.
    _pixels: Any = None
    #: The file that the image was read from, until other data are set.
    _file: Optional[ImageFile] = None
    #: The type that new data are converted to; empty: that of the current data.
    _target_dtype: str = ""

    def __init__(
        self,
        data: Union[ArrayLike, Image, None] = None,
        dtype: Optional[DTypeLike] = None,
        guess_format: bool = True,
    ) -> None:
        if data is None:
            raise ValueError("Image is of type None")
        given = data if isinstance(data, Image) else None
        if given is not None:
            data, guess_format = given.data, False
            self.timestamp, self.frame_id = given.timestamp, given.frame_id
        self._target_dtype = _dtype(given.dtype if given is not None and dtype is None else dtype)
        super().__init__()
        self.data = _chw_from_guess(data) if guess_format else data

    @classmethod
    def open(cls, filename: Union[str, os.PathLike[str]]) -> Image:
        """Reads an image file (JPEG, PNG, BMP, WebP) and rotates it as its EXIF data require. The image is read-only; to
        change it, copy it: ``Image(image.numpy(), guess_format=False)``.

        Raises:
            FileNotFoundError: The file does not exist.
            ValueError: The file is not an image.
        """
        path = os.fspath(filename)
        if not os.path.exists(path):
            raise FileNotFoundError("The image file does not exist.")
        file = ImageFile.at(path)
        picture: Image = _opendr.open_value("Image", path)
        picture._file = file
        return picture

    @classmethod
    def from_pil(cls, picture: PIL.Image.Image) -> Image:
        """Converts an image of Pillow; other modes than L, RGB and RGBA become RGB."""
        import numpy as np

        picture = picture if picture.mode in ("L", "RGB", "RGBA") else picture.convert("RGB")
        array = np.asarray(picture)
        return cls(np.atleast_3d(array).transpose(2, 0, 1), guess_format=False)

    @property
    def data(self) -> NDArray[Any]:
        """The array itself, ``[channels, height, width]``.

        The array of an image that OpenDR itself read, captured or drew is in native memory and read-only.
        """
        if self._data is None and self._pixels is not None:
            import numpy as np

            self._data = np.asarray(self._pixels)
        return super().data

    @data.setter
    def data(self, data: ArrayLike) -> None:
        self._data, self._pixels, self._file = self._checked(data), None, None

    def __getstate__(self) -> dict[str, Any]:
        return {**self.__dict__, "_data": self.data, "_pixels": None, "_file": None}

    @property
    def dtype(self) -> Any:
        """The type of the samples."""
        return self.data.dtype

    @property
    def channels(self) -> int:
        """Number of channels: 1 (greyscale), 3 (RGB) or 4 (RGBA)."""
        return int(self.data.shape[0])

    @property
    def height(self) -> int:
        """Height in pixels."""
        return int(self.data.shape[1])

    @property
    def width(self) -> int:
        """Width in pixels."""
        return int(self.data.shape[2])

    def convert(self, format: str = "channels_first", channel_order: str = "rgb") -> NDArray[Any]:
        """Returns a copy of the image in another layout.

        Args:
            format: ``"channels_first"`` gives ``[channels, height, width]``, ``"channels_last"``
                ``[height, width, channels]``.
            channel_order: ``"rgb"`` or ``"bgr"``; the fourth channel stays last, greyscale stays greyscale.

        Raises:
            ValueError: An argument has another value.
        """
        if format not in ("channels_first", "channels_last"):
            raise ValueError(f"format should be 'channels_first' or 'channels_last', not {format!r}")
        if channel_order not in ("rgb", "bgr"):
            raise ValueError(f"channel_order should be 'rgb' or 'bgr', not {channel_order!r}")
        array = self.data
        if channel_order == "bgr" and self.channels > 1:
            array = array[[2, 1, 0, 3][: self.channels]]
        if format == "channels_last":
            array = array.transpose(1, 2, 0)
        return array.copy("C")

    def opencv(self) -> NDArray[Any]:
        """Returns a copy in OpenCV's layout: ``[height, width, channels]``, BGR (BGRA; one channel for greyscale)."""
        return self.convert("channels_last", "bgr")

    def save(self, path: Union[str, os.PathLike[str]]) -> None:
        """Writes the image in the format of the file's extension (``.jpg``, ``.png``, ...).

        Raises:
            opendr.Unsupported: The extension, or the sample type in this format, is not supported.
            OSError: The file cannot be written.
        """
        _opendr.save_image(self, os.fspath(path))

    def _repr_png_(self) -> Optional[bytes]:
        """Returns the image as a PNG file for a notebook; uint16 and float32 from their lowest (black) to their highest sample (white)."""
        try:
            return _opendr.png(self if self.dtype == "uint8" else Image(_scaled(self.data), guess_format=False))
        except Exception:  # The notebook shows the text.
            return None

    def to_pil(self) -> PIL.Image.Image:
        """Returns the image as one of Pillow; the samples must be uint8.

        Raises:
            ImportError: Pillow is not installed.
            ValueError: The samples are of another type.
        """
        try:
            import PIL.Image
        except ImportError as error:
            raise ImportError(f"to_pil() needs the package Pillow ({error}): pip install pillow") from error
        if self.dtype != "uint8":
            raise ValueError(f"Pillow takes images of uint8, not of {self.dtype}; scale the samples to [0, 255]")
        pixels = self.convert("channels_last")
        return PIL.Image.fromarray(pixels[:, :, 0] if self.channels == 1 else pixels)

    def _checked(self, data: ArrayLike) -> NDArray[Any]:
        array = array_of(data, None, "an Image")
        if array.ndim != 3:
            raise ValueError(
                f"3-dimensional images are expected, not of shape {array.shape}; give a grey image as array[None]"
            )
        if array.shape[0] not in (1, 3, 4) or array.size == 0:
            raise ValueError(
                f"an image of shape {array.shape} should be [channels, height, width] with 1, 3 or 4 channels and at "
                "least one pixel; transpose it, or let guess_format do so"
            )
        return _converted(array, self._target_dtype or self.dtype.name)


def _dtype(dtype: Optional[DTypeLike]) -> str:
    import numpy as np

    name = "uint8" if dtype is None else np.dtype(dtype).name
    if name not in _DTYPES:
        raise ValueError(f"an Image cannot have samples of {name}; give {', '.join(_DTYPES)}")
    return name


def _chw_from_guess(data: ArrayLike) -> NDArray[Any]:
    array = array_of(data, None, "an Image")
    if array.ndim != 3 or not (array.shape[2] == 3 or array.shape[2] < min(array.shape[:2])):
        return array
    if array.shape[2] == 3:
        array = array[:, :, ::-1]
    return array.transpose(2, 0, 1)


def _scaled(array: NDArray[Any]) -> NDArray[Any]:
    """Returns samples as uint8, scaled from their finite range; others are 0."""
    import numpy as np

    finite = np.isfinite(array)
    low, high = (float(array[finite].min()), float(array[finite].max())) if finite.any() else (0.0, 0.0)
    scaled = (np.where(finite, array, low) - low) * (255.0 / (high - low) if high > low else 0.0)
    return np.round(scaled).astype("uint8")


def _converted(array: NDArray[Any], dtype: str) -> NDArray[Any]:
    if array.dtype == dtype:
        return array
    if dtype != "float32" and array.dtype.kind != "b":
        low, high, limit = array.min(), array.max(), 255 if dtype == "uint8" else 65535
        if not (low >= 0 and high <= limit):
            raise ValueError(
                f"samples from {low} to {high} do not fit {dtype}; scale them to [0, {limit}], or pass dtype='float32'"
            )
    return array.astype(dtype)
