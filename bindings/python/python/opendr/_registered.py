"""Classes of the learners in the registry, native and written in Python."""

from __future__ import annotations

import sys
import types
from typing import Any, Optional, TypeVar

from opendr import _opendr
from opendr._errors import NotFound
from opendr._python_learners import PYTHON_LEARNERS
from opendr.engine.learners import BaseLearner, Learner

T = TypeVar("T", bound=type[BaseLearner])

#: OpenDR's drawing functions by target type.
_DRAWING = {"BoundingBoxList": ("draw_bounding_boxes",), "PoseList": ("draw", "get_bbox")}


def task_modules(package: types.ModuleType) -> None:
    """Creates the modules of a package of learners: one per task, with the task's learners and drawing functions."""
    from opendr import _drawing
    from opendr._native_class import native_class
    from opendr._upstream.modules import add_names

    created = {}
    for entry in _opendr.entries():
        if entry["name"] in PYTHON_LEARNERS or package.__name__ != f"opendr.{entry['package']}":
            continue
        name = f"{package.__name__}.{entry['task']}"
        module = sys.modules.get(name)
        if module is None:
            module = types.ModuleType(name, f"Learners of the task {entry['task']}.")
            # Programs of OpenDR search for files next to a learner's module.
            module.__dict__.update(__all__=[], __path__=[], __file__=package.__file__)
            created[name] = sys.modules[name] = module
            setattr(package, entry["task"], module)
        found = {entry["class_name"]: native_class(entry, name)}
        for output in entry["outputs"]:
            found.update({name: getattr(_drawing, name) for name in _DRAWING.get(output["type"], ())})
        module.__dict__.update(found)
        module.__dict__["__all__"] = sorted({*module.__dict__["__all__"], *found})
    for module in created.values():
        add_names(module)


def learners() -> dict[str, type[BaseLearner]]:
    """Returns the classes of all learners by their names in the registry, including those registered from Python."""
    import importlib

    classes: dict[str, type[BaseLearner]] = {}
    for entry in _opendr.entries():
        package = None if entry["name"] in PYTHON_LEARNERS else importlib.import_module(f"opendr.{entry['package']}")
        task = getattr(package, entry["task"], None)
        found = PYTHON_LEARNERS.get(entry["name"]) or getattr(task, entry["class_name"], None)
        if found is not None:
            classes[entry["name"]] = found
    return classes


def learner(spec: str, verbose: bool = True, **arguments: Any) -> Any:
    """Creates a learner by name and loads its pretrained model, which is downloaded the first time.

    Args:
        spec: A name such as ``"nanodet"``, optionally with a variant: ``"yunet/320"``.
        verbose: Whether to show the progress of a download.
        arguments: Arguments of the class.

    Raises:
        FileNotFoundError: The learner does not exist.
    """
    name, _, variant = spec.partition("/")
    classes = learners()
    if name not in classes:
        raise NotFound(f"unknown learner {name!r}; the learners are {', '.join(classes)}")
    if variant and name in PYTHON_LEARNERS:
        raise NotFound(f"the learner {name!r} has no pretrained models; use {name!r} and load() one of your own")
    created: Any = classes[name](**arguments)
    if name not in PYTHON_LEARNERS:
        created.load(verbose=verbose, variant=variant or None)
    return created


def list_models(
    task: Optional[str] = None, *, grade: Optional[str] = None, commercial: bool = False, cached: bool = False
) -> list[dict[str, Any]]:
    """Returns the pretrained models, one dictionary each: a table for ``pandas.DataFrame``.

    Keys are those of ``opendr models --json`` (docs/command-line.md): ``model``, ``task``, ``grade``, ``accuracy``, ``bytes``,
    ``licence``, ``fps`` and others. ``opendr.learner(model["model"])`` loads one.

    Args:
        task: Only models for this task, such as ``"object_detection_2d"``.
        grade: Only models of this grade or a better one: ``"real"`` (trained and measured on real data), ``"transfer"`` (measured on
            real data, trained on others) or ``"demonstration"``.
        commercial: Whether to leave out models whose licences do not allow commercial use, or do not say so.
        cached: Whether to list only models on this machine.

    Raises:
        ValueError: The task or the grade does not exist.
    """
    import json

    listed: list[dict[str, Any]] = json.loads(_opendr.list_models(task, grade, commercial, cached))
    return listed


def register(cls: T) -> T:
    """Adds a learner written in Python to the registry; usable as a decorator.

    ``opendr.learners()`` and ``python -m opendr`` then include it.

    Args:
        cls: A subclass of ``opendr.engine.learners.Learner``.

    Raises:
        TypeError: The class lacks something; the message lists what.
        ValueError: The name is taken.
    """
    from opendr.engine._declaration import tables_from_class

    tables = tables_from_class(cls)
    _opendr.register(cls, tables)
    PYTHON_LEARNERS[tables["name"]] = cls
    return cls


def register_installed() -> None:
    """Registers the learners of installed packages. One that fails is skipped with a warning."""
    from opendr import _entry_points

    for point in _entry_points.learner_entry_points():
        try:
            register(point.load())
        except Exception as error:
            _entry_points.warn(point, error)


def check_learner(name: str, model: str, scratch: str, calls: list[dict[str, Any]]) -> None:
    """Runs the test that every learner passes: parameters, errors, determinism, streams, saving.

    Args:
        name: The learner's name in the registry.
        model: Path of a model of the learner.
        scratch: Folder for temporary files.
        calls: Inputs of one stream in order, by port; at least two, which differ, each with a time stamp and a frame id.

    Raises:
        opendr.InternalError: A check failed; the message says which.
    """
    _opendr.check_learner(name, model, scratch, calls)


__all__ = ["Learner", "check_learner", "learner", "learners", "list_models", "register", "register_installed", "task_modules"]
