"""Data types, the inputs of learners: images, point clouds, audio, time series. One file per type.

``str(datum)`` is OpenDR's text. Every datum has ``timestamp`` (nanoseconds, or None) and ``frame_id``; predictions
inherit them.
"""

from opendr.engine.data.audio import Audio
from opendr.engine.data.calibration import Calibration
from opendr.engine.data.data import Data
from opendr.engine.data.image import Image
from opendr.engine.data.image_with_detections import ImageWithDetections
from opendr.engine.data.observation import Observation
from opendr.engine.data.point_cloud import PointCloud
from opendr.engine.data.point_cloud_with_calibration import PointCloudWithCalibration
from opendr.engine.data.skeleton_sequence import SkeletonSequence
from opendr.engine.data.timeseries import Timeseries
from opendr.engine.data.vector import Vector
from opendr.engine.data.video import Video

__all__ = [
    "Audio",
    "Calibration",
    "Data",
    "Image",
    "ImageWithDetections",
    "Observation",
    "PointCloud",
    "PointCloudWithCalibration",
    "SkeletonSequence",
    "Timeseries",
    "Vector",
    "Video",
]
