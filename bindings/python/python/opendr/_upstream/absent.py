"""Placeholders for names of OpenDR that are not available."""

from __future__ import annotations

from typing import Any, NoReturn

from opendr._errors import Unsupported


class _Missing(Unsupported, AttributeError):
    """An attribute of a name that is not available."""


class _Absent(type):
    """The metaclass of placeholders, which raise an error that names the replacement."""

    _text: str

    def __call__(cls, *args: Any, **kwargs: Any) -> NoReturn:
        raise Unsupported(cls._text)

    def __getitem__(cls, key: Any) -> NoReturn:
        raise Unsupported(cls._text)

    def __iter__(cls) -> NoReturn:
        raise Unsupported(cls._text)

    def __len__(cls) -> NoReturn:
        raise Unsupported(cls._text)

    def __getattr__(cls, name: str) -> NoReturn:
        raise _Missing(cls._text)


def absent(name: str, module: str, why: str) -> Any:
    """Returns a placeholder for ``name`` of ``module``: a class that can be imported and raises ``opendr.Unsupported`` with
    the message ``why`` when it is used."""
    return _Absent(name, (), {"__module__": module, "__doc__": why, "_text": why})
