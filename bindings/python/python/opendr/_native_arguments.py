"""Parameters and arguments of the native learners, by the names of the registry."""

from __future__ import annotations

import contextlib
import warnings
from collections.abc import Iterator, Mapping, Sequence
from typing import Any, ClassVar, Optional

from opendr import _opendr
from opendr._upstream.arguments import by_name, value_here
from opendr._upstream.rows import Argument
from opendr._upstream.rows import Learner as Row
from opendr.engine._parameters import Parameter, parameters
from opendr.engine.learners import BaseLearner

Table = dict[str, Any]


class NativeArguments(BaseLearner):
    """A learner of the registry with its parameters."""

    _entry: ClassVar[Table]
    #: The row of this learner in the table of OpenDR's names.
    _row: ClassVar[Row] = Row()
    #: The positional arguments of the constructor.
    _positional: ClassVar[Sequence[Argument]] = ()

    def __init__(self, *args: Any, **kwargs: Any) -> None:
        given = by_name(type(self).__name__, self._positional, args, kwargs, stacklevel=3)
        idle = dict(self._entry["without_effect"])
        #: OpenDR's arguments without effect, some of which name the folder that OpenDR's programs load from.
        self._idle = {name: value for name, value in given.items() if name in idle}
        known = self._known(given, stacklevel=3)
        super().__init__(**{name: value for name, value in known.items() if value is not None})
        params = {field["name"]: getattr(self, field["name"]) for field in self._entry["params"]}
        self._handle = _opendr.Handle(self._entry["name"], params, self.device)

    def __setattr__(self, name: str, value: Any) -> None:
        super().__setattr__(name, value)
        handle = vars(self).get("_handle")
        if handle is not None and any(field["name"] == name for field in self._entry["params"]):
            try:
                handle.set({name: getattr(self, name)})
            finally:
                vars(self)[name] = handle.params()[name]

    def _fit_params(self, given: dict[str, Any]) -> dict[str, Any]:
        """Returns the parameters of the training: those of the constructor, overridden by those of this call."""
        names, known = [field["name"] for field in self._entry["fit_params"]], parameters(type(self))
        # The value that was set, even where the attribute returns that of the loaded model.
        params = {name: Parameter.__get__(known[name], self) for name in names}
        for name, value in self._known(given, stacklevel=4).items():
            if name not in names:
                raise TypeError(f"fit has no argument {name!r}; the parameters of the training are {', '.join(names)}")
            params[name] = value
        return params

    def _known(self, arguments: dict[str, Any], stacklevel: int) -> dict[str, Any]:
        """Renames OpenDR's arguments to those of this package and drops, with a warning, those without effect."""
        fields = [*self._entry["params"], *self._entry["fit_params"]]
        renamed = {alias: field["name"] for field in fields for alias in (*field["aliases"], *field["former"])}
        choices = {field["name"]: field["choices"] for field in fields}
        owner, idle = type(self).__name__, dict(self._entry["without_effect"])
        known: dict[str, Any] = {}
        for given, value in arguments.items():
            name = renamed.get(given, given)
            if given in idle:
                warnings.warn(f"{owner}: {given} has no effect: {idle[given]}", UserWarning, stacklevel=stacklevel)
                continue
            if name in known:
                raise TypeError(f"{owner} got {name} twice (once as {given}); give it once")
            here = value_here(owner, self._row, name, value, choices.get(name, ()), stacklevel + 1)
            if here is not None or value is None:
                known[name] = here
        return known

    def _live_name(self, name: str) -> Optional[str]:
        """Returns the live parameter of this name or alias, or None."""
        live = (field for field in self._entry["params"] if field["live"])
        return next((field["name"] for field in live if name in (field["name"], *field["aliases"], *field["former"])), None)

    @contextlib.contextmanager
    def _temporarily(self, params: Mapping[str, Any]) -> Iterator[None]:
        """Sets parameters within a ``with`` block."""
        previous = {name: getattr(self, name) for name in params}
        try:
            for name, value in params.items():
                setattr(self, name, value)
            yield
        finally:
            for name, value in previous.items():
                setattr(self, name, value)

    def _arguments(self, inputs: tuple[Any, ...], named: dict[str, Any]) -> tuple[dict[str, Any], dict[str, Any]]:
        """Returns the inputs by port name, and the parameters of this call."""
        names = [port["name"] for port in self._entry["ports"]]
        if len(inputs) > len(names):
            raise TypeError(f"infer takes {len(names)} inputs ({', '.join(names)}), not {len(inputs)}")
        ports, overrides = dict(zip(names, inputs)), dict[str, Any]()
        live = {field["name"] for field in self._entry["params"] if field["live"]}
        known = parameters(type(self)) if named else {}
        for name, value in self._known(named, stacklevel=4).items():
            if name in ports:
                raise TypeError(f"infer got {name} twice; give it once")
            if name not in names and name not in live:
                available = ", ".join([*names, *sorted(live)])
                raise TypeError(f"infer has no argument {name!r}; its arguments are {available}")
            if name in names:
                ports[name] = value
            else:
                overrides[name] = known[name].checked(value)
        # None is the same as leaving an optional input out.
        may_lack = {port["name"] for port in self._entry["ports"] if port["optional"] or port["init"]}
        return {name: value for name, value in ports.items() if value is not None or name not in may_lack}, overrides
