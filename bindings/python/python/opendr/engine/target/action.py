"""Actions of active perception: the movement of the robot to a better view."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterator, Sequence

from opendr.engine._checks import Real, real


class ActionBase(ABC):
    """Base class of the actions of targets."""

    @property
    @abstractmethod
    def axes(self) -> tuple[float, ...]:
        """The deflection of each axis, each in [-1, 1]; 1 to 4 axes."""


class Action(ActionBase):
    """A movement on a sphere around the observed object.

    Axis 0 is azimuth, 1 elevation, 2 distance (positive is closer), 3 roll or zoom. Movements are relative; 1 is the full
    step of the rig.

    Args:
        axes: 1 to 4 numbers, each in [-1, 1].

    Raises:
        TypeError: An axis is not a number.
        ValueError: There are no axes or more than 4, or one is out of range or NaN.
    """

    def __init__(self, axes: Sequence[Real]) -> None:
        try:
            checked = tuple(real(axis, "an axis") for axis in axes)
        except TypeError:
            raise TypeError(f"an action is a list of 1 to 4 numbers in [-1, 1], not {axes!r}") from None
        if not 1 <= len(checked) <= 4 or any(abs(axis) > 1.0 for axis in checked):
            raise ValueError(
                f"an action has 1 to 4 axes, each in [-1, 1], not {list(checked)}; scale it to the rig's step"
            )
        self._axes = checked

    @property
    def axes(self) -> tuple[float, ...]:
        return self._axes

    def __len__(self) -> int:
        return len(self._axes)

    def __getitem__(self, axis: int) -> float:
        return self._axes[axis]

    def __iter__(self) -> Iterator[float]:
        return iter(self._axes)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Action) and self._axes == other._axes

    def __hash__(self) -> int:
        return hash(self._axes)

    def __str__(self) -> str:
        return f"Action {list(self._axes)}"

    def __repr__(self) -> str:
        return f"Action({list(self._axes)})"
