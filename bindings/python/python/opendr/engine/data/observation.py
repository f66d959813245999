"""Observations, the inputs of policies."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, ClassVar, Optional, Union

from opendr.engine._arrays import array_of, as_array
from opendr.engine.data.data import Data

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import ArrayLike, NDArray


class Observation(Data):
    """An observation of an environment: a flat array, or several named arrays.

    Args:
        data: Numbers, or a dictionary of named arrays (Gymnasium's ``Dict`` space). All become float32; an array of
            several axes is flattened.

    Raises:
        TypeError: A value is not a number, or a name is not a str.
        ValueError: There is no element.
    """

    _fields: ClassVar[tuple[str, ...]] = ("data",)

    def __init__(self, data: Union[ArrayLike, Mapping[str, ArrayLike]]) -> None:
        super().__init__()
        self.data = data

    @property
    def data(self) -> Union[NDArray[np.float32], dict[str, NDArray[np.float32]]]:
        """The flat array, or the dictionary of parts."""
        data: Union[NDArray[np.float32], dict[str, NDArray[np.float32]]] = self._data
        return data

    @data.setter
    def data(self, data: Union[ArrayLike, Mapping[str, ArrayLike]]) -> None:
        if isinstance(data, Mapping):
            if not all(isinstance(name, str) for name in data):
                raise TypeError(f"the parts of an Observation are named by str, not by {list(data)}")
            checked: Any = {name: array_of(part, "float32", f"the part {name!r}") for name, part in data.items()}
            empty = sum(part.size for part in checked.values()) == 0
        else:
            checked = array_of(data, "float32", "an Observation").reshape(-1)
            empty = checked.size == 0
        if empty:
            raise ValueError("Observation is empty")
        self._data = checked

    @property
    def parts(self) -> dict[str, NDArray[np.float32]]:
        """The named parts; empty for an observation without parts."""
        return self._data if isinstance(self._data, dict) else {}

    def numpy(self) -> NDArray[np.float32]:
        """Returns a flat copy of all numbers, the input of a policy network."""
        import numpy as np

        if not isinstance(self._data, dict):
            return np.array(self._data)
        return np.concatenate([part.reshape(-1) for part in self._data.values()])

    def __array__(self, dtype: Any = None, copy: Optional[bool] = None) -> NDArray[Any]:
        return as_array(self.numpy(), dtype, None)

    def __str__(self) -> str:
        return str(self.data)
