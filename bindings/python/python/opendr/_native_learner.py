"""The base classes of the native learners; parameters and inputs of each come from the registry."""

from __future__ import annotations

import contextlib
import json
import os
import warnings
from collections.abc import Iterator, Mapping, Sequence
from typing import Any, ClassVar, NoReturn, Optional, Union

from opendr import _opendr
from opendr._errors import InternalError, InvalidInput, Unsupported
from opendr._older_names import under_older_name
from opendr._python_learners import registered_name
from opendr._upstream.arguments import by_name, value_here
from opendr._upstream.rows import Argument
from opendr._upstream.rows import Learner as Row
from opendr.engine import data, target
from opendr.engine._parameters import Parameter, parameters
from opendr.engine.datasets import Dataset
from opendr.engine.learners import BaseLearner, Learner

PathLike = Union[str, "os.PathLike[str]"]
Table = dict[str, Any]
#: Data types that are read from a path: images, videos and folders of frames, WAVE, tables (CSV, text, NPY), scans of KITTI.
READ_FROM_FILES = ("Image", "Video", "Audio", "Timeseries", "Vector", "SkeletonSequence", "PointCloud")
#: Data types that cannot be created from one array.
OF_SEVERAL_PARTS = ("Audio", "Calibration", "ImageWithDetections", "PointCloudWithCalibration")


