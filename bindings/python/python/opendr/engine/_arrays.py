"""Conversion of values to arrays, and the interfaces of NumPy and DLPack."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Optional

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, DTypeLike, NDArray


def array_of(data: ArrayLike, dtype: Optional[DTypeLike], what: str) -> NDArray[Any]:
    """Returns ``data`` as an array of ``dtype`` (of its own type when None), without a copy where possible.

    Raises:
        TypeError: They are not numbers.
        ValueError: They are lists of different lengths.
    """
    import numpy as np

    try:
        array = np.asarray(data)
    except (TypeError, ValueError) as error:
        kind = TypeError if isinstance(error, TypeError) else ValueError
        raise kind(f"{what} should be an array of numbers, not {data!r:.200}: {error}") from error
    if array.dtype.kind not in "biuf":
        raise TypeError(f"{what} should be an array of numbers, not of {array.dtype}: {data!r:.200}")
    return array if dtype is None else array.astype(dtype, copy=False)


def as_array(array: NDArray[Any], dtype: Any, copy: Optional[bool]) -> NDArray[Any]:
    """Returns the result of ``__array__``: the array itself where type and ``copy`` allow it."""
    import numpy as np

    if copy is None:
        return np.asarray(array, dtype=dtype)
    return np.array(array, dtype=dtype, copy=copy)


def dlpack(array: NDArray[Any], **options: Any) -> Any:
    """Returns the result of ``__dlpack__``. Arrays with negative strides, which consumers do not support, and read-only
    arrays, which NumPy does not export, are copied."""
    import numpy as np

    if any(stride < 0 for stride in array.strides) or not array.flags.writeable:
        array = np.array(array, order="C")
    return array.__dlpack__(**options)
