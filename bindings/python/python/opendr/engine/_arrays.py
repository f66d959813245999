"""Arrays on their way into our objects, and how they show themselves to NumPy and DLPack."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Optional

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, DTypeLike, NDArray


def array_of(data: ArrayLike, dtype: Optional[DTypeLike], what: str) -> NDArray[Any]:
    """``data`` as an array of ``dtype`` (of its own type when None), not copied where it is one.

    Raises:
        TypeError: They are no numbers.
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
    """What ``__array__`` gives: the array itself where type and ``copy`` allow."""
    import numpy as np

    if copy is None:
        return np.asarray(array, dtype=dtype)
    return np.array(array, dtype=dtype, copy=copy)


def dlpack(array: NDArray[Any], **options: Any) -> Any:
    """What ``__dlpack__`` gives. Consumers know no negative strides, and NumPy lends no memory that may not be
    written: such arrays are copied."""
    import numpy as np

    if any(stride < 0 for stride in array.strides) or not array.flags.writeable:
        array = np.array(array, order="C")
    return array.__dlpack__(**options)