class NativeBase(BaseLearner):
    """A learner of the registry, which defines its class, parameters, inputs and outputs.

    It has no model after construction: ``load()`` loads a pretrained model, ``load(path)`` one of your own. Threads may
    share a learner: calls are serialised, and ``stream()`` returns an object with its own state.
    """

    _entry: ClassVar[Table]
    #: The row of this learner in the table of OpenDR's names.
    _row: ClassVar[Row] = Row()
    #: The positional arguments of the constructor.
    _positional: ClassVar[Sequence[Argument]] = ()

    def __init__(self, *args: Any, **kwargs: Any) -> None:
        given = by_name(type(self).__name__, self._positional, args, kwargs, stacklevel=3)
        idle = dict(self._entry["without_effect"])
        #: OpenDR's arguments without effect, some of which name the folder that OpenDR's programs load from.
        self._idle = {name: value for name, value in given.items() if name in idle}
        known = self._known(given, stacklevel=3)
        super().__init__(**{name: value for name, value in known.items() if value is not None})
        params = {field["name"]: getattr(self, field["name"]) for field in self._entry["params"]}
        self._handle = _opendr.Handle(self._entry["name"], params, self.device)

    def __setattr__(self, name: str, value: Any) -> None:
        super().__setattr__(name, value)
        handle = vars(self).get("_handle")
        if handle is not None and any(field["name"] == name for field in self._entry["params"]):
            try:
                handle.set({name: getattr(self, name)})
            finally:
                vars(self)[name] = handle.params()[name]

    def infer(self, *inputs: Any, **arguments: Any) -> Any:
        """Returns the prediction for one input, or for each of several.

        Args:
            inputs: The inputs, in the order of the learner's ports; also by name. An image may be an ``Image``, an
                array (layout guessed by the rule of ``Image``), or the path of a file; the same holds for audio (WAVE),
                time series (CSV, NPY) and scans (KITTI). For a list of inputs the result is a list of predictions, for
                an iterator such as a ``Source`` an iterator of predictions.
            arguments: Inputs by name, and live parameters for this call only.

        Returns:
            The prediction, with the time stamp and frame id of the input; a named tuple where the learner has several
            outputs.

        Raises:
            FileNotFoundError: Nothing is loaded yet, or a file does not exist.
            TypeError: An argument is of another type than the learner takes.
            ValueError: A value is out of range.
            opendr.InternalError: The network returned NaN or an infinite number; the message says where.
        """
        ports, overrides = self._arguments(inputs, arguments)
        first = ports.get(self._entry["ports"][0]["name"])
        if isinstance(first, Iterator):
            return self._infer_each(ports, overrides)
        if isinstance(first, (list, tuple)):
            init = {port["name"] for port in self._entry["ports"] if port["init"]}
            items = {name: value for name, value in ports.items() if name not in init}
            lengths = {name: len(value) for name, value in items.items() if isinstance(value, (list, tuple))}
            if len(set(lengths.values())) > 1:
                raise ValueError(f"the inputs have different lengths: {lengths}; give the same number of each")
            return list(self._infer_each(ports, overrides))
        return self._infer_one(self._handle, ports, overrides)

    def load(self, path: Optional[PathLike] = None, verbose: bool = False, *, variant: Optional[str] = None) -> bool:
        """Loads a model.

        Args:
            path: A model container: a folder, its ``model.json``, or a zip. None loads the pretrained model, which is
                downloaded when it is not in the cache.
            verbose: Whether to show the progress of a download.
            variant: Variant of the pretrained model; by default the one that its card marks.

        Raises:
            FileNotFoundError: The model does not exist.
            ValueError: The model belongs to another learner, or is damaged.
        """
        if path is None:
            self._handle.load_pretrained(variant, verbose)
        else:
            self._handle.load(os.fspath(path))
        vars(self).update(self._handle.params())
        return True

    def save(self, path: PathLike, verbose: bool = False) -> bool:
        """Writes model and parameters as a container to the folder ``path``.

        Raises:
            FileNotFoundError: Nothing is loaded.
            OSError: The folder cannot be written.
        """
        self._handle.save(os.fspath(path))
        return True

    def download(
        self,
        path: Optional[PathLike] = None,
        mode: str = "pretrained",
        verbose: bool = True,
        url: Optional[str] = None,
        *,
        variant: Optional[str] = None,
    ) -> str:
        """Downloads a pretrained model, or a sample image.

        Args:
            path: Folder for a copy; None keeps it only in the cache, from which ``load()`` reads it.
            mode: ``"pretrained"`` for the model, ``"images"`` for a sample image.
            verbose: Whether to show progress.
            url: Not supported: cards name the models; ``OPENDR_MODEL_REPOSITORY`` names a server of your own.
            variant: Variant of the pretrained model; by default the one that its card marks.

        Returns:
            The path for ``load``: the model's folder (``path/<learner>/<variant>``, or OpenDR's name of it, such as
            ``path/ssd_default_person``); for ``"images"`` the file of the image.

        Raises:
            ValueError: The mode is unknown, or the checksum of a file is not that of the card.
            ConnectionError: A server could not be reached.
        """
        if url is not None:
            raise Unsupported("download does not support url; set OPENDR_MODEL_REPOSITORY to a server or folder of your own")
        folder = None if path is None else os.fspath(path)
        if mode == "pretrained":
            return os.fspath(_opendr.download(self._entry["name"], variant, folder, verbose))
        if mode == "images":
            return os.fspath(_sample(folder, verbose))
        raise ValueError(f"unknown mode {mode!r} of download; the modes are 'pretrained' and 'images'")

    def optimize(
        self,
        target_device: str = "",
        *,
        out: Optional[PathLike] = None,
        precision: str = "int8",
        calibration: Union[None, Dataset] = None,
        validation: Union[None, Dataset] = None,
        verbose: bool = False,
        **options: Any,
    ) -> dict[str, Any]:
        """Quantises the loaded model to INT8 or converts it to FP16, writes it as a container, and loads it.

        Args:
            target_device: Not supported: the result runs on every device.
            out: Folder for the container.
            precision: ``"int8"``: a quarter of the size, needs ``calibration``; ``"fp16"``: half the size.
            calibration: Data set on which the ranges of the tensors are measured; annotations are not needed.
            validation: Data set on which the accuracy before and after is measured.
            verbose: Whether to show progress and print the report.
            options: ``samples``, ``weight_bits``, ``keep_float``, ``max_drop``, ... as the flags of ``opendr optimize``; the
                calibration method as ``method``.

        Returns:
            ``bytes`` and ``accuracy`` before and after, and a report of the ``layers``.

        Raises:
            FileNotFoundError: No model is loaded.
            ValueError: An argument is missing, or an option is invalid.
        """
        if target_device:
            raise Unsupported(f"{type(self).__name__} cannot be optimized for {target_device!r}; give out and precision")
        out = under_older_name(out, "out", options, "output")
        if out is None:
            raise ValueError("out is missing; give the folder for the optimized model")
        if "method" in options:
            options["calibration"] = options.pop("method")
        given = {"precision": precision, **options}
        report, text = self._handle.optimize(os.fspath(out), given, calibration, validation, verbose)
        vars(self).update(self._handle.params())
        if verbose:
            print(text, end="")
        outcome: dict[str, Any] = json.loads(report)
        return outcome

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

    @property
    def classes(self) -> list[str]:
        """Names of the class indices: ``classes[0]`` is class 0; empty before ``load``."""
        return self._handle.classes

    @property
    def is_ready(self) -> bool:
        """Whether a model is loaded."""
        return self._handle.is_ready

    def __reduce__(self) -> NoReturn:
        raise TypeError(f"a {type(self).__name__} cannot be pickled or copied; save() it and load() it there")

    def _fit_params(self, given: dict[str, Any]) -> dict[str, Any]:
        """Returns the parameters of the training: those of the constructor, overridden by those of this call."""
        names, known = [field["name"] for field in self._entry["fit_params"]], parameters(type(self))
        # The value that was set, even where the attribute returns that of the loaded model.
        params = {name: Parameter.__get__(known[name], self) for name in names}
        for name, value in self._known(given, stacklevel=4).items():
            if name not in names:
                raise TypeError(f"fit has no argument {name!r}; the parameters of the training are {', '.join(names)}")
            params[name] = value
        return params

    def _known(self, arguments: dict[str, Any], stacklevel: int) -> dict[str, Any]:
        """Renames OpenDR's arguments to those of this package and drops, with a warning, those without effect."""
        fields = [*self._entry["params"], *self._entry["fit_params"]]
        renamed = {alias: field["name"] for field in fields for alias in (*field["aliases"], *field["former"])}
        choices = {field["name"]: field["choices"] for field in fields}
        owner, idle = type(self).__name__, dict(self._entry["without_effect"])
        known: dict[str, Any] = {}
        for given, value in arguments.items():
            name = renamed.get(given, given)
            if given in idle:
                warnings.warn(f"{owner}: {given} has no effect: {idle[given]}", UserWarning, stacklevel=stacklevel)
                continue
            if name in known:
                raise TypeError(f"{owner} got {name} twice (once as {given}); give it once")
            here = value_here(owner, self._row, name, value, choices.get(name, ()), stacklevel + 1)
            if here is not None or value is None:
                known[name] = here
        return known

    def _live_name(self, name: str) -> Optional[str]:
        """Returns the live parameter of this name or alias, or None."""
        live = (field for field in self._entry["params"] if field["live"])
        return next((field["name"] for field in live if name in (field["name"], *field["aliases"], *field["former"])), None)

    @contextlib.contextmanager
    def _temporarily(self, params: Mapping[str, Any]) -> Iterator[None]:
        """Sets parameters within a ``with`` block."""
        previous = {name: getattr(self, name) for name in params}
        try:
            for name, value in params.items():
                setattr(self, name, value)
            yield
        finally:
            for name, value in previous.items():
                setattr(self, name, value)

    def _arguments(self, inputs: tuple[Any, ...], named: dict[str, Any]) -> tuple[dict[str, Any], dict[str, Any]]:
        """Returns the inputs by port name, and the parameters of this call."""
        names = [port["name"] for port in self._entry["ports"]]
        if len(inputs) > len(names):
            raise TypeError(f"infer takes {len(names)} inputs ({', '.join(names)}), not {len(inputs)}")
        ports, overrides = dict(zip(names, inputs)), dict[str, Any]()
        live = {field["name"] for field in self._entry["params"] if field["live"]}
        known = parameters(type(self)) if named else {}
        for name, value in self._known(named, stacklevel=4).items():
            if name in ports:
                raise TypeError(f"infer got {name} twice; give it once")
            if name not in names and name not in live:
                available = ", ".join([*names, *sorted(live)])
                raise TypeError(f"infer has no argument {name!r}; its arguments are {available}")
            if name in names:
                ports[name] = value
            else:
                overrides[name] = known[name].checked(value)
        # None is the same as leaving an optional input out.
        may_lack = {port["name"] for port in self._entry["ports"] if port["optional"] or port["init"]}
        return {name: value for name, value in ports.items() if value is not None or name not in may_lack}, overrides

    def _infer_each(self, ports: dict[str, Any], overrides: dict[str, Any]) -> Iterator[Any]:
        """Yields the prediction for each input of the first port. Other ports that are lists or iterators advance with it;
        init ports are given with the first input."""
        table = self._entry["ports"]
        several = {
            port["name"]: iter(ports[port["name"]])
            for port in table
            if isinstance(ports.get(port["name"]), (list, tuple, Iterator)) and not port["init"]
        }
        same = {name: value for name, value in ports.items() if name not in several}
        for items in zip(*several.values()):
            yield self._infer_one(self._handle, {**same, **dict(zip(several, items))}, overrides)
            same = {port["name"]: same[port["name"]] for port in table if port["name"] in same and not port["init"]}

    def _infer_one(self, handle: Any, ports: dict[str, Any], overrides: dict[str, Any]) -> Any:
        outputs = handle.infer(self._values(ports), overrides) if overrides else handle.infer(self._values(ports))
        return self._prediction(outputs)

    def _values(self, ports: dict[str, Any]) -> dict[str, Any]:
        types = {port["name"]: port["type"] for port in self._entry["ports"]}
        return {name: _value(value, name, types[name]) for name, value in ports.items()}

    def _prediction(self, outputs: list[Any]) -> Any:
        from opendr._schema import target_from_json

        try:
            targets = [target_from_json(json, array) for _, json, array in outputs]
        except InvalidInput as error:
            raise InternalError(
                f"{self._entry['name']} returned an invalid target: {error}; check the model and its input"
            ) from error
        return targets[0] if len(targets) == 1 else self._outputs(*targets)

    #: The named tuple of several outputs.
    _outputs: ClassVar[Any] = None


