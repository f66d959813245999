"""Annotations, signatures and docstrings of the learners, from the tables of the registry."""

from __future__ import annotations

import inspect
import textwrap
from typing import Annotated, Any, Literal, Optional

from opendr.engine._parameters import Live, Range, Unit, signature

Table = dict[str, Any]
_TYPES: dict[str, Any] = {"float": float, "int": int, "bool": bool, "text": str, "list": list}


def params_annotations(entry: Table) -> dict[str, Any]:
    """Returns the annotations of a learner's class: its parameters and those of its training."""
    return {field["name"]: _annotation(field) for field in (*entry["fit_params"], *entry["params"])}


def _annotation(field: Table) -> Any:
    hint: Any = Literal[tuple(field["choices"])] if field["choices"] else _TYPES[field["kind"]]
    if field["optional"]:
        hint = Optional[hint]
    extras: list[Any] = [field["doc"]]
    if field["range"] is not None:
        extras.append(Range(*field["range"]))
    if field["unit"]:
        extras.append(Unit(field["unit"]))
    if field["live"]:
        extras.append(Live())
    return Annotated[tuple([hint, *extras])]


def constructor(cls: Any) -> inspect.Signature:
    """Returns the signature of a learner's constructor: the positional arguments, then the keyword arguments."""
    known = signature(cls, positional=()).parameters
    fields = (*cls._entry["fit_params"], *cls._entry["params"])
    renamed = {alias: field["name"] for field in fields for alias in field["aliases"]}
    positional = {}
    for argument in cls._positional:
        ours = known.get(renamed.get(argument.name, argument.name))
        default, hint = (None, Any) if ours is None else (ours.default, ours.annotation)
        kind = inspect.Parameter.POSITIONAL_OR_KEYWORD
        positional[argument.name] = inspect.Parameter(argument.name, kind, default=default, annotation=hint)
    return inspect.Signature([*positional.values(), *(known[name] for name in known if name not in positional)])


def document(entry: Table) -> str:
    """Returns the docstring of a learner's class."""
    inputs = "\n".join(_line(port["name"], _port(port)) for port in entry["ports"])
    outputs = ", ".join(output["type"] for output in entry["outputs"])
    params = "\n".join(_line(field["name"], _param(field)) for field in entry["params"])
    idle = "\n".join(_line(name, f"no effect: {reason}.") for name, reason in entry["without_effect"])
    parts = [
        entry["about"],
        f"Task: {entry['task']}. ``infer`` takes:\n\n{inputs}\n\nand returns: {outputs}.",
        f"Args:\n{params}\n    others: OpenDR's arguments, see ``opendr.engine.learners.BaseLearner``.",
    ]
    if entry["fit_params"]:
        own = {field["name"] for field in entry["params"]}
        training = "\n".join(_line(field["name"], _param(field)) for field in entry["fit_params"] if field["name"] not in own)
        parts.append(f"Parameters of ``fit``, for one call or, given here, for all of them:\n{training}")
    if idle:
        parts.append(f"Arguments of OpenDR that are accepted and have no effect:\n{idle}")
    return "\n\n".join(parts)


def _port(port: Table) -> str:
    notes = ["with the first input of a stream"] if port["init"] else []
    notes += ["optional"] if port["optional"] and not port["init"] else []
    kind = f"{port['type']}{' (' + ', '.join(notes) + ')' if notes else ''}."
    return f"{kind} {inspect.cleandoc(port['doc'])}".rstrip()


def _param(field: Table) -> str:
    notes = [f"default {field['default']!r}"]
    if field["range"] is not None:
        low, high = field["range"]
        notes.append(f"{low:g} to {high:g}{' ' + field['unit'] if field['unit'] else ''}")
    if field["choices"]:
        notes.append("one of " + ", ".join(map(repr, field["choices"])))
    if field["live"]:
        notes.append("live: may change while running, and for one call of infer")
    if field["aliases"]:
        notes.append("in OpenDR " + ", ".join(field["aliases"]))
    return f"{inspect.cleandoc(field['doc'])} ({'; '.join(notes)})"


def _line(name: str, text: str) -> str:
    return textwrap.fill(f"{name}: {text}", 110, initial_indent=" " * 4, subsequent_indent=" " * 8)
