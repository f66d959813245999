"""COCO entries in OpenDR's form."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Any, Callable

from opendr import _opendr
from opendr.engine._checks import class_name_or_index, real, reals, whole
from opendr.engine.target._segmentation import segmentation_of

if TYPE_CHECKING:
    from opendr.engine.target.base_target import BaseTarget
    from opendr.engine.target.bounding_box import BoundingBoxList

_READ: dict[str, Callable[[Any], Any]] = {
    "category_id": class_name_or_index,
    "bbox": lambda value: reals(value, 4, "bbox"),
    "area": lambda value: real(value, "area"),
    "segmentation": segmentation_of,
    "iscrowd": lambda value: whole(value, "iscrowd"),
    "confidence": lambda value: real(value, "confidence"),
    "score": lambda value: real(value, "score"),
}


def entries_from_boxes(boxes: BaseTarget, with_confidence: bool) -> list[dict[str, Any]]:
    """Returns an entry per box; the score is ``confidence``, OpenDR's name, not ``score``."""
    entries = _opendr.coco(boxes, with_confidence)
    return [{_opendr_name(key): value for key, value in entry.items()} for entry in entries]


def boxes_from_entries(entries: Iterable[Mapping[str, Any]], image_id: int) -> BoundingBoxList:
    """Returns the boxes of entries, whose numbers may be NumPy's; other keys are ignored.

    Raises:
        TypeError: An argument is of another type.
        ValueError: A key is missing, or a number not finite.
    """
    plain = []
    for entry in entries:
        if not isinstance(entry, Mapping) or not {"category_id", "bbox"} <= entry.keys():
            raise ValueError(f"an entry has at least 'bbox' and 'category_id', not {entry!r:.200}")
        known = {key: read(entry[key]) for key, read in _READ.items() if entry.get(key) is not None}
        if "confidence" in known:
            known.pop("score", None)
        plain.append(known)
    boxes: BoundingBoxList = _opendr.from_coco(plain, image_id)
    return boxes


def _opendr_name(key: str) -> str:
    return "confidence" if key == "score" else key