class NativeLearner(NativeBase, Learner):
    """A learner of the registry that is evaluated and, if it supports training, trained on data sets."""

    def eval(
        self,
        dataset: Dataset,
        *,
        metric: Optional[str] = None,
        split: Optional[str] = None,
        limit: Optional[int] = None,
        out: Optional[PathLike] = None,
        skip_broken: bool = False,
        classes: Optional[Mapping[str, str]] = None,
        by_number: bool = False,
        resamples: int = 200,
        verbose: bool = False,
        **metric_params: Any,
    ) -> dict[str, Any]:
        """Evaluates the learner on a data set.

        Args:
            dataset: An ``ExternalDataset``, or any ``DatasetIterator`` of pairs of datum and target (a tuple of data for
                several inputs). Classes are matched by name; a data set of yours lists its class names in ``classes``.
            metric: Name of the metric (``opendr.metrics.names()``); by default that of the task.
            split: Split of an ``ExternalDataset``.
            limit: Maximum number of samples, from the first on.
            out: Folder for the predictions, ``report.json``, figures and a contact sheet of the samples with the lowest
                scores; an interrupted evaluation resumes from it.
            skip_broken: Whether broken samples are skipped and listed, instead of raising.
            classes: Classes of the data set by classes of the learner, where their names do not match.
            by_number: Whether classes are matched by index, regardless of their names.
            resamples: Bootstrap resamples for the interval of the main number; 0 leaves it out.
            verbose: Whether to show progress and print the outcome.
            metric_params: Parameters of the metric.

        Returns:
            The scalars by name (``"map"``, ``"map50"``, ...; docs/metrics.md), and under ``"report"`` the whole report:
            tables, figures, the samples with the lowest scores, the skipped samples.

        Raises:
            FileNotFoundError: No model is loaded, or the data set does not exist.
            ValueError: Data set, learner and metric do not fit together, or a sample is broken.
        """
        out = under_older_name(out, "out", metric_params, "folder")
        options = {
            "metric": metric,
            "metric_params": metric_params,
            "split": split,
            "limit": limit,
            "out": None if out is None else os.fspath(out),
            "skip_broken": skip_broken,
            "classes": dict(classes or {}),
            "by_number": by_number,
            "resamples": resamples,
        }
        report, text = self._handle.eval(dataset, json.dumps(options), verbose)
        if verbose:
            print(text, end="")
        outcome = json.loads(report)
        return {**outcome.get("scalars", {}), "report": outcome}

    def fit(
        self,
        dataset: Dataset,
        val_dataset: Optional[Dataset] = None,
        logging_path: PathLike = "",
        silent: bool = False,
        verbose: bool = True,
        *,
        out: Optional[PathLike] = None,
        resume: bool = False,
        split: Optional[str] = None,
        val_split: Optional[str] = None,
        limit: Optional[int] = None,
        teacher: Union[None, str, Learner] = None,
        teacher_threshold: Optional[float] = None,
        teacher_classes: Sequence[str] = (),
        teacher_map: Optional[Mapping[str, str]] = None,
        teacher_by_number: bool = False,
        keep_empty: bool = False,
        skip_broken: bool = False,
        **fit_params: Any,
    ) -> dict[str, Any]:
        """Trains the learner, from the loaded model if there is one, and loads the result.

        Ctrl-C saves a checkpoint and raises ``KeyboardInterrupt``; ``resume`` continues from it.

        Args:
            dataset: An ``ExternalDataset``, or any ``DatasetIterator`` of pairs of datum and target (a tuple of data for
                several inputs); a data set of yours lists its class names in ``classes``.
            val_dataset: Data set for the evaluation after each epoch.
            logging_path: Folder for TensorBoard's event files and curves; empty: none.
            silent: Whether to print nothing at all.
            verbose: Whether to print the outcome.
            out: Folder for checkpoints, report and, in ``model``, the trained container; by default ``temp_path`` or
                else ``runs/NAME-DATE``.
            resume: Whether to resume from the last checkpoint in ``out``, or in the last run of this learner.
            split: Split of an ``ExternalDataset`` to train on; by default its training split.
            val_split: Split for the evaluation, of ``val_dataset`` or, without it, of ``dataset``.
            limit: Maximum number of samples, from the first on.
            teacher: A loaded learner, or the name of a pretrained one (``"nanodet"``, ``"movenet/multipose"``), whose
                predictions are the annotations (distillation); ``dataset`` may then have none, or be a folder of images.
            teacher_threshold: Score below which the teacher's predictions are dropped; 0.5 by default.
            teacher_classes: Classes to learn from the teacher; by default those of the data set, or the teacher's.
            teacher_map: Classes to learn by classes of the teacher, where their names do not match.
            teacher_by_number: Whether the teacher's class indices are taken as they are, regardless of the names.
            keep_empty: Whether images without a prediction of the teacher are kept, as negative examples.
            skip_broken: Whether broken samples are skipped and listed, instead of raising.
            fit_params: Parameters of the training (docs/learners.md); by default those of the constructor.

        Returns:
            The curves (a list each, e.g. ``"loss"``) and scalars by name, and under ``"report"`` the whole report: the path
            of the model, the skipped samples.

        Raises:
            opendr.Unsupported: The learner cannot be trained, or this build has no training.
            ValueError: Data set, learner and parameters do not fit together, or a sample is broken.
            OSError: A file cannot be written.
        """
        place = under_older_name(out, "out", fit_params, "output") or self.temp_path or None
        options = {
            "params": self._fit_params(fit_params),
            "split": split,
            "val_split": val_split,
            "limit": limit,
            "out": None if place is None else os.fspath(place),
            "logging_path": os.fspath(logging_path) if logging_path else None,
            "resume": resume or self.checkpoint_load_iter > 0,
            "teacher": teacher if isinstance(teacher, str) else None,
            "teacher_threshold": teacher_threshold,
            "teacher_classes": list(teacher_classes),
            "teacher_map": dict(teacher_map or {}),
            "teacher_by_number": teacher_by_number,
            "keep_empty": keep_empty,
            "skip_broken": skip_broken,
        }
        given = None if isinstance(teacher, str) else _teacher(teacher)
        report, text = self._handle.fit(dataset, val_dataset, given, json.dumps(options), silent)
        vars(self).update(self._handle.params())
        if verbose and not silent:
            print(text, end="")
        outcome = json.loads(report)
        return {**outcome.get("curves", {}), **outcome.get("scalars", {}), "report": outcome}

    def fit_reference(
        self,
        path: PathLike,
        save_path: Optional[PathLike] = None,
        create_new: bool = True,
        *,
        silent: bool = True,
    ) -> dict[str, Any]:
        """Enrols persons from reference images, for learners whose ``fit`` has the parameter ``create_new``.

        Args:
            path: A folder with a folder of images for each person, whose name is the person's.
            save_path: Folder for the model with its references, in ``model``, and a report; by default ``temp_path`` or else
                ``runs/NAME-DATE``. ``save(path)`` writes the model anywhere.
            create_new: Whether the persons of the loaded model are removed.
            silent: Whether to print nothing.

        Returns:
            ``persons``, ``pictures``, and under ``"report"`` the whole report.

        Raises:
            opendr.Unsupported: The learner has no references.
            FileNotFoundError: The folder does not exist.
            ValueError: No model is loaded, or no face is detected in the images of a person.
        """
        from opendr.engine.datasets import ExternalDataset

        if all(field["name"] != "create_new" for field in self._entry["fit_params"]):
            self._cannot("fit_reference")
        dataset = ExternalDataset(os.fspath(path), "imagenet")
        return self.fit(dataset, silent=silent, out=save_path, create_new=create_new)


