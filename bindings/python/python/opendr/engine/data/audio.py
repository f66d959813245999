"""Audio."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, ClassVar, SupportsIndex

from opendr.engine._arrays import array_of
from opendr.engine._checks import whole
from opendr.engine.data.array_data import ArrayData

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import ArrayLike, NDArray


class Audio(ArrayData):
    """Audio ``[time, channels]``, float32, each sample in [-1, 1]. ``len`` and ``[]`` refer to time.

    Args:
        data: Samples ``[time, channels]``, or ``[time]`` of one channel. PCM of int16 or uint8 is scaled to [-1, 1].
        sample_rate: Sample rate in hertz.

    Raises:
        TypeError: The samples are not numbers, or integers of another type than PCM's.
        ValueError: The axes are others, there is no sample, or the rate is below 1.
    """

    _axes: ClassVar[tuple[str, ...]] = ("time", "channels")
    _fields: ClassVar[tuple[str, ...]] = ("data", "sample_rate")

    def __init__(self, data: ArrayLike, sample_rate: SupportsIndex) -> None:
        self.sample_rate: int = whole(sample_rate, "sample_rate")
        if self.sample_rate < 1:
            raise ValueError(f"sample_rate is {self.sample_rate}; give samples per second, e.g. 16000")
        super().__init__()
        self.data = data

    @property
    def channels(self) -> int:
        """Number of channels."""
        return int(self.data.shape[1])

    @property
    def duration_s(self) -> float:
        """Length in seconds."""
        return len(self) / self.sample_rate

    def mono(self) -> NDArray[np.float32]:
        """Returns the mean of the channels, ``[time]``."""
        mean: NDArray[np.float32] = self.data.mean(axis=1)
        return mean

    def __len__(self) -> int:
        return len(self.data)

    def __getitem__(self, time: int) -> NDArray[Any]:
        return self.data[time]  # type: ignore[no-any-return]

    def _checked(self, data: ArrayLike) -> NDArray[Any]:
        samples = array_of(data, None, "Audio")
        if samples.dtype == "int16":
            samples = samples.astype("float32") / 32768.0
        elif samples.dtype == "uint8":
            samples = (samples.astype("float32") - 128.0) / 128.0
        elif samples.dtype.kind != "f":
            raise TypeError(f"samples of {samples.dtype} are not PCM; give int16, uint8, or floats in [-1, 1]")
        return super()._checked(samples[:, None] if samples.ndim == 1 else samples)
