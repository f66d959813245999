"""A learner written in Python, as a user would write it; tests register it."""

from __future__ import annotations

import json
import os
from typing import Annotated, Any, Optional

import numpy as np

from opendr.engine.data import Image
from opendr.engine.learners import Learner, Live, Range
from opendr.engine.target import BoundingBox, BoundingBoxList


class BrightSpotsLearner(Learner):
    """Detects pixels that are brighter than the model's threshold, and counts the calls before."""

    name = "bright_spots"
    task = "object_detection_2d"
    threshold: Annotated[float, Range(0.0, 1.0), Live, "Spots below this score are dropped."] = 0.1

    def __init__(self, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.limit: Optional[int] = None
        self.seen = 0

    def load(self, path: str) -> bool:
        with open(os.path.join(path, "limit.json"), encoding="utf-8") as file:
            self.limit = int(json.load(file))
        return True

    def save(self, path: str) -> bool:
        os.makedirs(path, exist_ok=True)
        with open(os.path.join(path, "limit.json"), "w", encoding="utf-8") as file:
            json.dump(self.limit, file)
        return True

    def reset(self) -> None:
        self.seen = 0

    def infer(self, image: Image) -> BoundingBoxList:
        self.seen += 1
        share = float(np.mean(image.data > self.limit))
        boxes = BoundingBoxList(classes=["bright"])
        if share >= self.threshold:
            boxes.add_box(BoundingBox(0, self.seen, 0, image.width, image.height, share))
        return boxes
