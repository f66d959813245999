"""Actions of policies."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, ClassVar, Optional

from opendr.engine._arrays import array_of
from opendr.engine.target._table import Column, Table, ints
from opendr.engine.target.base_target import Target

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import ArrayLike, DTypeLike, NDArray


class RlTarget(Target):
    """The action of a policy: an element of its action space; ``data`` is a flat array, float32.

    It converts to an array of NumPy, and to a number where it has only one: ``env.step(int(target))`` for ``Discrete``.

    Args:
        values: The numbers, in the order of the action space.

    Raises:
        TypeError: A value is not a number.
    """

    _fields: ClassVar[tuple[str, ...]] = ("data",)

    def __init__(self, values: ArrayLike) -> None:
        self.data = values

    @property
    def data(self) -> NDArray[np.float32]:
        """The numbers, in the order of the action space."""
        data: NDArray[np.float32] = self._data
        return data

    @data.setter
    def data(self, data: ArrayLike) -> None:
        self._data = array_of(data, "float32", "an RlTarget").reshape(-1)

    def __array__(self, dtype: Optional[DTypeLike] = None, copy: Optional[bool] = None) -> NDArray[Any]:
        return self.data.astype(dtype or self.data.dtype, copy=bool(copy))

    def __len__(self) -> int:
        return len(self.data)

    def __int__(self) -> int:
        return int(self.data.item())

    def __index__(self) -> int:
        return int(self)

    def __float__(self) -> float:
        return float(self.data.item())

    def _table(self) -> Table:
        return {"index": ints(range(len(self))), "value": Column(list(self.data), "float32")}
