"""Grasps from one demonstration."""

from __future__ import annotations

import os
from typing import Any

from opendr._native_learner import NativeLearner
from opendr._upstream.arguments import by_name
from opendr.engine.datasets import ExternalDataset


class SingleDemo(NativeLearner):
    """A learner whose constructor has the folder of the demonstration."""

    def __init__(self, *given: Any, **named: Any) -> None:
        found = by_name(type(self).__name__, self._positional, given, named, stacklevel=3)
        name, folder = found.pop("object_name", None), found.pop("data_directory", None)
        within = None if folder is None or name is None else os.path.join(folder, str(name))
        #: The data set of ``fit`` unless another is given: the folder of the object in ``data_directory``, or that folder itself.
        self.demonstration: Any = within if within is not None and os.path.isdir(within) else folder
        super().__init__(**found)

    def fit(self, dataset: Any = None, *given: Any, **options: Any) -> dict[str, Any]:
        """Trains as ``fit`` of every learner, by default on the demonstration in ``data_directory``."""
        dataset = self.demonstration if dataset is None else dataset
        if dataset is None:
            raise TypeError("fit() needs the demonstration: give it a data set, or the constructor data_directory")
        if isinstance(dataset, (str, os.PathLike)):
            dataset = ExternalDataset(os.fspath(dataset), "coco")
        return super().fit(dataset, *given, **options)
