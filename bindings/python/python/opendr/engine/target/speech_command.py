"""Spoken commands."""

from __future__ import annotations

from collections.abc import Sequence
from typing import ClassVar, Optional, SupportsIndex, Union

from opendr.engine._checks import Real, class_name_or_index, real, reals
from opendr.engine.target._table import Column, Table, floats
from opendr.engine.target.base_target import Target


class SpeechCommand(Target):
    """A recognised spoken command; ``data`` is the same as ``command``.

    Args:
        command: Class index, or word.
        confidence: Score in [0, 1].
        span_s: Start and end within the audio, seconds; None when unknown.

    Raises:
        TypeError: The command is neither int nor str, or a value is not a number.
        ValueError: A number is not finite.
    """

    _fields: ClassVar[tuple[str, ...]] = ("command", "confidence", "span_s")

    def __init__(
        self,
        command: Union[int, str, SupportsIndex],
        confidence: Real = 0,
        span_s: Optional[Sequence[Real]] = None,
    ) -> None:
        self.data = command
        self.confidence = real(confidence, "confidence")
        self.span_s: Optional[tuple[float, ...]] = None if span_s is None else reals(span_s, 2, "span_s")

    @property
    def data(self) -> Union[int, str]:
        """Class index, or word."""
        data: Union[int, str] = self._data
        return data

    @data.setter
    def data(self, data: Union[int, str, SupportsIndex]) -> None:
        self._data = class_name_or_index(data)

    @property
    def command(self) -> Union[int, str]:
        """Class index, or word."""
        return self.data

    def _table(self) -> Table:
        start, end = self.span_s or (None, None)
        return {
            "command": Column([self.command], None),
            "confidence": floats([self.confidence]),
            "start_s": floats([start]),
            "end_s": floats([end]),
        }
