"""Conversion of boxes to the package supervision."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Union

from opendr.engine.target.bounding_box import BoundingBox
from opendr.engine.target.tracking_annotation import TrackingAnnotation

if TYPE_CHECKING:
    import supervision


def detections(
    boxes: Sequence[Union[BoundingBox, TrackingAnnotation]], classes: Sequence[str]
) -> supervision.Detections:
    """Returns the boxes as ``supervision.Detections``: ``xyxy`` in pixels, ``confidence``, ``class_id``, ``tracker_id`` for
    tracks, and ``data["class_name"]``. A label that is not in ``classes`` has class -1.

    Raises:
        ImportError: The package is not installed.
    """
    import numpy as np

    try:
        import supervision
    except ImportError as error:
        raise ImportError(
            f"to_supervision() needs the package supervision ({error}): pip install supervision"
        ) from error

    corners = [[box.left, box.top, box.left + box.width, box.top + box.height] for box in boxes]
    numbers = {name: index for index, name in enumerate(classes)}
    ids = [box.name if isinstance(box.name, int) else numbers.get(box.name, -1) for box in boxes]
    names = [_label(box, classes) for box in boxes]
    tracks = [box.id for box in boxes if isinstance(box, TrackingAnnotation)]
    return supervision.Detections(
        xyxy=np.array(corners, dtype=np.float32).reshape(-1, 4),
        confidence=np.array([box.confidence for box in boxes], dtype=np.float32),
        class_id=np.array(ids, dtype=int),
        tracker_id=np.array(tracks, dtype=int) if tracks else None,
        data={"class_name": np.array(names, dtype=str)},
    )


def _label(box: Union[BoundingBox, TrackingAnnotation], classes: Sequence[str]) -> str:
    if isinstance(box.name, str):
        return box.name
    return box.class_name or (classes[box.name] if 0 <= box.name < len(classes) else str(box.name))