class Stream:
    """A stream with its own state over the model of a learner."""

    def __init__(self, learner: NativeBase) -> None:
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


def _value(value: Any, name: str, kind: str) -> Any:
    """Converts ``value`` to the data or target class ``kind``."""
    is_target = hasattr(target, kind)
    kind_class: Any = getattr(target if is_target else data, kind)
    if isinstance(value, kind_class):
        return value
    if kind in READ_FROM_FILES and isinstance(value, (str, os.PathLike)):
        return _opendr.open_value(kind, os.fspath(value))
    if kind == "Audio" and isinstance(value, data.Timeseries):
        return value  # Speech learners assume their own sample rate for it, as OpenDR's did.
    article = "an" if kind[0] in "AEIOU" else "a"
    if is_target or kind in OF_SEVERAL_PARTS:
        raise TypeError(f"{name} should be {article} {kind}, not {type(value).__name__}")
    if value is None or isinstance(value, (str, bytes)):
        raise TypeError(f"{name} should be {article} {kind} or an array of numbers, not {value!r:.100}")
    return kind_class(value)


def _teacher(teacher: Optional[Learner]) -> Any:
    """Converts a teacher to the argument of the native module."""
    if teacher is None:
        return None
    if isinstance(teacher, NativeBase):
        return teacher._handle
    name = registered_name(type(teacher))
    if name is None:
        raise TypeError(f"teacher should be a learner or a name, not {type(teacher).__name__}; register() your own classes")
    return name, teacher


def _sample(folder: Optional[str], verbose: bool) -> PathLike:
    import shutil

    path: PathLike = _opendr.sample("astronaut", verbose)
    if folder is None:
        return path
    os.makedirs(folder, exist_ok=True)
    copy: PathLike = shutil.copy(path, folder)
    return copy
