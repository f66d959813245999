"""The rows of the table."""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple, Optional, Union

from opendr._upstream.reasons import REASONS


class Absent(NamedTuple):
    """A name of OpenDR that is not here yet."""

    #: What to use instead, as the rest of a sentence.
    use: str


#: Where a name is: the module that has it, nothing for a learner of the registry, or what to use instead.
Home = Union[str, Absent]
HERE = ""


class Argument(NamedTuple):
    """An argument of OpenDR's."""

    name: str
    #: Its name here; None without effect.
    ours: Optional[str]
    #: Why it has no effect.
    reason: str = ""


class Learner(NamedTuple):
    """A learner of OpenDR's that is here: the arguments of its methods in OpenDR's order.

    An argument is ``name``, ``name>ours`` for another name here, or ``name!reason`` without effect; an empty text
    leaves the method's own arguments.
    """

    init: str = ""
    infer: str = ""
    fit: str = ""
    eval: str = ""
    optimize: str = ""
    download: str = ""
    load: str = ""
    save: str = ""
    #: OpenDR's further methods, and what to use instead of them, or nothing where they are here.
    methods: Mapping[str, str] = {}
    #: The class that adds what only this learner has, ``module:class``.
    mixin: str = ""
    #: Values of arguments that only OpenDR has: the value here that means the same.
    same: Mapping[str, Mapping[str, str]] = {}
    #: Values of arguments that only OpenDR has, separated by blanks; the default here takes their place.
    instead: Mapping[str, str] = {}
    #: Values of arguments that are not here, and what to use instead.
    without: Mapping[str, Mapping[str, str]] = {}
    #: The folder below ``path`` that ``download`` makes; ``{argument=default}`` stands for an argument.
    folder: Optional[str] = None
    #: Names of OpenDR's models in whose place the default model here comes, separated by blanks.
    models: str = ""
    #: Modes of ``download`` that have another name here.
    modes: Mapping[str, str] = {}
    #: The file that ``download(mode="images")`` makes.
    picture: str = ""
    #: Whether ``download`` also loads the model.
    loads: bool = False
    #: Whether it needs no model: it is loaded when it is first used.
    ready: bool = False
    #: OpenDR's demos that were followed line by line.
    demos: str = ""
    #: What remained different, a sentence each.
    differs: tuple[str, ...] = ()


def arguments(text: str) -> tuple[Argument, ...]:
    """The arguments that a text of the table stands for."""
    return tuple(_argument(word) for word in text.split())


def _argument(word: str) -> Argument:
    name, mark, reason = word.partition("!")
    if mark:
        return Argument(name, None, REASONS[reason])
    name, mark, ours = word.partition(">")
    return Argument(name, ours if mark else name)
