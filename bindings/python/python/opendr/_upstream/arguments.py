"""Conversion of arguments in OpenDR's order, with OpenDR's names and values, to those of this package."""

from __future__ import annotations

import functools
import inspect
import os
import warnings
from collections.abc import Iterable, Mapping, Sequence
from typing import Any, Callable, NoReturn

from opendr._errors import Unsupported
from opendr._upstream.rows import Argument, Learner, arguments

#: The methods whose arguments are converted.
METHODS = ("infer", "fit", "eval", "optimize", "load", "save")


def by_name(
    owner: str, expected: Sequence[Argument], given: Iterable[Any], named: Mapping[str, Any], stacklevel: int
) -> dict[str, Any]:
    """Returns the arguments under their names in this package; those without effect are dropped with a warning.

    Args:
        owner: Name of the class or method, for messages.
        expected: OpenDR's arguments, in order.
        given: The positional arguments.
        named: The keyword arguments, under OpenDR's names or ours.
        stacklevel: Frames from here to the caller that a warning names.

    Raises:
        TypeError: There are more positional arguments than OpenDR has, or an argument is given twice.
    """
    values = list(given)
    if len(values) > len(expected):
        raise TypeError(f"{owner} takes {len(expected)} positional arguments, not {len(values)}")
    found: dict[str, Any] = {}
    known = {argument.name: argument for argument in expected}
    for name, value in [*zip(known, values), *named.items()]:
        argument = known.get(name, Argument(name, name))
        if argument.ours is None:
            warnings.warn(f"{owner}: {name} has no effect: {argument.reason}", UserWarning, stacklevel=stacklevel)
        elif argument.ours in found:
            raise TypeError(f"{owner} got {argument.ours} twice; give it once")
        else:
            found[argument.ours] = value
    return found


def value_here(owner: str, row: Learner, name: str, value: Any, choices: Sequence[str], stacklevel: int) -> Any:
    """Converts a value that only OpenDR has to this package's; returns None for the default, with a warning.

    Raises:
        opendr.Unsupported: The value has no equivalent.
    """
    if str(value) in row.instead.get(name, "").split() and value not in choices:
        warnings.warn(
            f"{owner}: {name}={value!r} is not available; the default is used", UserWarning, stacklevel=stacklevel
        )
        return None
    if not isinstance(value, str) or value in choices:
        return value
    instead = row.without.get(name, {}).get(value)
    if instead is not None:
        raise Unsupported(f"{owner}: {name}={value!r}: {instead}")
    same = row.same.get(name, {})
    if value in same:
        return same[value]
    # OpenDR's empty schedule is a constant learning rate.
    if name == "lr_schedule" and value == "" and "constant" in choices:
        return "constant"
    return value


def positional(name: str, method: Callable[..., Any], expected: Sequence[Argument]) -> Callable[..., Any]:
    """Returns ``method`` with its arguments in OpenDR's order."""

    @functools.wraps(method)
    def call(self: Any, *given: Any, **named: Any) -> Any:
        owner = f"{type(self).__name__}.{name}"
        return method(self, **by_name(owner, expected, given, named, stacklevel=3))

    return call


def positional_eval(method: Callable[..., Any], expected: Sequence[Argument]) -> Callable[..., Any]:
    """Returns ``eval`` with its arguments in OpenDR's order; live parameters apply to the call only."""

    @functools.wraps(method)
    def call(self: Any, *given: Any, **named: Any) -> Any:
        owner = f"{type(self).__name__}.eval"
        found = by_name(owner, expected, given, named, stacklevel=3)
        if found.pop("silent", False):
            found["verbose"] = False
        subset, size = found.pop("use_subset", False), found.pop("subset_size", None)
        if subset:
            if size is None:
                raise TypeError(f"{owner}: use_subset needs the number of samples; give subset_size")
            found["limit"] = size
        live = {key: found.pop(key) for key in list(found) if self._live_name(key) is not None}
        with self._temporarily({self._live_name(key): value for key, value in live.items() if value is not None}):
            return method(self, **{key: value for key, value in found.items() if value is not None or key == "dataset"})

    return call


def positional_infer(method: Callable[..., Any], expected: Sequence[Argument]) -> Callable[..., Any]:
    """Returns ``infer`` with its arguments in OpenDR's order; None leaves a parameter unchanged."""

    @functools.wraps(method)
    def call(self: Any, *given: Any, **named: Any) -> Any:
        found = by_name(f"{type(self).__name__}.infer", expected, given, named, stacklevel=3)
        ports = {port["name"] for port in self._entry["ports"]}
        return method(self, **{name: value for name, value in found.items() if value is not None or name in ports})

    return call


def positional_load(method: Callable[..., Any], expected: Sequence[Argument]) -> Callable[..., Any]:
    """Returns ``load`` with its arguments in OpenDR's order; ``model_name`` is a folder in ``path``."""

    @functools.wraps(method)
    def call(self: Any, *given: Any, **named: Any) -> Any:
        found = by_name(f"{type(self).__name__}.load", expected, given, named, stacklevel=3)
        name, path = found.pop("model_name", None), found.get("path")
        if name is not None and path is not None and os.path.isdir(os.path.join(path, name)):
            found["path"] = os.path.join(path, name)
        return method(self, **found)

    return call


_SPECIAL: dict[str, Callable[..., Callable[..., Any]]] = {
    "infer": positional_infer,
    "eval": positional_eval,
    "load": positional_load,
}


def refused(name: str, instead: str) -> Callable[..., NoReturn]:
    """Returns a placeholder for a method of OpenDR, which raises an error that names the replacement."""

    def call(self: Any, *given: Any, **named: Any) -> NoReturn:
        raise Unsupported(f"{type(self).__name__} has no {name} yet; {instead}")

    call.__name__, call.__doc__ = name, f"Not available yet: {instead}."
    return call


def _signature(method: Callable[..., Any], expected: Sequence[Argument]) -> inspect.Signature:
    """Returns the signature of ``method`` with OpenDR's arguments as positional and all others as keyword arguments."""
    this, *others = inspect.signature(method).parameters.values()
    ours = {parameter.name: parameter for parameter in others}
    ordered = [this]
    for argument in expected:
        known = ours.pop(argument.ours or "", None)
        required = known is not None and known.default is known.empty and ordered[-1].default is known.empty
        default = inspect.Parameter.empty if required else None if known is None else known.default
        kind, hint = inspect.Parameter.POSITIONAL_OR_KEYWORD, Any if known is None else known.annotation
        ordered.append(inspect.Parameter(argument.name, kind, default=default, annotation=hint))
    left = [parameter for parameter in ours.values() if parameter.kind != parameter.VAR_POSITIONAL]
    named = [
        parameter if parameter.kind == parameter.VAR_KEYWORD else parameter.replace(kind=inspect.Parameter.KEYWORD_ONLY)
        for parameter in left
    ]
    return inspect.Signature([*ordered, *named])


def methods(row: Learner, parent: type) -> dict[str, Any]:
    """Returns the methods of a learner's class that differ from those of ``parent``."""
    from opendr._upstream.downloads import Download

    found: dict[str, Any] = {}
    for name in METHODS:
        expected = arguments(getattr(row, name))
        if expected:
            method, special = getattr(parent, name), _SPECIAL.get(name)
            call: Any = positional(name, method, expected) if special is None else special(method, expected)
            call.__signature__ = _signature(method, expected)
            found[name] = call
    if row.download or row.folder is not None or row.picture or row.modes:
        found["download"] = Download(row, parent)
    found.update({name: refused(name, instead) for name, instead in row.methods.items() if instead})
    return found
