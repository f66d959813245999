"""Keypoints in an image."""

from __future__ import annotations

import json
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Any, ClassVar, Optional, Union

from opendr.engine._checks import Real, real, reals
from opendr.engine.target._table import Table, floats
from opendr.engine.target.base_target import Target

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray


class Keypoint(Target):
    """A point in an image: ``x`` and ``y`` in pixels from the top-left corner; (-1, -1) means not detected.

    ``point.x``, ``point[0]`` and ``point["x"]`` are the same; ``x, y = point`` works too.

    Args:
        keypoint: ``[x, y]``.
        confidence: Score in [0, 1], or None.

    Raises:
        TypeError: A coordinate is not a number.
        ValueError: There are not two coordinates, or one is not finite.
    """

    _fields: ClassVar[tuple[str, ...]] = ("data", "confidence")

    def __init__(self, keypoint: Sequence[Real], confidence: Optional[Real] = None) -> None:
        self.data = keypoint
        self._confidence = None if confidence is None else real(confidence, "confidence")

    @property
    def data(self) -> list[float]:
        """``[x, y]``, pixels."""
        return [self.x, self.y]

    @data.setter
    def data(self, data: Sequence[Real]) -> None:
        self.x, self.y = reals(data, 2, "a keypoint")

    def __len__(self) -> int:
        return 2

    def __iter__(self) -> Iterator[float]:
        return iter((self.x, self.y))

    def __getitem__(self, key: Union[int, str]) -> float:
        if key == "x" or key == "y":
            return self.x if key == "x" else self.y
        if isinstance(key, int) and -2 <= key < 2:
            return (self.x, self.y)[key]
        # `for` loops and unpacking end at an IndexError.
        error = IndexError if isinstance(key, int) else ValueError
        raise error(f"a keypoint has the keys 0, 1, 'x' and 'y', not {key!r}")

    def __array__(self, dtype: Any = None, copy: Optional[bool] = None) -> NDArray[Any]:
        import numpy as np

        return np.array([self.x, self.y], dtype=dtype or np.float32)

    def __str__(self) -> str:
        return str(self.data)

    def to_json(self) -> str:
        """Returns the JSON of the point in a pose (``docs/json.md``); a missing confidence becomes 0."""
        return json.dumps({"x": self.x, "y": self.y, "confidence": self.confidence or 0.0}, separators=(",", ":"))

    @classmethod
    def from_json(cls, text: Union[str, bytes]) -> Keypoint:
        """Reads a point from the JSON of :meth:`to_json`.

        Raises:
            ValueError: The text is not the JSON of a point.
        """
        fields = json.loads(text)
        if not isinstance(fields, dict) or not {"x", "y"} <= fields.keys():
            raise ValueError(f'a keypoint is {{"x": ..., "y": ...}}, not {text!r:.200}')
        return cls([fields["x"], fields["y"]], fields.get("confidence"))

    def numpy(self) -> NDArray[np.float32]:
        """Returns ``[x, y]`` as a float32 array."""
        import numpy as np

        return np.array([self.x, self.y], dtype=np.float32)

    def _table(self) -> Table:
        return {"x": floats([self.x]), "y": floats([self.y]), "confidence": floats([self.confidence])}
