"""What a policy sees."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, ClassVar, Optional, Union

from opendr.engine._arrays import array_of, as_array
from opendr.engine.data.data import Data

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import ArrayLike, NDArray


class Observation(Data):
    """What an agent sees of its world: numbers in a row, with names and shapes for its parts where it has several.

    Args:
        data: Numbers, or a dictionary of named arrays (Gymnasium's ``Dict`` space). All become float32; numbers of
            several axes are put in a row.

    Raises:
        TypeError: They are no numbers, or a name is no text.
        ValueError: There is no number.
    """

    _fields: ClassVar[tuple[str, ...]] = ("data",)

    def __init__(self, data: Union[ArrayLike, Mapping[str, ArrayLike]]) -> None:
        super().__init__()
        self.data = data

    @property
    def data(self) -> Union[NDArray[np.float32], dict[str, NDArray[np.float32]]]:
        """The numbers in a row, or the dictionary of parts."""
        data: Union[NDArray[np.float32], dict[str, NDArray[np.float32]]] = self._data
        return data

    @data.setter
    def data(self, data: Union[ArrayLike, Mapping[str, ArrayLike]]) -> None:
        if isinstance(data, Mapping):
            if not all(isinstance(name, str) for name in data):
                raise TypeError(f"the parts of an Observation are named by texts, not by {list(data)}")
            seen: Any = {name: array_of(part, "float32", f"the part {name!r}") for name, part in data.items()}
            empty = sum(part.size for part in seen.values()) == 0
        else:
            seen = array_of(data, "float32", "an Observation").reshape(-1)
            empty = seen.size == 0
        if empty:
            raise ValueError("Observation is empty")
        self._data = seen

    @property
    def parts(self) -> dict[str, NDArray[np.float32]]:
        """The named parts; empty for an observation without parts."""
        return self._data if isinstance(self._data, dict) else {}

    def numpy(self) -> NDArray[np.float32]:
        """A copy of all numbers in a row: what a policy network takes."""
        import numpy as np

        if not isinstance(self._data, dict):
            return np.array(self._data)
        return np.concatenate([part.reshape(-1) for part in self._data.values()])

    def __array__(self, dtype: Any = None, copy: Optional[bool] = None) -> NDArray[Any]:
        return as_array(self.numpy(), dtype, None)

    def __str__(self) -> str:
        return str(self.data)
