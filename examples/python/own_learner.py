"""A learner of your own: registered, it works as those of the toolkit do. Needs no input."""

from typing import Annotated

import numpy as np

import opendr
from opendr.engine.data import Image
from opendr.engine.learners import Learner, Range
from opendr.engine.target import BoundingBox, BoundingBoxList


class BrightSpot(Learner):
    """Detects the bright part of an image."""

    name = "bright_spot"
    task = "object_detection_2d"
    threshold: Annotated[float, Range(0.0, 1.0), "Brightness from which a pixel is bright."] = 0.8

    def load(self, path: str) -> bool:
        return True

    def infer(self, image: Image) -> BoundingBoxList:
        rows, columns = np.nonzero(image.numpy()[0] >= 255 * self.threshold)
        left, top = columns.min(), rows.min()
        return BoundingBoxList([BoundingBox(0, left, top, columns.max() + 1 - left, rows.max() + 1 - top, 0.9)], classes=["spot"])


opendr.register(BrightSpot)
image = np.full((120, 160, 3), 60, np.uint8)
image[40:90, 50:110] = 230
spots = opendr.learner("bright_spot", threshold=0.7).infer(Image(image))
print(f"{spots[0].class_name} of {spots[0].width:.0f} x {spots[0].height:.0f} pixels")
spots.plot(image).save("own_learner.png")
