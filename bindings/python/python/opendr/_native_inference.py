"""Inference of the native learners."""

from __future__ import annotations

import operator
from collections.abc import Iterator, Sequence
from typing import Any, ClassVar, Optional

from opendr._errors import InternalError, InvalidInput, Unsupported
from opendr._input_value import input_value
from opendr._native_arguments import NativeArguments
from opendr._progress import with_progress
from opendr.engine._image_reference import ImageReference
from opendr.engine.target import BaseTarget


class NativeInference(NativeArguments):
    """A learner of the registry that returns predictions."""

    def infer(self, *inputs: Any, **arguments: Any) -> Any:
        """Returns the prediction for one input, or for each of several.

        Args:
            inputs: The inputs, in the order of the learner's ports; also by name. An image may be an ``Image``, an
                array (layout guessed by the rule of ``Image``), or the path of a file; the same holds for audio (WAVE),
                time series (CSV, NPY) and scans (KITTI). For a list of inputs the result is a list of predictions, for
                an iterator such as a ``Source`` an iterator of predictions.
            arguments: Inputs by name, live parameters for this call only, and ``progress``: whether the progress of several
                inputs is shown on standard error if that is a terminal, where their number is known or after two seconds;
                True by default. With ``ray=True``, or the address of a Ray cluster, several inputs are predicted on its workers;
                ``ray_options`` are the resources of a task, such as ``{"num_cpus": 2}``.

        Returns:
            The prediction, with the time stamp and frame id of the input; a named tuple where the learner has several
            outputs. It refers to the image that it was predicted from without keeping it in memory (``plot``, ``show``).

        Raises:
            FileNotFoundError: Nothing is loaded yet, or a file does not exist.
            TypeError: An argument is of another type than the learner takes.
            ValueError: A value is out of range.
            opendr.InternalError: The network returned NaN or an infinite number; the message says where.
        """
        progress = arguments.pop("progress", True)
        ray, ray_options = arguments.pop("ray", False), arguments.pop("ray_options", None)
        ports, overrides = self._arguments(inputs, arguments)
        first = ports.get(self._entry["ports"][0]["name"])
        if ray:
            return self._infer_on(ray, ray_options, ports, overrides, progress)
        if isinstance(first, Iterator):
            return self._with_progress(self._infer_each(ports, overrides), first, progress)
        if isinstance(first, (list, tuple)):
            init = {port["name"] for port in self._entry["ports"] if port["init"]}
            items = {name: value for name, value in ports.items() if name not in init}
            lengths = {name: len(value) for name, value in items.items() if isinstance(value, (list, tuple))}
            if len(set(lengths.values())) > 1:
                raise ValueError(f"the inputs have different lengths: {lengths}; give the same number of each")
            return list(self._with_progress(self._infer_each(ports, overrides), first, progress))
        return self._infer_one(self._handle, ports, overrides)

    def reset(self) -> None:
        """Resets the state: the next input begins a new stream."""
        self._handle.reset()

    def stream(self) -> Stream:
        """Returns a stream with its own state over the same model, for another camera or thread.

        Raises:
            FileNotFoundError: No model is loaded.
        """
        return Stream(self)

    def push(self, *piece: Any, **named: Any) -> list[Any]:
        """Processes the next chunk of the input and returns the predictions that are ready.

        Raises:
            opendr.Unsupported: The learner does not process its input in chunks.
        """
        ports, _ = self._arguments(piece, named)
        return [self._prediction(outputs) for outputs in self._handle.push(self._values(ports))]

    def flush(self) -> list[Any]:
        """Ends an input that was given in chunks and returns the remaining predictions.

        Raises:
            opendr.Unsupported: The learner does not process its input in chunks.
        """
        return [self._prediction(outputs) for outputs in self._handle.push(None)]

    def _infer_on(
        self, ray: Any, ray_options: Any, ports: dict[str, Any], overrides: dict[str, Any], progress: bool
    ) -> Any:
        """Predicts on a Ray cluster."""
        from opendr import _cluster

        first = ports.get(self._entry["ports"][0]["name"])
        if not isinstance(first, (list, tuple, Iterator)):
            raise TypeError("an inference on Ray takes a list or an iterator of inputs")
        if self._entry["stateful"]:
            raise Unsupported(f"{type(self).__name__} has a state over its inputs, so it cannot predict them on several machines")
        calls = self._each_ports(ports)
        predictions = self._with_progress(_cluster.infer(self, calls, overrides, ray, ray_options), first, progress)
        return predictions if isinstance(first, Iterator) else list(predictions)

    def _infer_each(self, ports: dict[str, Any], overrides: dict[str, Any]) -> Iterator[Any]:
        """Yields the prediction for each input of the first port."""
        for each in self._each_ports(ports):
            yield self._infer_one(self._handle, each, overrides)

    def _each_ports(self, ports: dict[str, Any]) -> Iterator[dict[str, Any]]:
        """Yields the inputs by port name for each input of the first port. Other ports that are lists or iterators advance with it;
        init ports are given with the first input."""
        table = self._entry["ports"]
        several = {
            port["name"]: iter(ports[port["name"]])
            for port in table
            if isinstance(ports.get(port["name"]), (list, tuple, Iterator)) and not port["init"]
        }
        same = {name: value for name, value in ports.items() if name not in several}
        for items in zip(*several.values()):
            yield {**same, **dict(zip(several, items))}
            same = {port["name"]: same[port["name"]] for port in table if port["name"] in same and not port["init"]}

    def _with_progress(self, predictions: Iterator[Any], inputs: Any, progress: bool) -> Iterator[Any]:
        """Returns the predictions for ``inputs``, whose progress is shown."""
        if not progress:
            return predictions
        remaining = operator.length_hint(inputs, -1)
        return with_progress(predictions, self._entry["name"], None if remaining < 0 else remaining)

    def _infer_one(self, handle: Any, ports: dict[str, Any], overrides: dict[str, Any]) -> Any:
        outputs = handle.infer(self._values(ports), overrides) if overrides else handle.infer(self._values(ports))
        return self._prediction(outputs, self._image_of(ports))

    def _image_of(self, ports: dict[str, Any]) -> Optional[ImageReference]:
        """Returns a reference to the image among the inputs, or to that of a target among them."""
        for name in self._image_ports:
            value = ports.get(name)
            if value is not None:
                image = value._image if isinstance(value, BaseTarget) else ImageReference.to(value)
                if image is not None:
                    return image
        return None

    def _values(self, ports: dict[str, Any]) -> dict[str, Any]:
        types = {port["name"]: port["type"] for port in self._entry["ports"]}
        return {name: input_value(value, name, types[name]) for name, value in ports.items()}

    def _prediction(self, outputs: list[Any], image: Optional[ImageReference] = None) -> Any:
        from opendr._schema import target_from_json

        try:
            targets = [target_from_json(json, array) for _, json, array in outputs]
        except InvalidInput as error:
            raise InternalError(
                f"{self._entry['name']} returned an invalid target: {error}; check the model and its input"
            ) from error
        if image is not None:
            for target in targets:
                target._image = image
        return targets[0] if len(targets) == 1 else self._outputs(*targets)

    #: The named tuple of several outputs.
    _outputs: ClassVar[Any] = None
    #: The inputs that are images, then those that are targets, which may refer to an image.
    _image_ports: ClassVar[Sequence[str]] = ()


class Stream:
    """A stream with its own state over the model of a learner."""

    def __init__(self, learner: NativeInference) -> None:
        self._learner = learner
        self._stream = learner._handle.stream()

    def infer(self, *inputs: Any, **named: Any) -> Any:
        """Returns the prediction for one input, as ``infer`` of the learner."""
        ports, overrides = self._learner._arguments(inputs, named)
        if overrides:
            raise TypeError(f"a stream has no parameters ({', '.join(overrides)}); set them on the learner")
        return self._learner._infer_one(self._stream, ports, {})

    def push(self, *piece: Any, **named: Any) -> list[Any]:
        """Processes the next chunk of the input, as ``push`` of the learner."""
        ports, _ = self._learner._arguments(piece, named)
        return [self._learner._prediction(outputs) for outputs in self._stream.push(self._learner._values(ports))]

    def flush(self) -> list[Any]:
        """Ends an input that was given in chunks and returns the remaining predictions."""
        return [self._learner._prediction(outputs) for outputs in self._stream.push(None)]

    def reset(self) -> None:
        """Resets the state."""
        self._stream.reset()
