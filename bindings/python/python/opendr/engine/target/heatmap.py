"""Maps of class indices or scores."""

from __future__ import annotations

from collections.abc import Hashable
from typing import TYPE_CHECKING, Any, ClassVar, Optional

from opendr.engine._checks import text
from opendr.engine._equality import is_array
from opendr.engine.target._table import Column, Table, floats, ints, texts
from opendr.engine.target.base_target import Target

if TYPE_CHECKING:
    import supervision
    from numpy.typing import NDArray


class Heatmap(Target):
    """A map of class indices (``[height, width]``) or of scores (any shape, e.g. ``[classes, height, width]``).

    Args:
        data: An array of 1 to 8 axes: non-negative integers are class or instance indices, floats are scores. The type
            is kept.
        class_names: Names of the class indices.

    Raises:
        TypeError: ``data`` is not a NumPy array of numbers, or ``class_names`` is not a dictionary of str.
        ValueError: ``data`` has no axis or more than 8, or a class index is below 0.
    """

    _fields: ClassVar[tuple[str, ...]] = ("data", "class_names")

    def __init__(self, data: NDArray[Any], class_names: Optional[dict[Any, str]] = None) -> None:
        self.data = data
        self.class_names = class_names

    @property
    def data(self) -> NDArray[Any]:
        """The array."""
        data: NDArray[Any] = self._data
        return data

    @data.setter
    def data(self, data: NDArray[Any]) -> None:
        if not is_array(data) or data.dtype.kind not in "biuf":
            raise TypeError(f"a Heatmap needs a NumPy array of numbers, not {data!r:.200}")
        if not 1 <= data.ndim <= 8:
            raise ValueError(f"the Heatmap has {data.ndim} axes; give 1 to 8")
        if data.dtype.kind == "i" and data.size and int(data.min()) < 0:
            raise ValueError(f"the Heatmap has the class index {data.min()}; give indices from 0, or scores as floats")
        self._data = data

    @property
    def class_names(self) -> Optional[dict[Any, str]]:
        """Names of the class indices; None when they have no names."""
        return self._class_names

    @class_names.setter
    def class_names(self, class_names: Optional[dict[Hashable, str]]) -> None:
        if class_names is not None:
            if not isinstance(class_names, dict):
                raise TypeError(f"class_names should be a dictionary, e.g. {{0: 'road'}}, not {class_names!r:.200}")
            for name in class_names.values():
                text(name, "a name in class_names")
        self._class_names = class_names

    def numpy(self) -> NDArray[Any]:
        """Returns a copy of the array."""
        return self.data.copy()

    def opencv(self) -> NDArray[Any]:
        """Returns a copy of the array, whose layout is also OpenCV's."""
        return self.data.copy()

    def shape(self) -> tuple[int, ...]:
        """Returns the length of each axis."""
        return self.data.shape

    def __array__(self, dtype: Any = None, copy: Optional[bool] = None) -> NDArray[Any]:
        from opendr.engine._arrays import as_array

        return as_array(self.data, dtype, copy)

    def to_supervision(self) -> supervision.Detections:
        """Returns the classes in a map of class indices as ``supervision.Detections`` with their masks, in the order of the class
        indices; ``confidence`` is None. Class 0 is left out where it is called ``background`` or has no name, as in drawings.

        Raises:
            ImportError: The package supervision is not installed.
            opendr.Unsupported: The map has scores, or another shape than ``[height, width]``.
        """
        from opendr.engine.target._supervision import class_masks

        return class_masks(self)

    def label_of(self, index: int) -> str:
        """Returns the name of a class index, or the index as a text where it has no name."""
        return (self.class_names or {}).get(index) or str(index)

    def _is_map_of_classes(self) -> bool:
        """Returns whether the data are ``[height, width]`` class indices."""
        return self.data.ndim == 2 and self.data.dtype.kind != "f"

    def _is_drawn(self) -> bool:
        is_scores = self.data.dtype.kind == "f" and self.data.ndim in (2, 3)
        return self.data.size > 0 and (is_scores or self._is_map_of_classes())

    def _table(self) -> Optional[Table]:
        if self.data.ndim == 1:
            return {"index": ints(range(len(self.data))), "value": Column(list(self.data))}
        if not self._is_map_of_classes():
            return None
        import numpy as np

        indices, counts = np.unique(self.data, return_counts=True)
        return {
            "name": ints(indices.tolist()),
            "class_name": texts(self.label_of(index) for index in indices.tolist()),
            "pixels": ints(counts.tolist()),
            "share": floats(count / self.data.size for count in counts.tolist()),
        }
