"""Data that are one array."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, ClassVar, Optional

from opendr.engine._arrays import array_of, as_array, dlpack
from opendr.engine.data.data import Data

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray


class ArrayData(Data):
    """Data that are one array, float32 unless the class says otherwise.

    An array of the right type is referenced, not copied: later changes of it take effect. ``data`` is this array,
    ``numpy()`` a copy; ``numpy.asarray(datum)`` and ``numpy.from_dlpack(datum)`` do not copy.

    Args:
        data: Numbers with the axes of the class; None leaves it empty until ``data`` is set.

    Raises:
        TypeError: The data are not numbers.
        ValueError: The axes are others, or there is no element.
    """

    _axes: ClassVar[tuple[str, ...]] = ()
    #: OpenDR's name of the class in messages, where it differs.
    _title: ClassVar[str] = ""
    _fields: ClassVar[tuple[str, ...]] = ("data",)

    def __init__(self, data: Optional[ArrayLike] = None) -> None:
        super().__init__()
        if data is not None:
            self.data = data

    @property
    def data(self) -> NDArray[Any]:
        """The array itself, in OpenDR's layout.

        Raises:
            ValueError: No data are set.
        """
        if self._data is None:
            raise ValueError(f"{self._title or type(self).__name__} is empty")
        data: NDArray[Any] = self._data
        return data

    @data.setter
    def data(self, data: ArrayLike) -> None:
        self._data = self._checked(data)

    def numpy(self) -> NDArray[Any]:
        """Returns a row-major copy of the array."""
        return self.data.copy("C")

    def __str__(self) -> str:
        return str(self.data)

    def _field(self, name: str) -> Any:
        try:
            return super()._field(name)
        except ValueError:
            # An empty datum can be compared and printed, although its data cannot be read.
            return None

    def __array__(self, dtype: Any = None, copy: Optional[bool] = None) -> NDArray[Any]:
        return as_array(self.data, dtype, copy)

    def __dlpack__(self, **options: Any) -> Any:
        return dlpack(self.data, **options)

    def __dlpack_device__(self) -> tuple[Any, Any]:
        return self.data.__dlpack_device__()

    def _checked(self, data: ArrayLike) -> NDArray[Any]:
        array = array_of(data, "float32", type(self).__name__)
        if array.ndim != len(self._axes) or array.size == 0:
            raise ValueError(
                f"a {type(self).__name__} of shape {array.shape} should have the axes [{', '.join(self._axes)}], "
                "each of at least one element"
            )
        return array
