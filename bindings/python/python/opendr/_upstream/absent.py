"""What stands for names of OpenDR that are not here."""

from __future__ import annotations

from typing import Any, NoReturn

from opendr._errors import Unsupported


class _Missing(Unsupported, AttributeError):
    """An attribute of something that is not here."""


class _Absent(type):
    """The type of classes that only say what to use instead of them."""

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
    """A class that stands for ``name`` of ``module``: it can be imported, and raises ``opendr.Unsupported`` with the
    sentence ``why`` when it is used."""
    return _Absent(name, (), {"__module__": module, "__doc__": why, "_text": why})
