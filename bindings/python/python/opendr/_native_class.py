"""Builds the classes of native learners from the tables of the registry."""

from __future__ import annotations

from collections import namedtuple
from importlib import import_module
from typing import Any, Optional

from opendr._native_arguments import Table
from opendr._native_base import NativeBase
from opendr._native_learner import NativeLearner
from opendr._native_learner_active import NativeLearnerActive
from opendr._native_learner_imitation import NativeLearnerImitation
from opendr._native_learner_rl import NativeLearnerRL
from opendr._reference import constructor, document, params_annotations
from opendr._upstream.arguments import methods
from opendr._upstream.modules import learner
from opendr._upstream.rows import Learner as Row
from opendr._upstream.rows import arguments
from opendr.engine import target
from opendr.engine._parameters import Parameter
from opendr.engine.learners import BaseLearner


def native_class(entry: Table, module: str) -> type[NativeBase]:
    """Builds the class ``class_name`` of a learner of the registry."""
    row = learner(f"{entry['package']}.{entry['task']}", entry["class_name"]) or Row()
    params = [{**field, "default": row.defaults.get(field["name"], field["default"])} for field in entry["params"]]
    entry = {**entry, "params": params}
    parent = _parent(entry, row)
    names = [output["name"] for output in entry["outputs"]]
    fields = [*entry["fit_params"], *entry["params"]]
    namespace: dict[str, Any] = {
        **{alias: _alias(field["name"]) for field in entry["fit_params"] for alias in field["aliases"]},
        **methods(row, parent),
        "__doc__": document(entry),
        "__module__": module,
        "__annotations__": params_annotations(entry),
        "_entry": entry,
        "_row": row,
        "_positional": arguments(row.init or " ".join(BaseLearner.__signature__.parameters)),
        "_outputs": staticmethod(namedtuple(f"{entry['class_name']}Outputs", names)),
        "_image_ports": _image_ports(entry["ports"]),
        **{field["name"]: field["default"] for field in fields},
    }
    built: Any = type(entry["class_name"], (parent,), namespace)
    built.__signature__ = constructor(built)
    if "classes" in {field["name"] for field in fields}:
        built.classes = _Classes(vars(built)["classes"])
    return built  # type: ignore[no-any-return]


def _image_ports(ports: list[Table]) -> list[str]:
    """Returns the names of the inputs with pixels: images, then targets."""
    images = [port["name"] for port in ports if port["type"] in ("Image", "ImageWithDetections")]
    return images + [port["name"] for port in ports if hasattr(target, port["type"])]


def _parent(entry: Table, row: Row) -> type[NativeBase]:
    if row.mixin:
        module, _, name = row.mixin.partition(":")
        mixin: type[NativeBase] = getattr(import_module(module), name)
        return mixin
    if not entry["fit_in"]:
        return NativeLearner
    acts = any(output["type"] == "RlTarget" for output in entry["outputs"])
    if not acts:
        return NativeLearnerActive
    return NativeLearnerImitation if entry["fit"] else NativeLearnerRL


class _Classes(Parameter):
    """The parameter ``classes``: the classes to train, or those of the model once one is loaded."""

    def __init__(self, parameter: Parameter) -> None:
        vars(self).update(vars(parameter))

    def __get__(self, instance: Any, owner: Optional[type] = None) -> Any:
        handle = None if instance is None else vars(instance).get("_handle")
        return handle and handle.classes or super().__get__(instance, owner)


def _alias(name: str) -> property:
    """Returns a property for OpenDR's name of a parameter."""
    return property(lambda self: getattr(self, name), lambda self, value: setattr(self, name, value))
