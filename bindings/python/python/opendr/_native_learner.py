"""The class that all compiled learners come from: one for all, since the registry tells what each takes."""

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
#: What a path may stand for: pictures, videos and folders of frames, WAVE, tables (CSV, text, NPY), scans as KITTI has them.
IN_FILES = ("Image", "Video", "Audio", "Timeseries", "Vector", "SkeletonSequence", "PointCloud")
#: Data that no array alone can stand for.
OF_SEVERAL_PARTS = ("Audio", "Calibration", "ImageWithDetections", "PointCloudWithCalibration")


class NativeBase(BaseLearner):
    """A learner of the registry; its class, parameters, inputs and outputs come from there.

    It is empty after construction. ``download()`` and ``load()`` get it a pretrained model, ``load(path)`` one of your
    own. One learner serves many threads: calls wait for each other, ``stream()`` gives each its own memory.
    """

    _entry: ClassVar[Table]
    #: OpenDR's row of this learner.
    _row: ClassVar[Row] = Row()
    #: The arguments of the constructor, by place.
    _places: ClassVar[Sequence[Argument]] = ()

    def __init__(self, *args: Any, **kwargs: Any) -> None:
        given = by_name(type(self).__name__, self._places, args, kwargs, stacklevel=3)
        idle = dict(self._entry["without_effect"])
        #: OpenDR's arguments without effect; some name the folder that OpenDR's programs load from.
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
        """Answers one input, or each of several.

        Args:
            inputs: The inputs, in the order of the learner's ports; also by name. A picture may be an ``Image``, an
                array (layout guessed by the rule of ``Image``), or the path of a file; so may a sound (WAVE), a series
                (CSV, NPY) and a scan (KITTI's). A list of inputs gives the list of their answers, an iterator such as
                a ``Source`` an iterator of them.
            arguments: Inputs by name, and live parameters for this call only.

        Returns:
            The target; a named tuple of targets where the learner has several outputs. They carry the time stamp and
            frame of the input.

        Raises:
            FileNotFoundError: Nothing is loaded yet, or a file is not there.
            TypeError: Something is of another type than the learner takes.
            ValueError: A value is out of range.
            opendr.InternalError: The network gave NaN or an infinite number; the text says where.
        """
        ports, overrides = self._arguments(inputs, arguments)
        first = ports.get(self._entry["ports"][0]["name"])
        if isinstance(first, Iterator):
            return self._each(ports, overrides)
        if isinstance(first, (list, tuple)):
            init = {port["name"] for port in self._entry["ports"] if port["init"]}
            items = {name: value for name, value in ports.items() if name not in init}
            lengths = {name: len(value) for name, value in items.items() if isinstance(value, (list, tuple))}
            if len(set(lengths.values())) > 1:
                raise ValueError(f"the inputs differ in number: {lengths}; give as many of each")
            return list(self._each(ports, overrides))
        return self._one(self._handle, ports, overrides)

    def load(self, path: Optional[PathLike] = None, verbose: bool = False, *, variant: Optional[str] = None) -> bool:
        """Loads a model.

        Args:
            path: A model container: a folder, its ``model.json``, or a zip. None loads the pretrained model, which is
                downloaded when it is not in the cache.
            verbose: Whether to show the progress of a download.
            variant: Which of the pretrained models; the default one when left out.

        Raises:
            FileNotFoundError: It is not there.
            ValueError: It is of another learner, or damaged.
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
        """Gets a pretrained model, or pictures to try it on.

        Args:
            path: Folder for a copy; None leaves it in the cache, where ``load()`` finds it.
            mode: ``"pretrained"`` for the model, ``"images"`` for a sample picture.
            verbose: Whether to show progress.
            url: Not taken: models are named by cards; ``OPENDR_MODEL_REPOSITORY`` names a server of your own.
            variant: Which of the pretrained models; the default one when left out.

        Returns:
            What ``load`` takes: the model's folder (``path/<learner>/<variant>``, or what OpenDR called it, such as
            ``path/ssd_default_person``); for images the picture's file.

        Raises:
            ValueError: There is no such mode, or a file is not the one of the card.
            ConnectionError: A server could not be reached.
        """
        if url is not None:
            raise Unsupported("download takes no url; set OPENDR_MODEL_REPOSITORY to a server or folder of your own")
        folder = None if path is None else os.fspath(path)
        if mode == "pretrained":
            return os.fspath(_opendr.download(self._entry["name"], variant, folder, verbose))
        if mode == "images":
            return os.fspath(_sample(folder, verbose))
        raise ValueError(f"download has no mode {mode!r}; there are 'pretrained' and 'images'")

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
        """Makes the loaded model smaller and faster, writes it as a container, and loads it.

        Args:
            target_device: Not taken: the result runs on every device.
            out: Folder for the container.
            precision: ``"int8"``: a quarter of the size, needs ``calibration``; ``"fp16"``: half the size.
            calibration: What the learner looks at to find the ranges of its values; annotations are not needed.
            validation: What it is measured on before and after.
            verbose: Whether to show progress and print the report.
            options: ``samples``, ``weight_bits``, ``keep_float``, ``max_drop``, ... as the flags of ``opendr optimize``; the
                way ranges are found as ``method``.

        Returns:
            ``bytes`` and ``accuracy`` before and after, and a report of the ``layers``.

        Raises:
            FileNotFoundError: Nothing is loaded.
            ValueError: Something is missing, or an option is wrong.
        """
        if target_device:
            raise Unsupported(f"{type(self).__name__} cannot optimize for {target_device!r}; give out and precision")
        out = under_older_name(out, "out", options, "output")
        if out is None:
            raise ValueError("optimize writes a model; give out, the folder for it")
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
        """Forgets what was seen: the next input begins anew."""
        self._handle.reset()

    def stream(self) -> Stream:
        """A memory of its own over the same model, for another camera or thread.

        Raises:
            FileNotFoundError: Nothing is loaded.
        """
        return Stream(self)

    def push(self, *piece: Any, **named: Any) -> list[Any]:
        """Takes the next piece of the input; what it answers so far.

        Raises:
            opendr.Unsupported: This learner takes no pieces.
        """
        ports, _ = self._arguments(piece, named)
        return [self._answer(outputs) for outputs in self._handle.push(self._values(ports))]

    def flush(self) -> list[Any]:
        """Ends the input that was taken in pieces; what is left to answer.

        Raises:
            opendr.Unsupported: This learner takes no pieces.
        """
        return [self._answer(outputs) for outputs in self._handle.push(None)]

    @property
    def classes(self) -> list[str]:
        """What class numbers mean: ``classes[0]`` is class 0; empty before ``load``."""
        return self._handle.classes

    @property
    def is_ready(self) -> bool:
        """Whether a model is loaded."""
        return self._handle.is_ready

    def __reduce__(self) -> NoReturn:
        raise TypeError(f"a {type(self).__name__} cannot be pickled or copied; save() it, and load() it there")

    def _fit_params(self, given: dict[str, Any]) -> dict[str, Any]:
        """The parameters of the training: those of this call over those of the constructor."""
        names, known = [field["name"] for field in self._entry["fit_params"]], parameters(type(self))
        # What was set, even where the attribute says what the loaded model has.
        params = {name: Parameter.__get__(known[name], self) for name in names}
        for name, value in self._known(given, stacklevel=4).items():
            if name not in names:
                raise TypeError(f"fit has no argument {name!r}; parameters of the training: {', '.join(names)}")
            params[name] = value
        return params

    def _known(self, arguments: dict[str, Any], stacklevel: int) -> dict[str, Any]:
        """Arguments under the names they have here; those without effect are left out, with a warning."""
        fields = [*self._entry["params"], *self._entry["fit_params"]]
        renamed = {alias: field["name"] for field in fields for alias in field["aliases"]}
        choices = {field["name"]: field["choices"] for field in fields}
        owner, idle = type(self).__name__, dict(self._entry["without_effect"])
        known: dict[str, Any] = {}
        for given, value in arguments.items():
            name = renamed.get(given, given)
            if given in idle:
                warnings.warn(f"{owner}: {given} has no effect: {idle[given]}", UserWarning, stacklevel=stacklevel)
                continue
            if name in known:
                raise TypeError(f"{owner} got {name} twice (also as {given}); give it once")
            here = value_here(owner, self._row, name, value, choices.get(name, ()), stacklevel + 1)
            if here is not None or value is None:
                known[name] = here
        return known

    def _live_name(self, name: str) -> Optional[str]:
        """The live parameter that ``name`` stands for, if any."""
        live = (field for field in self._entry["params"] if field["live"])
        return next((field["name"] for field in live if name in (field["name"], *field["aliases"])), None)

    @contextlib.contextmanager
    def _for_now(self, params: Mapping[str, Any]) -> Iterator[None]:
        """Sets parameters for a while."""
        kept = {name: getattr(self, name) for name in params}
        try:
            for name, value in params.items():
                setattr(self, name, value)
            yield
        finally:
            for name, value in kept.items():
                setattr(self, name, value)

    def _arguments(self, inputs: tuple[Any, ...], named: dict[str, Any]) -> tuple[dict[str, Any], dict[str, Any]]:
        """The inputs by port, and the parameters of this call."""
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
                there = ", ".join([*names, *sorted(live)])
                raise TypeError(f"infer has no argument {name!r}; there are {there}")
            if name in names:
                ports[name] = value
            else:
                overrides[name] = known[name].checked(value)
        # None stands for what is left out, where that may be.
        may_lack = {port["name"] for port in self._entry["ports"] if port["optional"] or port["init"]}
        return {name: value for name, value in ports.items() if value is not None or name not in may_lack}, overrides

    def _each(self, ports: dict[str, Any], overrides: dict[str, Any]) -> Iterator[Any]:
        """The answers to the first port's inputs one after the other; other ports go along item by item where they are
        lists or iterators, init ports go with the first."""
        table = self._entry["ports"]
        several = {
            port["name"]: iter(ports[port["name"]])
            for port in table
            if isinstance(ports.get(port["name"]), (list, tuple, Iterator)) and not port["init"]
        }
        same = {name: value for name, value in ports.items() if name not in several}
        for items in zip(*several.values()):
            yield self._one(self._handle, {**same, **dict(zip(several, items))}, overrides)
            same = {port["name"]: same[port["name"]] for port in table if port["name"] in same and not port["init"]}

    def _one(self, handle: Any, ports: dict[str, Any], overrides: dict[str, Any]) -> Any:
        outputs = handle.infer(self._values(ports), overrides) if overrides else handle.infer(self._values(ports))
        return self._answer(outputs)

    def _values(self, ports: dict[str, Any]) -> dict[str, Any]:
        types = {port["name"]: port["type"] for port in self._entry["ports"]}
        return {name: _value(value, name, types[name]) for name, value in ports.items()}

    def _answer(self, outputs: list[Any]) -> Any:
        from opendr._schema import target_from_json

        try:
            answers = [target_from_json(json, array) for _, json, array in outputs]
        except InvalidInput as error:
            raise InternalError(
                f"{self._entry['name']} gave what is no target: {error}; mend the model, or its input"
            ) from error
        return answers[0] if len(answers) == 1 else self._outputs(*answers)

    #: The named tuple of several outputs.
    _outputs: ClassVar[Any] = None


class NativeLearner(NativeBase, Learner):
    """A learner of the registry that is measured, and where it can, trained on data sets."""

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
        """Measures the learner on a data set.

        Args:
            dataset: An ``ExternalDataset``, or any ``DatasetIterator`` of pairs of datum and target (a tuple of data for
                several inputs). Classes are matched by name; a data set of yours names its own in a list ``classes``.
            metric: What to measure by (``opendr.metrics.names()``); by default the task's own.
            split: The part of an ``ExternalDataset``.
            limit: Only the first so many samples.
            out: Folder for the predictions, ``report.json``, figures and a sheet of the worst samples; an evaluation that
                was broken off goes on from there.
            skip_broken: Whether what is broken is left out and listed, instead of ending it.
            classes: Classes of the data set by classes of the learner, where their names do not match.
            by_number: Whether numbers of classes are compared, whatever their names are.
            resamples: Bootstrap resamples for the interval of the main number; 0 leaves it out.
            verbose: Whether to show progress and print the outcome.
            metric_params: Parameters of the metric.

        Returns:
            The numbers by name (``"map"``, ``"map50"``, ...; docs/metrics.md), and under ``"report"`` all there is:
            tables, figures, the worst samples, what was left out.

        Raises:
            FileNotFoundError: Nothing is loaded, or the data set is not there.
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
        """Trains the learner, from the loaded model where there is one, and loads the result.

        Ctrl-C saves what was done and raises ``KeyboardInterrupt``; ``resume`` goes on from there.

        Args:
            dataset: An ``ExternalDataset``, or any ``DatasetIterator`` of pairs of datum and target (a tuple of data for
                several inputs); a data set of yours names its classes in a list ``classes``.
            val_dataset: What to measure on after each epoch.
            logging_path: Folder of TensorBoard's event files and of curves; empty: none.
            silent: Whether to show nothing at all.
            verbose: Whether to print the outcome.
            out: Folder of checkpoints, report and, in ``model``, the trained container; by default ``temp_path`` or
                else ``runs/NAME-DATE``.
            resume: Whether to go on from the last checkpoint in ``out``, or in the last run of this learner.
            split: The part of an ``ExternalDataset`` to train on; by default the one for that.
            val_split: The part to measure on, of ``val_dataset`` or, without it, of ``dataset``.
            limit: Only the first so many samples.
            teacher: A loaded learner, or the name of a pretrained one (``"nanodet"``, ``"movenet/multipose"``), whose
                answers are learned from; ``dataset`` may then be without annotations, or a folder of pictures.
            teacher_threshold: The teacher's answers below this score are dropped; 0.5 by default.
            teacher_classes: What is learned from the teacher; by default the classes of the data set, or the teacher's.
            teacher_map: Classes to learn by classes of the teacher, where their names do not match.
            teacher_by_number: Whether numbers of the teacher's classes are taken as they are, whatever their names are.
            keep_empty: Whether pictures in which the teacher finds nothing are kept, as examples of nothing.
            skip_broken: Whether what is broken is left out and listed, instead of ending it.
            fit_params: Parameters of the training (docs/learners.md); by default those the constructor was given.

        Returns:
            The curves (a list each, e.g. ``"loss"``) and numbers by name, and under ``"report"`` all there is: where the
            model lies, what was left out.

        Raises:
            opendr.Unsupported: This learner does not train, or this build has no training.
            ValueError: Data set, learner and parameters do not fit together, or a sample is broken.
            OSError: Something cannot be written.
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
        """Makes persons known by reference pictures, for learners whose ``fit`` takes such (``create_new``).

        Args:
            path: A folder with a folder of pictures for each person, called as the person is.
            save_path: Folder for the model with its references, in ``model``, and a report; by default ``temp_path`` or else
                ``runs/NAME-DATE``. ``save(path)`` writes the model anywhere.
            create_new: Whether the persons that the model knows are forgotten.
            silent: Whether to show nothing.

        Returns:
            ``persons``, ``pictures``, and under ``"report"`` all there is.

        Raises:
            opendr.Unsupported: This learner takes no references.
            FileNotFoundError: There is no folder.
            ValueError: No model is loaded, or a person has no picture with a face.
        """
        from opendr.engine.datasets import ExternalDataset

        if all(field["name"] != "create_new" for field in self._entry["fit_params"]):
            self._cannot("fit_reference")
        dataset = ExternalDataset(os.fspath(path), "imagenet")
        return self.fit(dataset, silent=silent, out=save_path, create_new=create_new)


class Stream:
    """A memory of its own over the model of a learner."""

    def __init__(self, learner: NativeBase) -> None:
        self._learner = learner
        self._stream = learner._handle.stream()

    def infer(self, *inputs: Any, **named: Any) -> Any:
        """Answers one input, as ``infer`` of the learner does."""
        ports, overrides = self._learner._arguments(inputs, named)
        if overrides:
            raise TypeError(f"a stream takes no parameters ({', '.join(overrides)}); set them on the learner")
        return self._learner._one(self._stream, ports, {})

    def push(self, *piece: Any, **named: Any) -> list[Any]:
        """Takes the next piece of the input, as ``push`` of the learner does."""
        ports, _ = self._learner._arguments(piece, named)
        return [self._learner._answer(outputs) for outputs in self._stream.push(self._learner._values(ports))]

    def flush(self) -> list[Any]:
        """Ends the input that was taken in pieces; what is left to answer."""
        return [self._learner._answer(outputs) for outputs in self._stream.push(None)]

    def reset(self) -> None:
        """Forgets what was seen."""
        self._stream.reset()


def _value(value: Any, name: str, kind: str) -> Any:
    """``value`` as the data or target class ``kind``."""
    is_target = hasattr(target, kind)
    wanted: Any = getattr(target if is_target else data, kind)
    if isinstance(value, wanted):
        return value
    if kind in IN_FILES and isinstance(value, (str, os.PathLike)):
        return _opendr.open_value(kind, os.fspath(value))
    if kind == "Audio" and isinstance(value, data.Timeseries):
        return value  # Speech learners take it at the rate they are made for, as OpenDR's did.
    article = "an" if kind[0] in "AEIOU" else "a"
    if is_target or kind in OF_SEVERAL_PARTS:
        raise TypeError(f"{name} should be {article} {kind}, not {type(value).__name__}")
    if value is None or isinstance(value, (str, bytes)):
        raise TypeError(f"{name} should be {article} {kind} or an array of numbers, not {value!r:.100}")
    return wanted(value)


def _teacher(teacher: Optional[Learner]) -> Any:
    """A teacher as the native half takes it."""
    if teacher is None:
        return None
    if isinstance(teacher, NativeBase):
        return teacher._handle
    name = registered_name(type(teacher))
    if name is None:
        raise TypeError(f"teacher should be a learner or a name, not {type(teacher).__name__}; register() a class of yours")
    return name, teacher


def _sample(folder: Optional[str], verbose: bool) -> PathLike:
    import shutil

    picture: PathLike = _opendr.sample("astronaut", verbose)
    if folder is None:
        return picture
    os.makedirs(folder, exist_ok=True)
    copy: PathLike = shutil.copy(picture, folder)
    return copy
