"""What data and targets have in common: a time stamp, a frame, equality by value."""

from __future__ import annotations

from typing import Any, ClassVar, Optional

from opendr.engine._equality import equal, is_array


class Datum:
    """Anything that was measured or found, with the time and the coordinate frame it belongs to.

    Two of them are equal when they are of one class and all their fields are equal. They can be changed, so they
    cannot be hashed. They can be pickled and copied.
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
        shown = (f"{field}={_shown(self._field(field))}" for field in (*self._fields, *header))
        return f"{type(self).__name__}({', '.join(shown)})"

    def _field(self, name: str) -> Any:
        """A field as it is compared and shown."""
        return getattr(self, name, None)


def _shown(value: Any) -> str:
    if not is_array(value):
        return repr(value)
    if value.size <= 16:
        return repr(value.tolist())
    return f"<{value.dtype} {'x'.join(map(str, value.shape))}>"
