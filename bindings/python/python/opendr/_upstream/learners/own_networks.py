"""Learners of OpenDR whose networks users bring, exported to ONNX."""

from __future__ import annotations

from typing import Any

from opendr._native_learner import NativeLearner
from opendr._upstream.arguments import by_name


class OwnNetwork(NativeLearner):
    """A learner that runs the network of a file, which is given to the constructor as ``path`` or to ``load``."""

    def __init__(self, *given: Any, **named: Any) -> None:
        found = by_name(type(self).__name__, self._positional, given, named, stacklevel=3)
        path = found.pop("path", None)
        super().__init__(**found)
        if path is not None:
            self.load(path)
