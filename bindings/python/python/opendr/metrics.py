"""The field's metrics, beside any learner or none.

    from opendr.metrics import Metric

    metric = Metric("coco_detection")
    for image, truth in dataset:
        metric.update(detector.infer(image), truth)
    print(metric.result()["map50"])

Numbers equal those of the reference tools that docs/metrics.md names.
"""

from __future__ import annotations

import json
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, Callable, Optional

from opendr import _opendr
from opendr.engine.target import BaseTarget

if TYPE_CHECKING:
    from opendr.engine.datasets import Dataset, DatasetIterator

__all__ = ["Metric", "evaluate", "names", "tables"]


def names() -> list[str]:
    """The metrics that there are."""
    return [table["name"] for table in _opendr.metrics()]


def tables() -> list[dict[str, Any]]:
    """What there is to know of each: ``name``, ``about``, the classes of ``prediction`` and ``truth``, ``numbers`` (name
    and meaning), and ``params``."""
    return _opendr.metrics()


class Metric:
    """An accumulator: answers and truths go in one after the other, numbers come out at any time.

    Args:
        name: One of ``names()``.
        params: Its parameters.

    Raises:
        FileNotFoundError: There is no such metric.
        ValueError: A parameter is unknown or out of range.
    """

    def __init__(self, name: str, **params: Any) -> None:
        self._metric = _opendr.Metric(name, params)
        self.name: str = name

    def update(self, prediction: BaseTarget, truth: BaseTarget, *, at: Optional[int] = None) -> float:
        """Counts the answer to one sample.

        Args:
            prediction: What the learner answered.
            truth: What it should have answered.
            at: The number of the sample, which settles ties; by default one after the other.

        Returns:
            How good the answer is: 0 (worst) to 1.

        Raises:
            ValueError: They are of other types than the metric's, or cannot be counted; nothing is counted then.
        """
        return self._metric.update(prediction, truth, at)

    def end_sequence(self) -> None:
        """Tells that the video or drive is over; what follows has nothing to do with it."""
        self._metric.end_sequence()

    def merge(self, other: Metric) -> None:
        """Counts what ``other`` counted, which begins anew.

        Raises:
            ValueError: It is another metric.
        """
        self._metric.merge(other._metric)

    def result(self) -> dict[str, Any]:
        """The numbers by name, and under ``"report"`` all there is: tables and figures."""
        report = json.loads(self._metric.finish())
        return {**report.get("scalars", {}), "report": report}


def evaluate(infer: Callable[..., Any], dataset: DatasetIterator, metric: str, **params: Any) -> dict[str, Any]:
    """Measures any function on a data set.

    Classes are matched by name where predictions and data set name them (``classes`` of the data set and of lists of targets).

    Args:
        infer: From the data of a sample to a target, or to a ``dict`` or tuple of targets with one of the metric's type.
        dataset: Pairs of datum and target; a tuple of data for a function of several.
        metric: One of ``names()``.
        params: Parameters of the metric.

    Returns:
        As :meth:`Metric.result`.

    Raises:
        ValueError: Predictions, data set and metric do not fit together.
    """
    return evaluate_function(infer, dataset, {"metric": metric, "metric_params": params})


def evaluate_function(
    infer: Callable[..., Any],
    dataset: Dataset,
    options: dict[str, Any],
    reset: Optional[Callable[[], Any]] = None,
    types: Sequence[str] = (),
    classes: Sequence[str] = (),
    name: str = "",
    verbose: bool = False,
) -> dict[str, Any]:
    """As :func:`evaluate`, with the options of an evaluation by name.

    Args:
        infer: From the data of a sample to targets.
        dataset: What to measure on.
        options: ``metric``, ``metric_params``, ``split``, ``limit``, ``out``, ``skip_broken``, ``classes``, ``by_number``,
            ``resamples``.
        reset: What makes ``infer`` forget, before a sequence.
        types: The types of data that ``infer`` takes, by default those of the first sample.
        classes: What class numbers of predictions mean.
        name: What the report calls what is measured.
        verbose: Whether to show progress and print the outcome.
    """
    given = (list(types), list(classes), name, json.dumps(options), verbose)
    report, text = _opendr.evaluate(infer, reset, dataset, *given)
    if verbose:
        print(text, end="")
    outcome = json.loads(report)
    return {**outcome.get("scalars", {}), "report": outcome}
