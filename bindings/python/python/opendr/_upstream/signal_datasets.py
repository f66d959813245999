"""OpenDR's data sets of signals."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from opendr.engine.data import Timeseries
from opendr.engine.datasets import DatasetIterator
from opendr.engine.target import Category


class Dataset(DatasetIterator):
    """Time series with classes.

    Args:
        x: Arrays, ``[channels, steps]`` each.
        y: Class indices.

    Raises:
        ValueError: The lengths differ.
    """

    def __init__(self, x: Sequence[Any], y: Sequence[int]) -> None:
        if len(x) != len(y):
            raise ValueError(f"{len(x)} series have {len(y)} classes; give the same number of both")
        self.x, self.y = x, y

    def __getitem__(self, idx: int) -> tuple[Timeseries, Category]:
        import numpy as np

        # OpenDR's heart anomaly learners have channels first.
        return Timeseries(np.asarray(self.x[idx]).T), Category(self.y[idx])

    def __len__(self) -> int:
        return len(self.y)
