"""Progress of an inference over many inputs, as a line on the terminal."""

from __future__ import annotations

import os
import sys
import time
from collections.abc import Iterator
from typing import IO, Any, Optional, TypeVar

T = TypeVar("T")

#: Seconds after which the progress of an iteration of unknown length is shown.
_DELAY = 2.0
_BAR = 30
#: Erases the line to its end.
_ERASE = "\r\x1b[K"


def with_progress(predictions: Iterator[T], what: str, total: Optional[int]) -> Iterator[T]:
    """Returns an iterator over ``predictions`` that shows their count and rate, and the remaining time where ``total`` is known, on
    standard error if that is a terminal.

    An iteration of unknown length shows it after two seconds. The line is there while a prediction is computed, and erased before the
    caller receives it, so that what the caller prints does not mix with it.
    """
    terminal = sys.stderr
    # It may be None, or an object of the program.
    is_terminal = getattr(terminal, "isatty", None)
    if is_terminal is None or not is_terminal() or total is not None and total < 2:
        return predictions
    return _shown(predictions, _Line(terminal, what, total))


def _shown(predictions: Iterator[T], line: _Line) -> Iterator[T]:
    while True:
        line.draw()
        try:
            prediction = next(predictions)
        except StopIteration:
            return
        finally:
            line.erase()
        line.done += 1
        yield prediction


class _Line:
    """A line on a terminal."""

    def __init__(self, terminal: IO[str], what: str, total: Optional[int]) -> None:
        self.done = 0
        self._terminal = terminal
        self._what = what
        self._total = total
        self._begun: Optional[float] = None
        self._is_drawn = False

    def draw(self) -> None:
        now = time.monotonic()
        if self._begun is None:
            self._begun = now
        elapsed = now - self._begun
        if self._total is not None or elapsed >= _DELAY:
            self._terminal.write(f"{_ERASE}{self._text(elapsed)[: _width(self._terminal) - 1]}")
            self._terminal.flush()
            self._is_drawn = True

    def erase(self) -> None:
        if self._is_drawn:
            self._terminal.write(_ERASE)
            self._terminal.flush()
            self._is_drawn = False

    def _text(self, elapsed: float) -> str:
        rate = f" {self.done / elapsed:.1f}/s" if self.done and elapsed > 0.0 else ""
        if self._total is None:
            return f"{self._what} {self.done}{rate}"
        filled = min(_BAR * self.done // self._total, _BAR)
        left = elapsed / self.done * max(self._total - self.done, 0) if self.done else None
        remaining = "" if left is None else f" ETA {int(left) // 60}:{int(left) % 60:02}"
        return f"{self._what} [{'#' * filled}{'-' * (_BAR - filled)}] {self.done}/{self._total}{rate}{remaining}"


def _width(terminal: Any) -> int:
    """Returns the number of columns of a terminal."""
    try:
        columns = os.get_terminal_size(terminal.fileno()).columns
    except (OSError, ValueError):
        columns = 0
    return columns or 80
