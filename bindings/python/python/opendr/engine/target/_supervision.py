"""Conversion of targets to the classes of the package supervision."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, Optional, Union

from opendr import _opendr
from opendr._errors import Unsupported
from opendr.engine.target._table import label
from opendr.engine.target.bounding_box import BoundingBoxList
from opendr.engine.target.category import Category
from opendr.engine.target.heatmap import Heatmap
from opendr.engine.target.pose import Pose
from opendr.engine.target.text_region import TextRegion
from opendr.engine.target.tracking_annotation import TrackingAnnotation, TrackingAnnotationList

if TYPE_CHECKING:
    import numpy as np
    import supervision
    from numpy.typing import NDArray


def detections(
    boxes: Union[BoundingBoxList, TrackingAnnotationList], image_size: Optional[tuple[int, int]]
) -> supervision.Detections:
    """Returns boxes or tracks as ``supervision.Detections``: ``xyxy`` in pixels, ``mask`` where one of them has a mask,
    ``confidence``, ``class_id``, ``tracker_id`` for tracks, and ``data["class_name"]``. A label that is not in ``classes`` has
    class -1.
    """
    import numpy as np

    package = _package()
    items = boxes.data
    corners = [[box.left, box.top, box.left + box.width, box.top + box.height] for box in items]
    numbers = {name: index for index, name in enumerate(boxes.classes)}
    ids = [box.name if isinstance(box.name, int) else numbers.get(box.name, -1) for box in items]
    tracks = [box.id for box in items if isinstance(box, TrackingAnnotation)]
    found: supervision.Detections = package.Detections(
        xyxy=np.array(corners, dtype=np.float32).reshape(-1, 4),
        mask=_masks(boxes, image_size),
        confidence=np.array([box.confidence for box in items], dtype=np.float32),
        class_id=np.array(ids, dtype=int),
        tracker_id=np.array(tracks, dtype=int) if tracks else None,
        data={"class_name": np.array([label(box, boxes.classes) for box in items], dtype=str)},
    )
    return found


def key_points(poses: Sequence[Pose]) -> supervision.KeyPoints:
    """Returns poses as ``supervision.KeyPoints``."""
    import numpy as np

    package = _package()
    if "detection_confidence" not in package.KeyPoints.__dataclass_fields__:
        raise ImportError(
            f"to_supervision() of poses needs supervision 0.29 or later, not {package.__version__}: "
            "pip install --upgrade supervision"
        )
    found: supervision.KeyPoints
    if not poses:
        found = package.KeyPoints.empty()
        return found
    counts = sorted({len(pose) for pose in poses})
    if len(counts) > 1:
        raise Unsupported(
            f"supervision.KeyPoints have the same number of points each, the poses have {' and '.join(map(str, counts))}; "
            "convert a list for each skeleton"
        )
    points = np.stack([pose.data for pose in poses])
    data: dict[str, Any] = {}
    if any(pose.id is not None for pose in poses):
        data["tracker_id"] = np.array([-1 if pose.id is None else pose.id for pose in poses], dtype=int)
    regions = [pose.region for pose in poses if pose.region is not None]
    if len(regions) == len(poses):
        corners = [[box.left, box.top, box.left + box.width, box.top + box.height] for box in regions]
        data["xyxy"] = np.array(corners, dtype=np.float32)
    found = package.KeyPoints(
        xy=points,
        keypoint_confidence=np.stack([pose.keypoint_confidences for pose in poses]),
        detection_confidence=np.array([pose.confidence for pose in poses], dtype=np.float32),
        visible=(points >= 0).all(axis=2),
        data=data,
    )
    return found


def classifications(category: Category) -> supervision.Classifications:
    """Returns a class as ``supervision.Classifications``."""
    import numpy as np

    classes, scores = np.array([category.data]), category.probabilities
    if scores is not None:
        classes = np.arange(len(scores))
    elif category.confidence is not None:
        scores = np.array([category.confidence], dtype=np.float32)
    found: supervision.Classifications = _package().Classifications(classes, scores)
    return found


def class_masks(heatmap: Heatmap) -> supervision.Detections:
    """Returns the classes of a map as ``supervision.Detections`` with masks."""
    import numpy as np

    package = _package()
    if not heatmap._is_map_of_classes():
        raise Unsupported(
            f"supervision has no class for a map of {heatmap.data.dtype} of shape {heatmap.data.shape}; to_supervision() takes class "
            "indices [height, width], e.g. the argmax of scores"
        )
    background = heatmap.label_of(0).lower() in ("0", "background")
    classes = [index for index in np.unique(heatmap.data).tolist() if index > 0 or not background]
    masks = np.array(classes).reshape(-1, 1, 1) == heatmap.data
    found: supervision.Detections = package.Detections(
        xyxy=np.array([_around(mask) for mask in masks], dtype=np.float32).reshape(-1, 4),
        mask=masks,
        class_id=np.array(classes, dtype=int),
        data={"class_name": np.array([heatmap.label_of(index) for index in classes], dtype=str)},
    )
    return found


def text_detections(regions: Sequence[TextRegion]) -> supervision.Detections:
    """Returns texts in an image as ``supervision.Detections``."""
    import numpy as np

    corners = np.array([region.corners for region in regions], dtype=np.float32).reshape(-1, 4, 2)
    found: supervision.Detections = _package().Detections(
        xyxy=np.hstack([corners.min(axis=1), corners.max(axis=1)]),
        confidence=np.array([region.confidence for region in regions], dtype=np.float32),
        class_id=np.zeros(len(regions), dtype=int),
        data={"class_name": np.array([region.text for region in regions], dtype=str), "xyxyxyxy": corners},
    )
    return found


def _package() -> Any:
    try:
        import supervision
    except ImportError as error:
        raise ImportError(
            f"to_supervision() needs the package supervision ({error}): pip install supervision"
        ) from error
    return supervision


def _masks(
    boxes: Union[BoundingBoxList, TrackingAnnotationList], image_size: Optional[tuple[int, int]]
) -> Optional[NDArray[np.bool_]]:
    """Returns ``[boxes, height, width]``; None where no box has a mask."""
    import numpy as np

    if all(getattr(box, "segmentation", None) is None for box in boxes.data):
        return None
    decoded = _opendr.masks(boxes, image_size)
    if decoded is None:
        return None
    pixels, size = decoded
    return np.frombuffer(pixels, dtype=bool).reshape(len(boxes), *size)


def _around(mask: NDArray[np.bool_]) -> list[int]:
    """Returns left, top, right and bottom edge of the pixels of a mask."""
    import numpy as np

    columns, rows = np.flatnonzero(mask.any(axis=0)), np.flatnonzero(mask.any(axis=1))
    return [int(columns[0]), int(rows[0]), int(columns[-1]) + 1, int(rows[-1]) + 1]
