"""Pipelines: learners in sequence, such as a detector and a tracker."""

from __future__ import annotations

import os
import queue
import threading
from collections.abc import Iterable, Iterator, Mapping
from typing import Any, Optional, Union

from opendr._registered import learner as learner_by_name
from opendr.engine._ports import outputs_of, ports_of
from opendr.engine.datasets import Dataset
from opendr.engine.learners import BaseLearner

#: Length of the queue before each learner; a longer one costs memory and latency.
_QUEUE_LENGTH = 2
_END = object()


class Pipeline:
    """Learners in sequence, each of which takes the predictions of those before it::

        pipeline = opendr.Pipeline("nanodet", "posenet")
        for frame, predictions in pipeline.run(opendr.Source("walk.mp4")):
            print(predictions["boxes"], predictions["poses"])

    An input takes the newest prediction of its type. An input whose type no earlier learner predicts is an input of the
    pipeline, shared by all learners that have it. Predictions are a ``dict`` by the names of the outputs; of two outputs of
    one type, it has the later one.

    Args:
        learners: Loaded learners, or names of pretrained ones (``"nanodet"``, ``"yunet/320"``).

    Raises:
        ValueError: A learner takes neither an input nor a prediction of those before it.
    """

    def __init__(self, *learners: Union[BaseLearner, str]) -> None:
        if not learners:
            raise ValueError("the pipeline has no learners; give at least one")
        self._stages: list[_Stage] = []
        self.inputs: list[str] = []
        for one in learners:
            stage = _Stage(learner_by_name(one) if isinstance(one, str) else one)
            stage.connect(self._stages)
            self.inputs += [name for name in stage.given if name not in self.inputs]
            self._stages.append(stage)

    def infer(self, *inputs: Any, **named: Any) -> dict[str, Any]:
        """Returns the predictions for one set of inputs, in the order of ``inputs`` or by name.

        Raises:
            TypeError: An input is missing or unknown.
        """
        return _merged(self._infer(self._named(inputs, named)))

    def run(self, items: Iterable[Any]) -> Iterator[tuple[Any, dict[str, Any]]]:
        """Yields each item of a stream with its predictions, in order. Each learner runs on a thread of its own, so the
        slowest one determines the throughput. Items are values of the first input, or ``dict`` of inputs by name.

        Raises:
            Exception: The exception of reading or processing an item, in place of that item; the run ends with it.
        """
        self.reset()
        queues: list[queue.Queue[Any]] = [queue.Queue(_QUEUE_LENGTH) for _ in range(len(self._stages) + 1)]
        stop = threading.Event()
        work = [lambda: self._feed(items, queues[0], stop)]
        for at, stage in enumerate(self._stages):
            work.append(lambda at=at, stage=stage: _serve(stage, queues[at], queues[at + 1], stop))  # type: ignore[misc]
        threads = [threading.Thread(target=target, daemon=True) for target in work]
        for thread in threads:
            thread.start()
        try:
            while (job := queues[-1].get()) is not _END:
                if isinstance(job, BaseException):
                    raise job
                item, _, predictions = job
                yield item, _merged(predictions)
        finally:
            stop.set()
            for thread in threads:
                thread.join()

    def eval(
        self,
        dataset: Dataset,
        *,
        metric: Optional[str] = None,
        split: Optional[str] = None,
        limit: Optional[int] = None,
        out: Union[None, str, os.PathLike[str]] = None,
        skip_broken: bool = False,
        classes: Optional[Mapping[str, str]] = None,
        by_number: bool = False,
        resamples: int = 200,
        verbose: bool = False,
        **metric_params: Any,
    ) -> dict[str, Any]:
        """Evaluates the pipeline on a data set, by default with the metric of the last learner's task. Arguments and result are
        those of ``eval`` of a learner.

        Raises:
            FileNotFoundError: The data set does not exist.
            ValueError: Data set, pipeline and metric do not fit together, or a sample is broken.
        """
        from opendr import _opendr
        from opendr.metrics import evaluate_function

        last = self._stages[-1].learner
        options = {
            "metric": metric or _opendr.metric_of(_task(last)),
            "metric_params": metric_params,
            "split": split,
            "limit": limit,
            "out": None if out is None else os.fspath(out),
            "skip_broken": skip_broken,
            "classes": dict(classes or {}),
            "by_number": by_number,
            "resamples": resamples,
        }
        return evaluate_function(
            self.infer,
            dataset,
            options,
            reset=self.reset,
            types=self._types(),
            classes=getattr(last, "classes", ()),
            name=" + ".join(_name(stage.learner) for stage in self._stages),
            verbose=verbose,
        )

    def _types(self) -> list[str]:
        """Returns the types of the inputs, in the order of ``inputs``."""
        types = {port["name"]: port["type"] for stage in self._stages for port in stage.ports if port["name"] in stage.given}
        return [types[name] for name in self.inputs]

    def reset(self) -> None:
        """Resets the state of all learners."""
        for stage in self._stages:
            stage.learner.reset()

    def _infer(self, given: dict[str, Any]) -> list[dict[str, Any]]:
        predictions: list[dict[str, Any]] = []
        for stage in self._stages:
            predictions.append(stage.infer(given, predictions))
        return predictions

    def _named(self, inputs: tuple[Any, ...], named: dict[str, Any]) -> dict[str, Any]:
        if len(inputs) > len(self.inputs):
            raise TypeError(f"the pipeline takes {len(self.inputs)} inputs ({', '.join(self.inputs)}), not {len(inputs)}")
        given = {**dict(zip(self.inputs, inputs)), **named}
        unknown = [name for name in given if name not in self.inputs]
        if unknown:
            raise TypeError(f"the pipeline has no input {unknown[0]!r}; its inputs are {', '.join(self.inputs)}")
        return given

    def _feed(self, items: Iterable[Any], to: queue.Queue[Any], stop: threading.Event) -> None:
        try:
            for item in items:
                given = self._named((), item) if isinstance(item, dict) else self._named((item,), {})
                if not _put(to, (item, given, []), stop):
                    return
        except BaseException as error:  # Raised in the thread that reads the results.
            _put(to, error, stop)
        _put(to, _END, stop)


