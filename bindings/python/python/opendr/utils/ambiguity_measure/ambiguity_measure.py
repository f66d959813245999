"""OpenDR's interface to `AmbiguityMeasureLearner`."""

from __future__ import annotations

from typing import Any

import numpy as np

from opendr.engine.target import Heatmap
from opendr.perception.ambiguity_measure import AmbiguityMeasureLearner


class AmbiguityMeasure:
    """Measures the ambiguity of maps, such as the grasp maps of Transporter Nets.

    A map is ambiguous if the peaks other than the best one have together at least the probability `threshold`. (OpenDR 3.0
    reported the opposite.) A higher `temperature` of the softmax over the peaks makes maps more ambiguous.
    """

    def __init__(self, threshold: float = 0.5, temperature: float = 1.0) -> None:
        self._learner = AmbiguityMeasureLearner(threshold=threshold, temperature=temperature)
        self._learner.load()

    def get_ambiguity_measure(
        self, heatmap: np.ndarray[Any, Any]
    ) -> tuple[bool, np.ndarray[Any, Any], np.ndarray[Any, Any], np.ndarray[Any, Any]]:
        """Returns whether a map `[height, width]` is ambiguous, and its peaks, most persistent first: `[peaks, 2]` rows and
        columns, `[peaks]` values and `[peaks]` probabilities.

        Raises ValueError for maps of another shape and for values that are not finite.
        """
        category, peaks = self._learner.infer(Heatmap(np.asarray(heatmap, dtype=np.float32)))
        rows = np.asarray(peaks.data)
        return bool(category.data), rows[:, :2].astype(np.int64), rows[:, 2], rows[:, 3]
