"""OpenDR's call for `AmbiguityMeasureLearner`."""

from __future__ import annotations

from typing import Any

import numpy as np

from opendr.engine.target import Heatmap
from opendr.perception.ambiguity_measure import AmbiguityMeasureLearner


class AmbiguityMeasure:
    """Measures the ambiguity of maps, such as those by which Transporter Nets choose where to grasp.

    A map is ambiguous where what is left beside its best peak has at least the probability `threshold`. (In OpenDR 3.0 it was
    where the best peak was certain.) A higher `temperature` of the softmax over the peaks makes maps more ambiguous.
    """

    def __init__(self, threshold: float = 0.5, temperature: float = 1.0) -> None:
        self._learner = AmbiguityMeasureLearner(threshold=threshold, temperature=temperature)
        self._learner.load()

    def get_ambiguity_measure(
        self, heatmap: np.ndarray[Any, Any]
    ) -> tuple[bool, np.ndarray[Any, Any], np.ndarray[Any, Any], np.ndarray[Any, Any]]:
        """Whether a map `[height, width]` is ambiguous; its peaks, most persistent first: `[peaks, 2]` rows and columns,
        `[peaks]` values and `[peaks]` probabilities.

        Raises ValueError for maps of another shape and for values that are not finite.
        """
        category, peaks = self._learner.infer(Heatmap(np.asarray(heatmap, dtype=np.float32)))
        rows = np.asarray(peaks.data)
        return bool(category.data), rows[:, :2].astype(np.int64), rows[:, 2], rows[:, 3]
