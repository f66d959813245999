"""The tables of a learner written in Python, for the registry."""

from __future__ import annotations

import inspect
from typing import Any

from opendr.engine._parameters import parameters
from opendr.engine._ports import outputs_of, ports_of
from opendr.engine.learners import BaseLearner


def tables_from_class(cls: type) -> dict[str, Any]:
    """Returns the tables of ``cls`` for the registry.

    Returns:
        ``name``, ``class_name``, ``task``, ``about`` (the first paragraph of the docstring), ``params`` (each with
        ``name``, ``doc``, ``kind`` (``"float"``, ``"int"``, ``"bool"``, ``"text"``, ``"list"``), ``optional``, ``choices``,
        ``range`` (``(low, high)`` or None), ``unit``, ``live``, ``default``; OpenDR's own arguments are only among them
        when the class declares them again), ``ports`` (``name``, ``type``, ``init``, ``optional``) and ``outputs``
        (``name``, ``type``).

    Raises:
        TypeError: ``cls`` is no subclass of ``Learner``, ``LearnerRL`` or ``LearnerActive``, or something is missing;
            the message lists everything.
    """
    if not (isinstance(cls, type) and issubclass(cls, BaseLearner)):
        raise TypeError(f"{cls!r} is not a learner; derive it from opendr.engine.learners.Learner")
    problems: list[str] = []
    words = {field: _word(cls, field, problems) for field in ("name", "task")}
    if inspect.isabstract(cls):
        problems.append(f"{', '.join(sorted(cls.__abstractmethods__))} is not implemented")
    about = (inspect.cleandoc(cls.__dict__.get("__doc__") or "").split("\n\n")[0]).replace("\n", " ")
    if not about:
        problems.append("the docstring is missing; write a sentence about the learner")
    known = parameters(cls)
    params = [parameter.table() for name, parameter in known.items() if parameter is not vars(BaseLearner).get(name)]
    undocumented = [param["name"] for param in params if not param["doc"]]
    if undocumented:
        problems.append(f"{', '.join(undocumented)} has no description; write it after the type in Annotated[...]")
    ports = outputs = []
    if not inspect.isabstract(cls):
        ports, outputs = ports_of(cls.infer, problems), outputs_of(cls.infer, problems)
    if not ports and not problems:
        problems.append("infer has no input; add one, e.g. `image: Image`")
    if problems:
        raise TypeError(f"{cls.__name__} cannot be registered: {'; '.join(problems)}")
    return {
        **words,
        "class_name": cls.__name__,
        "about": about,
        "params": params,
        "ports": ports,
        "outputs": outputs,
    }


def _word(cls: type, field: str, problems: list[str]) -> str:
    word = getattr(cls, field, None)
    if isinstance(word, str) and word.isidentifier():
        return word
    problems.append(f"{field} should be a name such as {field} = 'nanodet', not {word!r}")
    return ""
