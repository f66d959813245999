"""The base class of data."""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import TYPE_CHECKING, Any

from opendr.engine._datum import Datum

if TYPE_CHECKING:
    from numpy.typing import NDArray


class Data(Datum, ABC):
    """Base class of the inputs of learners.

    Predictions inherit ``timestamp`` (nanoseconds, or None) and ``frame_id``.
    """

    _data: Any

    def __init__(self, data: Any = None) -> None:
        self._data = data

    @property
    def data(self) -> Any:
        """The data in OpenDR's layout."""
        return self._data

    @data.setter
    def data(self, data: Any) -> None:
        self._data = data

    @abstractmethod
    def numpy(self) -> NDArray[Any]:
        """Returns a copy of the data as a NumPy array."""

    @abstractmethod
    def __str__(self) -> str:
        """OpenDR's text."""
