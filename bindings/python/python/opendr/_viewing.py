"""Drawing, showing and saving of targets."""

from __future__ import annotations

import os
from typing import Any, Optional

from opendr import _opendr
from opendr._drawing import ClassNames, draw_target
from opendr._errors import InvalidInput, Unsupported
from opendr._input_value import PathLike, input_value
from opendr.engine.data import Image
from opendr.engine.target._table import csv_text
from opendr.engine.target.base_target import BaseTarget

#: Extensions of the image files that can be written.
_IMAGES = (".png", ".jpg", ".jpeg", ".bmp", ".webp")


def plot(target: BaseTarget, image: Any, class_names: Optional[ClassNames]) -> Image:
    """Returns the image with the target drawn on it; None stands for the image of the prediction."""
    whole = target._as_value()
    if not whole._is_drawn():
        raise Unsupported(f"{_described(target)} has no place in an image; {_instead(target)}")
    given: Image
    if image is not None:
        given = input_value(image, "image", "Image")
    elif target._image is not None:
        given = target._image.image()
    else:
        raise InvalidInput(f"the image of this {type(target).__name__} is not known; give it: plot(image)")
    return draw_target(given, whole, class_names)


def png(target: BaseTarget) -> Optional[bytes]:
    """Returns the drawing of a prediction as a PNG file; None where it cannot be drawn."""
    return _opendr.png(plot(target, None, None)) if target._has_drawing() else None


def save(target: BaseTarget, path: PathLike) -> None:
    """Writes a target to a file in the format of the extension."""
    name = os.fspath(path)
    extension = os.path.splitext(name)[1].lower()
    if extension not in _extensions(target):
        raise Unsupported(f"saving {name}: {_described(target)} is saved as {', '.join(_extensions(target))}")
    if extension in _IMAGES:
        plot(target, None, None).save(name)
        return
    table = target._table()
    text = target.to_json() if extension == ".json" or table is None else csv_text(table)
    with open(name, "w", encoding="utf-8", newline="") as file:
        file.write(text)


def _extensions(target: BaseTarget) -> list[str]:
    drawing = _IMAGES if target._as_value()._is_drawn() else ()
    return [*drawing, ".json", *((".csv",) if target._table() is not None else ())]


def _instead(target: BaseTarget) -> str:
    table = "to_pandas() returns its table, and " if target._table() is not None else ""
    return f"{table}save() writes it as {' or '.join(_extensions(target))}"


def _described(target: BaseTarget) -> str:
    shape = getattr(target, "shape", None)
    return f"a {type(target).__name__}" + (f" of shape {shape()}" if callable(shape) else "")
