"""Detectors limited to some classes."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any, Optional

from opendr.engine.learners import BaseLearner
from opendr.engine.target import BoundingBoxList


class FilteredLearnerWrapper:
    """A detector without the boxes of other classes; all other attributes are the detector's.

    Args:
        learner: The detector, loaded.
        allowed_classes: Names of the classes to keep; by default all.

    Raises:
        TypeError: The argument is not a learner.
        ValueError: The detector does not have a class.
    """

    def __init__(self, learner: BaseLearner, allowed_classes: Optional[Sequence[str]] = None) -> None:
        if not isinstance(learner, BaseLearner):
            raise TypeError(f"learner should be a detector, not {learner!r:.100}")
        self.learner = learner
        self.allowed_classes = list(allowed_classes or ())
        #: Names of the detector's class indices.
        self.classes: list[str] = list(getattr(learner, "classes", []))
        unknown = [name for name in self.allowed_classes if name not in self.classes]
        if unknown:
            raise ValueError(
                f"{type(learner).__name__} does not have the classes {', '.join(unknown)}; load it and check its attribute classes"
            )

    def infer(self, *inputs: Any, **arguments: Any) -> Any:
        """Returns the detector's predictions of the allowed classes."""
        found = self.learner.infer(*inputs, **arguments)
        if isinstance(found, Iterator):
            return map(self._allowed, found)
        return [self._allowed(boxes) for boxes in found] if isinstance(found, list) else self._allowed(found)

    def _allowed(self, found: BoundingBoxList) -> BoundingBoxList:
        if not self.allowed_classes:
            return found
        numbers = {self.classes.index(name) for name in self.allowed_classes}
        kept = BoundingBoxList(
            [box for box in found.data if box.name in numbers], found.image_id, classes=found.classes
        )
        return found._with_header_in(kept)

    def __getattr__(self, name: str) -> Any:
        if name == "learner":
            raise AttributeError(name)
        return getattr(self.learner, name)
