"""Vectors."""

from __future__ import annotations

from typing import ClassVar

from opendr.engine.data.array_data import ArrayData


class Vector(ArrayData):
    """A vector ``[features]``, float32: features, a state, an embedding."""

    _axes: ClassVar[tuple[str, ...]] = ("features",)

    def __len__(self) -> int:
        return len(self.data)

    def __getitem__(self, index: int) -> float:
        return float(self.data[index])
