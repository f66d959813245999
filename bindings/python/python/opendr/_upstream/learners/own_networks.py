"""Learners of OpenDR whose networks users bring, exported to ONNX."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from opendr import _opendr
from opendr._input_value import input_value
from opendr._native_learner import NativeLearner
from opendr._upstream.arguments import by_name
from opendr.engine.target import BoundingBoxList, Heatmap


class OwnNetwork(NativeLearner):
    """A learner that runs the network of a file, which is given to the constructor as ``path`` or to ``load``."""

    def __init__(self, *given: Any, **named: Any) -> None:
        found = by_name(type(self).__name__, self._positional, given, named, stacklevel=3)
        path = found.pop("path", None)
        super().__init__(**found)
        if path is not None:
            self.load(path)


class SegmentedObjects(OwnNetwork):
    """A network that segments objects, whose prediction is a map of their classes."""

    _objects: BoundingBoxList

    def infer(self, image: Any, **arguments: Any) -> Any:
        """Predicts a map of the size of the image: 0 for the background, else 1 more than the index of the class. Where masks overlap,
        the one with the largest confidence counts."""
        import numpy as np

        if isinstance(image, (Iterator, list, tuple)):
            each = (self.infer(one, **arguments) for one in image)
            return each if isinstance(image, Iterator) else list(each)
        self._image = input_value(image, "image", "Image")
        self._objects = super().infer(self._image, **arguments)
        height, width = self._image.data.shape[1:]
        classes = np.zeros((height, width), np.int64)
        decoded = _opendr.masks(self._objects, (height, width)) if len(self._objects) else None
        if decoded is not None:
            masks = np.frombuffer(decoded[0], np.uint8).reshape(-1, height, width).astype(bool)
            # The list is in the order of the confidence.
            for box, mask in reversed(list(zip(self._objects.data, masks))):
                classes[mask] = int(box.name) + 1
        return Heatmap(classes, self.get_classes())

    def get_bboxes(self) -> BoundingBoxList:
        """Returns the boxes of the last prediction."""
        return self._objects

    def get_classes(self) -> dict[int, str]:
        """Returns the names of the indices in the map."""
        return {0: "background", **{index + 1: name for index, name in enumerate(self.classes)}}

    def get_visualization(self) -> Any:
        """Returns the last image with its objects drawn on it."""
        return self._objects.plot(self._image)
