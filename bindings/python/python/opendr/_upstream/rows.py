"""Types of the rows of the table."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, NamedTuple, Optional, Union

from opendr._upstream.reasons import REASONS


class Absent(NamedTuple):
    """A name of OpenDR that is not available yet."""

    #: The replacement, as the end of a sentence.
    use: str


class Runs(NamedTuple):
    """A learner of OpenDR whose networks a learner of the registry runs, exported to ONNX."""

    #: The class of that learner, ``module:class``.
    by: str


#: Home of a name: a module, an empty str for a learner of the registry, the learner that runs its networks, or the replacement of a
#: missing name.
Home = Union[str, Runs, Absent]
HERE = ""


class Argument(NamedTuple):
    """An argument of OpenDR."""

    name: str
    #: Its name in this package; None if it has no effect.
    ours: Optional[str]
    #: Why it has no effect.
    reason: str = ""


class Learner(NamedTuple):
    """An available learner of OpenDR: the arguments of its methods in OpenDR's order.

    An argument is ``name``, ``name>ours`` with another name in this package, or ``name!reason`` without effect; with an
    empty str the method keeps its own arguments.
    """

    init: str = ""
    infer: str = ""
    fit: str = ""
    eval: str = ""
    optimize: str = ""
    download: str = ""
    load: str = ""
    save: str = ""
    #: OpenDR's further methods and their replacements; an empty str where the method is available.
    methods: Mapping[str, str] = {}
    #: The base class with further methods of this learner, ``module:class``.
    mixin: str = ""
    #: OpenDR's defaults that are not those of the learner in the registry.
    defaults: Mapping[str, Any] = {}
    #: Values of arguments that only OpenDR has, and their equivalents in this package.
    same: Mapping[str, Mapping[str, str]] = {}
    #: Values of arguments that only OpenDR has, separated by blanks, and are replaced by the default.
    instead: Mapping[str, str] = {}
    #: Values of arguments that are not available, and their replacements.
    without: Mapping[str, Mapping[str, str]] = {}
    #: The folder below ``path`` that ``download`` creates; ``{argument=default}`` is replaced by an argument.
    folder: Optional[str] = None
    #: Names of OpenDR's models that the default model of this package replaces, separated by blanks.
    models: str = ""
    #: Modes of ``download`` that have another name in this package.
    modes: Mapping[str, str] = {}
    #: The file that ``download(mode="images")`` writes.
    picture: str = ""
    #: Whether ``download`` also loads the model.
    loads: bool = False
    #: Whether the learner needs no model and is loaded on first use.
    ready: bool = False
    #: OpenDR's demos that were checked line by line.
    demos: str = ""
    #: Remaining differences, a sentence each.
    differs: tuple[str, ...] = ()


def arguments(text: str) -> tuple[Argument, ...]:
    """Parses the arguments of a row."""
    return tuple(_argument(word) for word in text.split())


def _argument(word: str) -> Argument:
    name, mark, reason = word.partition("!")
    if mark:
        return Argument(name, None, REASONS[reason])
    name, mark, ours = word.partition(">")
    return Argument(name, ours if mark else name)
