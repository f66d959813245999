"""Parameters of learners, declared as annotations of their class."""

from __future__ import annotations

import inspect
import sys
import types
from collections.abc import Container
from dataclasses import dataclass
from typing import Annotated, Any, Literal, Optional, Union, get_args, get_origin

from opendr.engine._checks import whole


@dataclass(frozen=True)
class Range:
    """The range of a numeric parameter, both ends included."""

    low: float
    high: float


@dataclass(frozen=True)
class Unit:
    """The unit of a parameter, e.g. ``Unit("px")``."""

    name: str


@dataclass(frozen=True)
class Live:
    """The parameter may change while the learner runs."""


_KINDS: dict[Any, str] = {float: "float", int: "int", bool: "bool", str: "text", list: "list"}
_ARTICLES = {"float": "a float", "int": "an int", "bool": "a bool", "text": "a str", "list": "a list"}


class Parameter:
    """One parameter of a class: a descriptor that checks assigned values. On the class itself it is the default."""

    def __init__(self, owner: type, name: str, hint: Any, default: Any) -> None:
        value_type, *extras = get_args(hint)
        value_type, self.optional = without_none(value_type)
        self.choices: tuple[str, ...] = ()
        if get_origin(value_type) is Literal:
            self.choices = get_args(value_type)
            value_type = str if all(isinstance(choice, str) for choice in self.choices) else None
        self.item = next(iter(get_args(value_type)), None)
        self.name = name
        self.kind = _KINDS.get(get_origin(value_type) or value_type, "")
        self.doc = next((extra for extra in extras if isinstance(extra, str)), "")
        self.range = next((extra for extra in extras if isinstance(extra, Range)), None)
        self.unit = next((extra.name for extra in extras if isinstance(extra, Unit)), "")
        self.live = any(isinstance(extra, Live) or extra is Live for extra in extras)
        self.hint = hint
        self.__doc__ = self.doc
        where = f"{owner.__name__}.{name}"
        if not self.kind:
            raise TypeError(f"{where} has the unsupported type {value_type}; use float, int, bool, str, list or Literal['...']")
        if default is inspect.Parameter.empty:
            raise TypeError(f"{where} has no default; write `{name}: Annotated[...] = value`")
        self.default = self.checked(default)

    def __get__(self, instance: Any, owner: Optional[type] = None) -> Any:
        if instance is None:
            return self.default
        default = self.default
        return instance.__dict__.setdefault(self.name, list(default) if isinstance(default, list) else default)

    def __set__(self, instance: Any, value: Any) -> None:
        instance.__dict__[self.name] = self.checked(value)

    def checked(self, value: Any) -> Any:
        """Returns ``value`` in the parameter's type.

        Raises:
            TypeError: The value is of another type.
            ValueError: The value is out of range, or not one of the choices.
        """
        if value is None and self.optional:
            return None
        if self.kind == "list":
            if not isinstance(value, (list, tuple)):
                raise self._wrong_type(value)
            return [self._checked(item, _KINDS.get(self.item, "")) for item in value]
        return self._checked(value, self.kind)

    def _checked(self, value: Any, kind: str) -> Any:
        if kind in ("int", "float") and not isinstance(value, bool):
            try:
                value = whole(value, self.name) if kind == "int" else _number(value)
            except TypeError:
                raise self._wrong_type(value) from None
            # NaN fails every comparison.
            low, high = (self.range.low, self.range.high) if self.range else (-sys.float_info.max, sys.float_info.max)
            if not low <= value <= high:
                problem = f"is out of range {low} to {high}" if self.range else "is not finite; give a finite number"
                raise ValueError(f"{self.name} = {value} {problem}")
        elif kind and not isinstance(value, {"bool": bool, "text": str}.get(kind, ())):
            raise self._wrong_type(value)
        if self.choices and value not in self.choices:
            raise ValueError(f"{self.name} = {value!r}: give one of {', '.join(self.choices)}")
        return value

    def _wrong_type(self, value: Any) -> TypeError:
        return TypeError(f"{self.name} should be {_ARTICLES[self.kind]}, not {value!r:.100}")

    def table(self) -> dict[str, Any]:
        """Returns the table of the parameter for the registry."""
        return {
            "name": self.name,
            "doc": self.doc,
            "kind": self.kind,
            "optional": self.optional,
            "choices": list(self.choices),
            "range": (self.range.low, self.range.high) if self.range else None,
            "unit": self.unit,
            "live": self.live,
            "default": self.default,
        }


def _number(value: Any) -> float:
    if isinstance(value, (str, bytes)):
        raise TypeError
    return float(value)


def without_none(hint: Any) -> tuple[Any, bool]:
    """Returns the type without ``None``, and whether it was optional."""
    union_types = (Union, getattr(types, "UnionType", Union))
    if get_origin(hint) not in union_types:
        return hint, False
    members = tuple(member for member in get_args(hint) if member is not type(None))
    return (members[0] if len(members) == 1 else Union[members]), len(members) < len(get_args(hint))


def declare(cls: type) -> None:
    """Converts the ``Annotated`` attributes of ``cls`` itself to parameters; plain values that it assigns to parameters of
    its bases become their defaults.

    Raises:
        TypeError: A parameter has no default, or an unsupported type.
        ValueError: A default is out of range.
    """
    inherited = parameters(cls)
    hints = {
        name: known.hint for name, known in inherited.items() if not hasattr(vars(cls).get(name, known), "__get__")
    }
    for name, hint in {**hints, **own_annotations(cls)}.items():
        if get_origin(hint) is Annotated:
            setattr(cls, name, Parameter(cls, name, hint, cls.__dict__.get(name, inspect.Parameter.empty)))


def parameters(cls: type) -> dict[str, Parameter]:
    """Returns the parameters of ``cls``, those of its bases first."""
    found: dict[str, Parameter] = {}
    for base in reversed(cls.__mro__):
        found.update((name, value) for name, value in vars(base).items() if isinstance(value, Parameter))
    return found


def own_annotations(cls: type) -> dict[str, Any]:
    """Returns the annotations of ``cls`` itself; those that are strings are evaluated if they contain ``Annotated``."""
    if sys.version_info >= (3, 10):
        annotations = inspect.get_annotations(cls)
    else:
        annotations = cls.__dict__.get("__annotations__", {})
    scope = getattr(sys.modules.get(cls.__module__), "__dict__", {})
    return {
        name: eval(hint, scope, dict(vars(cls))) if isinstance(hint, str) and "Annotated" in hint else hint
        for name, hint in annotations.items()
    }


def signature(cls: type, positional: Container[str]) -> inspect.Signature:
    """Returns the constructor's signature: parameters in ``positional`` by position or name, all others by name only."""
    arguments = []
    for name, parameter in parameters(cls).items():
        kind = inspect.Parameter.POSITIONAL_OR_KEYWORD if name in positional else inspect.Parameter.KEYWORD_ONLY
        hint, default = get_args(parameter.hint)[0], parameter.default
        arguments.append(inspect.Parameter(name, kind, default=default, annotation=hint))
    return inspect.Signature(arguments)
