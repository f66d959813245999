"""How arrays inside our objects show themselves to NumPy and to DLPack."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Optional

if TYPE_CHECKING:
    from numpy.typing import NDArray


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
