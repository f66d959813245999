"""Detectors and non-maximum suppression."""

from __future__ import annotations

import warnings
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any, Optional

from opendr._errors import Unsupported
from opendr._input_value import input_value
from opendr._native_learner import NativeLearner
from opendr.engine._image_reference import ImageReference
from opendr.engine.target import BoundingBox, BoundingBoxList

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray


class SingleShotDetector(NativeLearner):
    """SSD, with support for a custom non-maximum suppression."""

    threshold: float

    def infer(self, image: Any, *, custom_nms: Any = None, **arguments: Any) -> Any:
        """Predicts as ``infer`` of every learner; ``custom_nms`` is an object with ``run_nms``, e.g. ``ClusterNMS()``, or a
        value of ``suppression``."""
        if not hasattr(custom_nms, "run_nms"):
            given = arguments if custom_nms is None else {**arguments, "custom_nms": custom_nms}
            return super().infer(image, **given)
        progress = arguments.pop("progress", True)
        if not isinstance(image, (Iterator, list, tuple)):
            return self._suppressed(image, custom_nms, arguments)
        each = self._with_progress((self._suppressed(one, custom_nms, arguments) for one in image), image, progress)
        return each if isinstance(image, Iterator) else list(each)

    def _suppressed(self, image: Any, custom_nms: Any, arguments: dict[str, Any]) -> BoundingBoxList:
        import numpy as np

        given, image = image, input_value(image, "image", "Image")
        known = self._known(arguments, stacklevel=6)
        # No IoU exceeds 1, so all boxes are kept.
        every = {"iou_threshold": 1.0, "suppression": "hard", "max_detections": known.get("max_candidates", 400)}
        found: BoundingBoxList = super().infer(image, **{**known, **every})
        corners = np.array([[b.left, b.top, b.left + b.width, b.top + b.height] for b in found.data]).reshape(-1, 4)
        scores = np.zeros((len(found), max(1, len(self.classes))))
        for row, box in enumerate(found.data):
            scores[row, int(box.name)] = box.confidence
        threshold = known.get("threshold", self.threshold)
        chosen = custom_nms.run_nms(boxes=corners, scores=scores, threshold=threshold, img=image)
        boxes = chosen[0] if isinstance(chosen, tuple) else chosen
        named = [_with_class(box, self.classes) for box in boxes.data]
        target = BoundingBoxList(named[: known.get("max_detections")], classes=self.classes)
        target = found._with_header_in(target)
        target._image = ImageReference.to(given)
        return target


class Seq2SeqNms(NativeLearner):
    """Non-maximum suppression by attention, with OpenDR's interface of suppressions."""

    def infer(self, *inputs: Any, **arguments: Any) -> Any:
        """Predicts as ``infer`` of every learner, from an image and a detector's boxes."""
        if {"boxes", "scores"} & arguments.keys():
            raise Unsupported("infer takes an image and a BoundingBoxList; run_nms takes boxes, scores and img")
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
        """Suppresses overlapping boxes.

        Args:
            boxes: Corners, ``[boxes, 4]``: left, top, right, bottom, in pixels.
            scores: Scores, ``[boxes]`` or ``[boxes, classes]``.
            boxes_sorted: No effect: whether the boxes are in descending order of score.
            top_k: Maximum number of boxes that are processed.
            img: The image.
            threshold: Score below which boxes are dropped.
            map: No effect: the edges of the image are computed instead.

        Returns:
            The remaining boxes, and their corners, classes and scores.
        """
        from opendr._upstream.suppression import candidates

        if map is not None:
            warnings.warn(f"{type(self).__name__}: map has no effect: the edges of img are computed instead", stacklevel=2)
        if img is None:
            raise TypeError("run_nms needs the image; give img")
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
    """Returns corners, classes and scores of boxes."""
    import numpy as np

    corners = [[box.left, box.top, box.left + box.width, box.top + box.height] for box in boxes.data]
    return [
        np.array(corners, dtype=float).reshape(-1, 4),
        np.array([box.name for box in boxes.data], dtype=int),
        np.array([box.confidence for box in boxes.data], dtype=float),
    ]
