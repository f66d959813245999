"""Time series."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, ClassVar

from opendr.engine.data.array_data import ArrayData

if TYPE_CHECKING:
    from numpy.typing import NDArray


class Timeseries(ArrayData):
    """A time series ``[time, features]``, float32. ``len`` and ``[]`` refer to time."""

    _axes: ClassVar[tuple[str, ...]] = ("time", "features")

    def __len__(self) -> int:
        return len(self.data)

    def __getitem__(self, time: int) -> NDArray[Any]:
        return self.data[time]  # type: ignore[no-any-return]
