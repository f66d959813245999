"""``download`` with OpenDR's interface: a method of the class or an object, with OpenDR's folder names."""

from __future__ import annotations

import functools
import json
import os
import re
import shutil
import warnings
from typing import Any, Optional

from opendr._errors import InvalidInput, NotFound
from opendr._upstream.arguments import by_name
from opendr._upstream.rows import Learner, arguments

_ORDER = "path mode verbose url"
#: Arguments of OpenDR that name a model.
_MODELS = ("model_name", "model_names", "name", "file_name", "method_name", "trained_on", "fold_idx")


class Download:
    """Descriptor of the method ``download``, which can be called on the class or an object."""

    def __init__(self, row: Learner, parent: Any) -> None:
        self._row, self._parent = row, parent
        self.__doc__ = parent.download.__doc__

    def __get__(self, instance: Optional[Any], owner: type) -> Any:
        return functools.partial(self._download, owner if instance is None else instance)

    def _download(self, learner: Any, *given: Any, **named: Any) -> str:
        cls = learner if isinstance(learner, type) else type(learner)
        row, owner = self._row, f"{cls.__name__}.download"
        found = by_name(owner, arguments(row.download or _ORDER), given, named, stacklevel=4)
        names = {name: found.pop(name) for name in _MODELS if name in found}
        self._check(owner, names)
        path, mode = found.pop("path", None), found.pop("mode", "pretrained")
        mode = row.modes.get(mode, mode)
        copied = "pretrained" if path is not None and found.get("variant") is None else None
        if mode == "images" and path is not None and row.picture:
            return self._picture(learner, os.fspath(path), found)
        if path is None or mode != copied or row.folder is None:
            return str(self._parent.download(learner, path, mode, **found))
        model: str = self._parent.download(learner, None, mode, **found)
        place = os.path.join(os.fspath(path), _filled(row.folder, {**getattr(learner, "_idle", {}), **names}))
        _copy(model, place)
        if row.loads and not isinstance(learner, type):
            learner.load(place)
        return place

    def _check(self, owner: str, names: dict[str, Any]) -> None:
        known = self._row.models.split()
        for name, value in names.items():
            requested = (
                {value} if isinstance(value, str) else set(value) if isinstance(value, (set, list, tuple)) else set()
            )
            unknown = sorted(map(str, requested - set(known))) if name != "method_name" and known else []
            if unknown:
                raise NotFound(f"{owner}: unknown model {unknown[0]!r}; the models are {', '.join(known)}")
            if requested or value is not None:
                warnings.warn(
                    f"{owner}: {name}={value!r}: one model of this package replaces all of OpenDR's",
                    UserWarning,
                    stacklevel=5,
                )

    def _picture(self, learner: Any, path: str, options: dict[str, Any]) -> str:
        from opendr.engine.data import Image

        sample = self._parent.download(learner, None, "images", **options)
        os.makedirs(path, exist_ok=True)
        place = os.path.join(path, self._row.picture)
        Image.open(sample).save(place)
        return place


def _filled(folder: str, names: dict[str, Any]) -> str:
    """Returns the folder of a model, with the arguments of the call or the constructor inserted."""

    def name(match: re.Match[str]) -> str:
        value = names.get(match[1])
        if isinstance(value, (set, list, tuple)):
            value = next(iter(sorted(value)), None)
        text = str(value) if value else match[2]
        if not re.fullmatch(r"[\w.+-]+", text) or text.strip(".") == "":
            raise InvalidInput(f"{match[1]} = {text!r:.100} is not a model name")
        return text

    return re.sub(r"\{(\w+)=([^}]*)\}", name, folder)


def _copy(model: str, place: str) -> None:
    """Copies a model to a folder, unless the folder contains another learner's model."""
    there = os.path.join(place, "model.json")
    if os.path.exists(there) and _learner(there) != _learner(os.path.join(model, "model.json")):
        raise InvalidInput(f"{there} is the model of another learner; give another folder")
    shutil.copytree(model, place, dirs_exist_ok=True)


def _learner(manifest: str) -> Any:
    try:
        with open(manifest, encoding="utf-8") as file:
            return json.load(file)["learner"]
    except (OSError, ValueError, LookupError, TypeError):
        return None
