"""Detectors, and what thins out their boxes."""

from __future__ import annotations

import warnings
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any, Optional

from opendr._errors import Unsupported
from opendr._native_learner import NativeLearner, _value
from opendr.engine.target import BoundingBox, BoundingBoxList

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray


class SingleShotDetector(NativeLearner):
    """SSD, whose boxes a suppression of one's own may choose among."""

    threshold: float

    def infer(self, image: Any, *, custom_nms: Any = None, **arguments: Any) -> Any:
        """Predicts as ``infer`` of every learner does; ``custom_nms`` is an object with ``run_nms``, e.g.
        ``ClusterNMS()``, or what ``suppression`` takes."""
        if not hasattr(custom_nms, "run_nms"):
            given = arguments if custom_nms is None else {**arguments, "custom_nms": custom_nms}
            return super().infer(image, **given)
        if isinstance(image, Iterator):
            return (self._chosen(one, custom_nms, arguments) for one in image)
        if isinstance(image, (list, tuple)):
            return [self._chosen(one, custom_nms, arguments) for one in image]
        return self._chosen(image, custom_nms, arguments)

    def _chosen(self, image: Any, custom_nms: Any, arguments: dict[str, Any]) -> BoundingBoxList:
        import numpy as np

        picture = _value(image, "image", "Image")
        known = self._known(arguments, stacklevel=6)
        # Above an overlap of 1 there is none: all boxes are left.
        every = {"iou_threshold": 1.0, "suppression": "hard", "max_detections": known.get("max_candidates", 400)}
        found: BoundingBoxList = super().infer(picture, **{**known, **every})
        corners = np.array([[b.left, b.top, b.left + b.width, b.top + b.height] for b in found.data]).reshape(-1, 4)
        scores = np.zeros((len(found), max(1, len(self.classes))))
        for row, box in enumerate(found.data):
            scores[row, int(box.name)] = box.confidence
        threshold = known.get("threshold", self.threshold)
        chosen = custom_nms.run_nms(boxes=corners, scores=scores, threshold=threshold, img=picture)
        boxes = chosen[0] if isinstance(chosen, tuple) else chosen
        named = [_with_class(box, self.classes) for box in boxes.data]
        target = BoundingBoxList(named[: known.get("max_detections")], classes=self.classes)
        target.timestamp, target.frame_id = found.timestamp, found.frame_id
        return target


class Seq2SeqNms(NativeLearner):
    """Attention that chooses among a detector's boxes, also called as OpenDR calls suppressions."""

    def infer(self, *inputs: Any, **arguments: Any) -> Any:
        """Predicts as ``infer`` of every learner does, from an image and a detector's boxes."""
        if {"boxes", "scores"} & arguments.keys():
            raise Unsupported("infer takes a picture and a BoundingBoxList; run_nms takes boxes, scores and img")
        return super().infer(*inputs, **arguments)

    def run_nms(
        self,
        boxes: Optional[ArrayLike] = None,
        scores: Optional[ArrayLike] = None,
        boxes_sorted: bool = False,
        top_k: int = 400,
        img: Any = None,
        threshold: float = 0.2,
        map: Any = None,
    ) -> tuple[BoundingBoxList, list[NDArray[Any]]]:
        """Chooses among boxes.

        Args:
            boxes: Corners, ``[boxes, 4]``: left, top, right, bottom, in pixels.
            scores: Scores, ``[boxes]`` or ``[boxes, classes]``.
            boxes_sorted: Whether the scores fall; nothing depends on it.
            top_k: So many boxes are looked at.
            img: The image.
            threshold: Boxes below this score are dropped.
            map: Not taken: the image is looked at itself.

        Returns:
            The boxes that are left, and their corners, classes and scores.
        """
        from opendr._upstream.suppression import candidates

        if map is not None:
            warnings.warn(f"{type(self).__name__}: map has no effect: edges of img are looked at", stacklevel=2)
        if img is None:
            raise TypeError("run_nms wants the picture; give img")
        corners, labels, values = candidates(boxes, scores)
        given = _list_of(corners, labels, values)
        chosen: BoundingBoxList = self.infer(img, given, threshold=threshold, max_dt_boxes=top_k)
        return chosen, arrays_of(chosen)


def _with_class(box: BoundingBox, classes: list[str]) -> BoundingBox:
    index = int(box.name)
    name = classes[index] if 0 <= index < len(classes) else ""
    return BoundingBox(index, box.left, box.top, box.width, box.height, box.confidence, class_name=name)


def _list_of(corners: NDArray[Any], labels: NDArray[Any], scores: NDArray[Any]) -> BoundingBoxList:
    rows = zip(corners.tolist(), labels.tolist(), scores.tolist())
    return BoundingBoxList(
        [BoundingBox(label, x0, y0, x1 - x0, y1 - y0, score) for (x0, y0, x1, y1), label, score in rows]
    )


def arrays_of(boxes: BoundingBoxList) -> list[NDArray[Any]]:
    """Corners, classes and scores of boxes."""
    import numpy as np

    corners = [[box.left, box.top, box.left + box.width, box.top + box.height] for box in boxes.data]
    return [
        np.array(corners, dtype=float).reshape(-1, 4),
        np.array([box.name for box in boxes.data], dtype=int),
        np.array([box.confidence for box in boxes.data], dtype=float),
    ]