class _Stage:
    """A learner and the sources of its inputs."""

    def __init__(self, learner: BaseLearner) -> None:
        self.learner = learner
        entry = getattr(learner, "_entry", None)
        problems: list[str] = []
        kind = type(learner)
        self.ports = entry["ports"] if entry else ports_of(kind.infer, problems)
        self.outputs = entry["outputs"] if entry else outputs_of(kind.infer, problems)
        if problems:
            raise TypeError(f"{kind.__name__}: {problems[0]}")
        #: Source of each input: the index of a stage and the name of its output.
        self.wires: dict[str, tuple[int, str]] = {}

    @property
    def given(self) -> list[str]:
        """Names of the inputs that are inputs of the pipeline."""
        return [port["name"] for port in self.ports if port["name"] not in self.wires]

    def connect(self, before: list[_Stage]) -> None:
        """Connects each input to the newest output of its type."""
        for port in self.ports:
            for at, stage in enumerate(before):
                fitting = [output["name"] for output in stage.outputs if output["type"] == port["type"]]
                if fitting and not port["init"]:
                    self.wires[port["name"]] = (at, fitting[0])
        shared = {port["type"] for stage in before for port in stage.ports}
        if before and not self.wires and not all(port["type"] in shared for port in self.ports):
            inputs = ", ".join(port["type"] for port in self.ports)
            outputs = ", ".join(output["type"] for stage in before for output in stage.outputs)
            raise ValueError(
                f"{type(self.learner).__name__} takes {inputs}, and the learners before it return {outputs}; "
                "put a learner before it that returns one of its inputs"
            )

    def infer(self, given: dict[str, Any], before: list[dict[str, Any]]) -> dict[str, Any]:
        inputs = {name: given[name] for name in self.given if name in given}
        inputs.update({name: before[at][output] for name, (at, output) in self.wires.items()})
        returned = self.learner.infer(**inputs)
        predictions = returned if isinstance(returned, tuple) else (returned,)
        return {output["name"]: prediction for output, prediction in zip(self.outputs, predictions)}


def _name(learner: BaseLearner) -> str:
    entry = getattr(learner, "_entry", None)
    return str(entry["name"] if entry else getattr(learner, "name", type(learner).__name__))


def _task(learner: BaseLearner) -> str:
    entry = getattr(learner, "_entry", None)
    return str(entry["task"] if entry else getattr(learner, "task", ""))


def _serve(stage: _Stage, source: queue.Queue[Any], to: queue.Queue[Any], stop: threading.Event) -> None:
    while (job := _get(source, stop)) is not _END:
        if isinstance(job, BaseException):
            _put(to, job, stop)
            return
        _, given, predictions = job
        try:
            predictions.append(stage.infer(given, predictions))
        except BaseException as error:  # Raised in the thread that reads the results.
            _put(to, error, stop)
            return
        if not _put(to, job, stop):
            return
    _put(to, _END, stop)


def _put(to: queue.Queue[Any], job: Any, stop: threading.Event) -> bool:
    """Puts a job into a queue; returns False if the run is stopped first."""
    while not stop.is_set():
        try:
            to.put(job, timeout=0.1)
            return True
        except queue.Full:
            continue
    return False


def _get(source: queue.Queue[Any], stop: threading.Event) -> Any:
    while not stop.is_set():
        try:
            return source.get(timeout=0.1)
        except queue.Empty:
            continue
    return _END


def _merged(predictions: list[dict[str, Any]]) -> dict[str, Any]:
    merged: dict[str, Any] = {}
    for outputs in predictions:
        for name, value in outputs.items():
            merged = {known: earlier for known, earlier in merged.items() if type(earlier) is not type(value)}
            merged[name] = value
    return merged
