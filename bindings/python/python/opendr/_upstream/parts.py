"""Concatenated data sets, and checks of untrusted paths and numbers in their files."""

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
    """The concatenation of data sets.

    Args:
        datasets: The data sets; those with class names have the same ones.

    Raises:
        ValueError: Their classes differ.
    """

    def __init__(self, datasets: Sequence[Any]) -> None:
        self.datasets = list(datasets)
        named = [list(classes) for classes in (getattr(part, "classes", []) for part in self.datasets) if classes]
        if any(classes != named[0] for classes in named):
            raise ValueError(f"data sets with different classes cannot be concatenated: {named}")
        self.classes: list[str] = named[0] if named else []
        self._ends = list(accumulate(len(part) for part in self.datasets))

    def place(self, idx: int) -> tuple[Any, int]:
        """Returns the data set of a sample, and its index there.

        Raises:
            IndexError: The index is out of range.
        """
        index = whole(idx, "the index of a sample")
        index += len(self) if index < 0 else 0
        if not 0 <= index < len(self):
            raise IndexError(f"sample index {idx} is out of range; the data set has {len(self)} samples")
        part = bisect_right(self._ends, index)
        return self.datasets[part], index - (self._ends[part - 1] if part else 0)

    def __getitem__(self, idx: int) -> Any:
        part, index = self.place(idx)
        return part[index]

    def __len__(self) -> int:
        return self._ends[-1] if self._ends else 0


def inside(folder: str, name: str) -> str:
    """Returns the path of a file named in a list or an annotation.

    Raises:
        opendr.FormatError: The path is outside the folder.
    """
    parts = name.replace("\\", "/").split("/")
    if not name or os.path.isabs(name) or ".." in parts or ":" in parts[0] or "\0" in name:
        raise FormatError(f"{name!r:.200} is outside {folder}")
    return os.path.join(folder, *parts)


def numbers(line: str, count: int, place: str) -> list[float]:
    """Returns the first ``count`` numbers of a line.

    Raises:
        opendr.FormatError: There are fewer, or one is not a finite number.
    """
    try:
        found = [float(word) for word in line.replace(",", " ").split()[:count]]
    except ValueError:
        found = []
    if len(found) < count or any(number - number != 0.0 for number in found):
        raise FormatError(f"{place}: expected {count} numbers, not {line.strip()!r:.200}")
    return found
