"""OpenDR's data sets of signals."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from opendr.engine.data import Timeseries
from opendr.engine.datasets import DatasetIterator
from opendr.engine.target import Category


class Dataset(DatasetIterator):
    """Series and their classes.

    Args:
        x: Arrays, ``[channels, steps]`` each.
        y: Class indices.

    Raises:
        ValueError: There are not as many of both.
    """

    def __init__(self, x: Sequence[Any], y: Sequence[int]) -> None:
        if len(x) != len(y):
            raise ValueError(f"{len(x)} series have {len(y)} classes; give as many of both")
        self.x, self.y = x, y

    def __getitem__(self, idx: int) -> tuple[Timeseries, Category]:
        import numpy as np

        # OpenDR's learners of hearts had channels first.
        return Timeseries(np.asarray(self.x[idx]).T), Category(self.y[idx])

    def __len__(self) -> int:
        return len(self.y)
