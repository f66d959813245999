"""Data sets of several parts, and paths in them that are not to be trusted."""

from __future__ import annotations

import os
from bisect import bisect_right
from collections.abc import Sequence
from itertools import accumulate
from typing import Any

from opendr._errors import FormatError
from opendr.engine._checks import whole
from opendr.engine.datasets import DatasetIterator


class Parts(DatasetIterator):
    """Data sets one after the other.

    Args:
        datasets: The data sets; those that name their classes name the same.

    Raises:
        ValueError: Their classes differ.
    """

    def __init__(self, datasets: Sequence[Any]) -> None:
        self.datasets = list(datasets)
        named = [list(classes) for classes in (getattr(part, "classes", []) for part in self.datasets) if classes]
        if any(classes != named[0] for classes in named):
            raise ValueError(f"data sets of different classes cannot be one: {named}")
        self.classes: list[str] = named[0] if named else []
        self._ends = list(accumulate(len(part) for part in self.datasets))

    def place(self, idx: int) -> tuple[Any, int]:
        """The data set that a sample is in, and its number there.

        Raises:
            IndexError: There is none.
        """
        index = whole(idx, "the number of a sample")
        index += len(self) if index < 0 else 0
        if not 0 <= index < len(self):
            raise IndexError(f"there is no sample {idx} among {len(self)}")
        part = bisect_right(self._ends, index)
        return self.datasets[part], index - (self._ends[part - 1] if part else 0)

    def __getitem__(self, idx: int) -> Any:
        part, index = self.place(idx)
        return part[index]

    def __len__(self) -> int:
        return self._ends[-1] if self._ends else 0


def inside(folder: str, name: str) -> str:
    """The path of a file that a list or an annotation names.

    Raises:
        opendr.FormatError: It leads out of the folder.
    """
    parts = name.replace("\\", "/").split("/")
    if not name or os.path.isabs(name) or ".." in parts or ":" in parts[0] or "\0" in name:
        raise FormatError(f"{name!r:.200} leads out of {folder}")
    return os.path.join(folder, *parts)


def numbers(line: str, count: int, place: str) -> list[float]:
    """The first ``count`` numbers of a line.

    Raises:
        opendr.FormatError: There are fewer, or one is none.
    """
    try:
        found = [float(word) for word in line.replace(",", " ").split()[:count]]
    except ValueError:
        found = []
    if len(found) < count or any(number - number != 0.0 for number in found):
        raise FormatError(f"{place}: {count} numbers are wanted, not {line.strip()!r:.200}")
    return found
