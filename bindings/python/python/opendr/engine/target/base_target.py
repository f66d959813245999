"""Base classes of targets."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, ClassVar, Optional, TypeVar, Union

from opendr import _opendr
from opendr.engine._datum import Datum
from opendr.engine.target.action import Action, ActionBase

Self = TypeVar("Self", bound="BaseTarget")
T = TypeVar("T", bound="BaseTarget")


class BaseTarget(Datum):
    """Base class of annotations and predictions.

    Types that are only annotations inherit from this class and not from :class:`Target`.
    """

    def __str__(self) -> str:
        """OpenDR's text."""
        return _opendr.text(self)

    def to_json(self) -> str:
        """Returns the target as one JSON object (``docs/json.md``), the same on every surface.

        A single box, track or pose is written as a list of one.
        """
        return _opendr.json(self._as_value())

    @classmethod
    def from_json(cls: type[Self], text: Union[str, bytes]) -> Self:
        """Reads a target from the JSON of :meth:`to_json`.

        Raises:
            ValueError: The text is not the JSON of a target.
            TypeError: The target is of another class.
        """
        value = cls._from_value(_opendr.value_from_json(text.decode() if isinstance(text, bytes) else text))
        if not isinstance(value, cls):
            raise TypeError(f"the JSON is of a {type(value).__name__}, not of a {cls.__name__}; read it as that")
        return value

    #: The list class in which a single item is written.
    _list: ClassVar[Optional[type[Any]]] = None

    def _as_value(self) -> BaseTarget:
        """Returns the target that can be written as JSON: this one, or a list of only it."""
        return self if self._list is None else self._with_header_in(self._list([self]))

    @classmethod
    def _from_value(cls, value: Any) -> Any:
        """Inverts :meth:`_as_value`."""
        is_item = cls._list is not None and type(value) is cls._list and len(value) == 1
        return value._with_header_in(value[0]) if is_item else value

    def _with_header_in(self, other: T) -> T:
        """Returns ``other`` with this target's time stamp, frame id and action."""
        for name in self._header:
            setattr(other, name, getattr(self, name, None))
        return other


class Target(BaseTarget):
    """Base class of types that are both annotations and predictions."""

    _data: Any = None
    _confidence: Any = None
    _action: Optional[ActionBase] = None
    _fields: ClassVar[tuple[str, ...]] = ("data", "confidence")

    @property
    def data(self) -> Any:
        """Content of the target; its type depends on the class."""
        return self._data

    @data.setter
    def data(self, data: Any) -> None:
        self._data = data

    @property
    def confidence(self) -> Any:
        """Score in [0, 1], or None."""
        return self._confidence

    @confidence.setter
    def confidence(self, confidence: Any) -> None:
        self._confidence = confidence

    @property
    def action(self) -> Optional[ActionBase]:
        """Movement of the robot to a better view; None where the learner predicts none."""
        return self._action

    @action.setter
    def action(self, action: Union[ActionBase, Sequence[float], None]) -> None:
        self._action = action if action is None or isinstance(action, ActionBase) else Action(action)
