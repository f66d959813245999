"""OpenDR's interface to the ambiguity of maps."""

from __future__ import annotations

import numpy as np
import pytest
from opendr.utils.ambiguity_measure.ambiguity_measure import AmbiguityMeasure


def test_two_equal_peaks_are_ambiguous_and_one_is_not() -> None:
    measure = AmbiguityMeasure(threshold=0.5, temperature=2.0)
    one = np.zeros((5, 7))
    one[1, 2] = 20.0
    ambiguous, places, values, probabilities = measure.get_ambiguity_measure(one)
    assert not ambiguous
    assert places[0].tolist() == [1, 2] and values[0] == 20.0 and probabilities[0] > 0.99
    two = one.copy()
    two[3, 5] = 20.0
    ambiguous, places, values, probabilities = measure.get_ambiguity_measure(two)
    assert ambiguous
    assert sorted(places[:2].tolist()) == [[1, 2], [3, 5]]
    assert probabilities[:2] == pytest.approx([0.5, 0.5], abs=1e-3)


def test_maps_that_are_none_are_refused() -> None:
    measure = AmbiguityMeasure()
    with pytest.raises(ValueError):
        measure.get_ambiguity_measure(np.zeros(5))
    with pytest.raises(ValueError):
        measure.get_ambiguity_measure(np.full((2, 2), np.nan))
