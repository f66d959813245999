"""Data: constructors, layouts and conversions."""

import os

import numpy as np
from opendr.engine.constants import OPENDR_SERVER_URL
from opendr.engine.data import (
    Image,
    ImageWithDetections,
    PointCloud,
    PointCloudWithCalibration,
    SkeletonSequence,
    Timeseries,
    Vector,
    Video,
)
from opendr.engine.datasets import PointCloudsDatasetIterator
from opendr.engine.helper.io import bump_version
from opendr.engine.target import BoundingBox, BoundingBoxList
from opendr.utils.io import bump_version as same

assert same is bump_version and isinstance(OPENDR_SERVER_URL, str)
frame = np.zeros((4, 6, 3), np.uint8)
frame[0, 0] = (1, 2, 3)
image = Image(frame)
assert image.data.shape == (3, 4, 6) and image.data[:, 0, 0].tolist() == [3, 2, 1]
assert (image.opencv() == frame).all() and image.numpy() is not image.data
assert (image.convert("channels_last", "bgr") == frame).all()
assert image.convert("channels_first", "rgb").shape == (3, 4, 6)
assert str(image) == str(image.data)
boxed = ImageWithDetections(frame, BoundingBoxList([BoundingBox(0, 1, 1, 2, 2)]))
assert boxed.boundingBoxList[0].width == 2
assert Vector([1, 2]).numpy().dtype == np.float32 and Timeseries([[1, 2]]).data.shape == (1, 2)
assert Video(np.zeros((3, 2, 4, 4))).data.ndim == 4 and SkeletonSequence(np.zeros((1, 3, 2, 25, 1))).data.ndim == 5
cloud = PointCloudWithCalibration(np.zeros((5, 4)), {"P2": np.eye(4)}, (10, 20))
assert cloud.image_shape == (10, 20) and "Calib" in str(cloud) and len(PointCloud(np.zeros((5, 3)))) == 5
try:
    str(Vector().data)
except ValueError as error:
    assert "empty" in str(error)

os.makedirs("scans")
np.arange(8, dtype="<f4").tofile("scans/0.bin")
assert PointCloudsDatasetIterator("scans", 4)[0].data.shape == (2, 4)
image.save("picture.png")
assert (Image.open("picture.png").data == image.data).all()
assert bump_version("picture.png").name == "picture_1.png"
image.save("picture_1.png")
assert str(bump_version("picture.png")) == str(bump_version("picture_1.png")) == "picture_2.png"
assert bump_version("new.json").name == "new.json"
