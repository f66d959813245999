"""Metrics for predictions of any source.

    from opendr.metrics import Metric

    metric = Metric("coco_detection")
    for image, annotation in dataset:
        metric.update(detector.infer(image), annotation)
    print(metric.result()["map50"])

Results are equal to those of the reference tools listed in docs/metrics.md.
"""

from __future__ import annotations

import json
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, Callable, Optional

from opendr import _opendr
from opendr._older_names import renamed
from opendr.engine.target import BaseTarget

if TYPE_CHECKING:
    from opendr.engine.datasets import Dataset, DatasetIterator

__all__ = ["Metric", "evaluate", "names", "tables"]


def names() -> list[str]:
    """Returns the names of the metrics."""
    return [table["name"] for table in _opendr.metrics()]


def tables() -> list[dict[str, Any]]:
    """Returns a table of each metric: ``name``, ``about``, the classes of ``prediction`` and ``ground_truth``,
    ``numbers`` (name and meaning of each scalar), and ``params``."""
    return _opendr.metrics()


class Metric:
    """A metric: an accumulator over pairs of prediction and ground truth.

    Args:
        name: One of ``names()``.
        params: Parameters of the metric.

    Raises:
        FileNotFoundError: The metric does not exist.
        ValueError: A parameter is unknown or out of range.
    """

    def __init__(self, name: str, **params: Any) -> None:
        self._metric = _opendr.Metric(name, params)
        self.name: str = name

    def update(
        self,
        prediction: BaseTarget,
        ground_truth: Optional[BaseTarget] = None,
        *,
        index: Optional[int] = None,
        **former: Any,
    ) -> float:
        """Adds the prediction for one sample.

        Args:
            prediction: The prediction.
            ground_truth: The ground truth.
            index: Index of the sample, which breaks ties; by default consecutive.
            former: The names of these arguments before 0.1: ``truth`` and ``at``.

        Returns:
            The score of the prediction, from 0 to 1, the best.

        Raises:
            TypeError: An argument is missing or unknown.
            ValueError: The types are not those of the metric, or a value is invalid; nothing is added then.
        """
        ground_truth = renamed(ground_truth, "ground_truth", former, "truth")
        index = renamed(index, "index", former, "at")
        if former:
            raise TypeError(f"update has no argument {next(iter(former))!r}; its arguments are prediction, ground_truth, index")
        if ground_truth is None:
            raise TypeError("update needs the ground truth of the sample")
        return self._metric.update(prediction, ground_truth, index)

    def end_sequence(self) -> None:
        """Ends the current sequence (video or drive); the next sample begins a new one."""
        self._metric.end_sequence()

    def merge(self, other: Metric) -> None:
        """Adds the samples of ``other``, which is empty afterwards.

        Raises:
            ValueError: ``other`` is of another metric.
        """
        self._metric.merge(other._metric)

    def result(self) -> dict[str, Any]:
        """Returns the scalars by name, and under ``"report"`` the whole report with tables and figures."""
        report = json.loads(self._metric.finish())
        return {**report.get("scalars", {}), "report": report}


def evaluate(infer: Callable[..., Any], dataset: DatasetIterator, metric: str, **params: Any) -> dict[str, Any]:
    """Evaluates a function on a data set.

    Classes are matched by name where predictions and data set name them (``classes`` of the data set and of lists of targets).

    Args:
        infer: Function from the data of a sample to a target, or to a ``dict`` or tuple of targets with one of the metric's
            type.
        dataset: Pairs of datum and target; a tuple of data for a function with several arguments.
        metric: One of ``names()``.
        params: Parameters of the metric.

    Returns:
        The same as :meth:`Metric.result`.

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
    """Evaluates a function on a data set, with the options of an evaluation.

    Args:
        infer: Function from the data of a sample to targets.
        dataset: The data set.
        options: ``metric``, ``metric_params``, ``split``, ``limit``, ``out``, ``skip_broken``, ``classes``, ``by_number``,
            ``resamples``.
        reset: Function that resets the state of ``infer``, called before each sequence.
        types: The types of the arguments of ``infer``, by default those of the first sample.
        classes: Names of the class indices of predictions.
        name: Name of the function in the report.
        verbose: Whether to show progress and print the outcome.
    """
    given = (list(types), list(classes), name, json.dumps(options), verbose)
    report, text = _opendr.evaluate(infer, reset, dataset, *given)
    if verbose:
        print(text, end="")
    outcome = json.loads(report)
    return {**outcome.get("scalars", {}), "report": outcome}
