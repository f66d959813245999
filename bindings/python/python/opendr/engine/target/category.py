"""The class of a whole input."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, ClassVar, Optional, SupportsIndex, Union

from opendr.engine._arrays import array_of
from opendr.engine._checks import real, text, whole
from opendr.engine.target._table import Column, Table, ints, texts
from opendr.engine.target.base_target import Target

if TYPE_CHECKING:
    import numpy as np
    import supervision
    from numpy.typing import ArrayLike, NDArray


class Category(Target):
    """The predicted or annotated class of a datum; ``data`` is its index.

    Args:
        prediction: Class index.
        description: Name of the class.
        confidence: Score of the class in [0, 1], or a vector of the scores of all classes.
        probabilities: Scores of all classes, ``[classes]``, besides a single ``confidence``.

    Raises:
        TypeError: The description is not a str, or the confidence is not a number.
        ValueError: The prediction is not an integer, or a score is not finite.
    """

    _fields: ClassVar[tuple[str, ...]] = ("data", "description", "confidence", "probabilities")

    def __init__(
        self,
        prediction: SupportsIndex,
        description: Optional[str] = None,
        confidence: Union[float, ArrayLike, None] = None,
        *,
        probabilities: Optional[ArrayLike] = None,
    ) -> None:
        self.data = prediction
        self.description: Optional[str] = None if description is None else text(description, "description")
        self.probabilities: Optional[NDArray[np.float32]] = None if probabilities is None else _scores(probabilities)
        self.confidence = confidence

    @property
    def data(self) -> int:
        """Class index."""
        return int(self._data)

    @data.setter
    def data(self, data: SupportsIndex) -> None:
        try:
            self._data = whole(data, "the class")
        except TypeError:
            raise ValueError(f"a Category has the index of its class, not {data!r}; give an int") from None

    @property
    def confidence(self) -> Union[float, NDArray[np.float32], None]:
        """Score of the class; the scores of all classes when only these are given; else None."""
        return self.probabilities if self._confidence is None else float(self._confidence)

    @confidence.setter
    def confidence(self, confidence: Any) -> None:
        if getattr(confidence, "ndim", 0) or isinstance(confidence, (list, tuple)):
            self._confidence, self.probabilities = None, _scores(confidence)
        else:
            self._confidence = None if confidence is None else real(confidence, "confidence")

    def to_supervision(self) -> supervision.Classifications:
        """Returns the class as ``supervision.Classifications``: all classes where their scores are known, else only this one.

        Raises:
            ImportError: The package supervision is not installed.
        """
        from opendr.engine.target._supervision import classifications

        return classifications(self)

    def _is_drawn(self) -> bool:
        return True

    def _table(self) -> Table:
        scores = {self.data: self._confidence} if self.probabilities is None else dict(enumerate(self.probabilities))
        return {
            "name": ints(scores),
            "class_name": texts(self.description if index == self.data else None for index in scores),
            "confidence": Column(list(scores.values())),
        }


def _scores(values: ArrayLike) -> NDArray[np.float32]:
    import numpy as np

    scores = array_of(values, "float32", "the scores of a Category")
    if scores.ndim != 1 or not np.isfinite(scores).all():
        raise ValueError(f"scores of shape {scores.shape} should be a vector of finite numbers, one per class")
    return scores
