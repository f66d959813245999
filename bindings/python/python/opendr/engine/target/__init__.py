"""Target types, of predictions and annotations. One file per type.

``str(target)`` is OpenDR's text, ``target.to_json()`` the JSON of ``docs/json.md``. Every target has ``timestamp``
(nanoseconds, or None) and ``frame_id`` of its datum, and ``action``: the movement to a better view (active perception).
"""

from opendr.engine.target.action import Action, ActionBase
from opendr.engine.target.base_target import BaseTarget, Target
from opendr.engine.target.bounding_box import BoundingBox, BoundingBoxList
from opendr.engine.target.bounding_box_3d import BoundingBox3D, BoundingBox3DList
from opendr.engine.target.category import Category
from opendr.engine.target.coco_bounding_box import CocoBoundingBox
from opendr.engine.target.heatmap import Heatmap
from opendr.engine.target.keypoint import Keypoint
from opendr.engine.target.odometry import Odometry
from opendr.engine.target.pose import Pose, PoseList
from opendr.engine.target.rl_target import RlTarget
from opendr.engine.target.speech_command import SpeechCommand
from opendr.engine.target.text_region import TextRegion, TextRegionList
from opendr.engine.target.tracking_annotation import TrackingAnnotation, TrackingAnnotationList
from opendr.engine.target.tracking_annotation_3d import TrackingAnnotation3D, TrackingAnnotation3DList
from opendr.engine.target.transcription import BaseTranscription, VoskTranscription, WhisperTranscription

__all__ = [
    "Action",
    "ActionBase",
    "BaseTarget",
    "BaseTranscription",
    "BoundingBox",
    "BoundingBox3D",
    "BoundingBox3DList",
    "BoundingBoxList",
    "Category",
    "CocoBoundingBox",
    "Heatmap",
    "Keypoint",
    "Odometry",
    "Pose",
    "PoseList",
    "RlTarget",
    "SpeechCommand",
    "Target",
    "TextRegion",
    "TextRegionList",
    "TrackingAnnotation",
    "TrackingAnnotation3D",
    "TrackingAnnotation3DList",
    "TrackingAnnotationList",
    "VoskTranscription",
    "WhisperTranscription",
]
