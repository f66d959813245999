"""The base class of data and targets: time stamp, frame id, equality by value."""

from __future__ import annotations

from typing import Any, ClassVar, Optional

from opendr.engine._equality import equal, is_array


class Datum:
    """A value of a data or target type, with its time stamp and coordinate frame.

    Two of them are equal when they are of one class and all their fields are equal. They are mutable and not hashable.
    They can be pickled and copied.
    """

    #: Nanoseconds since the Unix epoch, or since the start of a recording; None when unknown.
    timestamp: Optional[int] = None
    #: The coordinate frame (ROS's ``frame_id``, e.g. ``"camera_link"``); empty when unknown.
    frame_id: str = ""

    _fields: ClassVar[tuple[str, ...]] = ()
    _header: ClassVar[tuple[str, ...]] = ("timestamp", "frame_id", "action")

    def __eq__(self, other: object) -> bool:
        if type(other) is not type(self):
            return NotImplemented
        fields = self._fields + self._header
        return all(equal(self._field(field), other._field(field)) for field in fields)

    __hash__ = None  # type: ignore[assignment]

    def __repr__(self) -> str:
        header = [field for field in self._header if self._field(field) not in (None, "")]
        fields = (f"{field}={_repr(self._field(field))}" for field in (*self._fields, *header))
        return f"{type(self).__name__}({', '.join(fields)})"

    def _field(self, name: str) -> Any:
        """Returns a field for comparison and ``repr``."""
        return getattr(self, name, None)


def _repr(value: Any) -> str:
    if not is_array(value):
        return repr(value)
    if value.size <= 16:
        return repr(value.tolist())
    return f"<{value.dtype} {'x'.join(map(str, value.shape))}>"
