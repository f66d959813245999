"""Conversion of messages of ROS 1 and ROS 2 to data and targets and back, for nodes of your own:

    from opendr.ros_bridge import ROSBridge
    from vision_msgs.msg import Detection2DArray

    bridge = ROSBridge()
    image = bridge.from_message(message)                    # sensor_msgs/Image, CompressedImage, PointCloud2, ...
    boxes = learner.infer(image)
    publisher.publish(bridge.to_message(boxes, Detection2DArray))

The messages are those of rclpy or rospy; their class determines the version of ROS. Stamp and frame id are kept, as are
scores, identities and depth at full precision. docs/ros.md lists what a message has no field for.
"""

from __future__ import annotations

import importlib
import io
from typing import Any, Optional, TypeVar, Union, cast, overload

from opendr import _opendr
from opendr._errors import NotFound
from opendr.engine.data import Image, PointCloud, Timeseries
from opendr.engine.target import (
    BoundingBox3DList,
    BoundingBoxList,
    Category,
    PoseList,
    TrackingAnnotationList,
)

T = TypeVar("T")


class ROSBridge:
    """Converts messages; OpenDR's methods (``to_ros_image``, ...) convert the default pairs of types.

    Args:
        class_ids: Form of classes in messages: ``"names"`` (where known) or ``"numbers"``.
        jpeg_quality: JPEG quality of compressed images, 1 (small) to 100 (good).
    """

    def __init__(self, class_ids: str = "names", jpeg_quality: int = 90) -> None:
        self.class_ids = class_ids
        self.jpeg_quality = jpeg_quality

    @overload
    def from_message(self, message: Any, kind: type[T]) -> T: ...

    @overload
    def from_message(self, message: Any, kind: Optional[str] = None) -> Any: ...

    def from_message(self, message: Any, kind: Union[type, str, None] = None) -> Any:
        """Converts a message to a datum or target; ``kind`` selects among several types (e.g. ``TrackingAnnotationList``).

        Raises:
            opendr.FormatError: The message is inconsistent.
            opendr.Unsupported: The message type is not supported.
        """
        name, is_ros1 = _name_of(type(message))
        return _opendr.value_from_ros(_serialized(message, is_ros1), name, is_ros1, _kind_name(kind))

    def to_message(self, value: Any, message_class: Optional[type] = None) -> Any:
        """Converts a datum or target to a message, of the default class when none is given.

        Raises:
            opendr.InvalidInput: The message has no field for it.
            ImportError: The package of the default class is not installed.
        """
        kind = _kind_of(value)
        if message_class is None:
            message_class = _default_class(kind)
        name, is_ros1 = _name_of(message_class)
        data = _opendr.ros_from_value(value, kind, name, is_ros1, self.class_ids, self.jpeg_quality)
        return _deserialized(data, message_class, is_ros1)

    def to_ros_image(self, image: Image) -> Any:
        """Converts to ``sensor_msgs/Image``, with the sample type and channel order of the image."""
        return self.to_message(image)

    def from_ros_image(self, message: Any) -> Image:
        """Converts from ``sensor_msgs/Image`` or ``CompressedImage``."""
        return self.from_message(message, Image)

    def from_ros_image_to_depth(self, message: Any) -> Image:
        """Converts from ``sensor_msgs/Image`` or ``CompressedImage``; 16-bit integers and floats are kept."""
        return self.from_message(message, Image)

    def to_ros_boxes(self, boxes: BoundingBoxList) -> Any:
        """Converts to ``vision_msgs/Detection2DArray``."""
        return self.to_message(boxes)

    def from_ros_boxes(self, message: Any) -> BoundingBoxList:
        """Converts from ``vision_msgs/Detection2DArray``."""
        return self.from_message(message, BoundingBoxList)

    to_ros_bounding_box_list = to_ros_boxes
    from_ros_bounding_box_list = from_ros_boxes

    def to_ros_tracking_annotation_list(self, tracks: TrackingAnnotationList) -> Any:
        """Converts to ``vision_msgs/Detection2DArray`` with identities."""
        return self.to_message(tracks)

    def from_ros_tracking_annotation(self, message: Any) -> TrackingAnnotationList:
        """Converts from ``vision_msgs/Detection2DArray`` with identities."""
        return self.from_message(message, TrackingAnnotationList)

    def to_ros_boxes_3d(self, boxes: BoundingBox3DList) -> Any:
        """Converts to ``vision_msgs/Detection3DArray``, with the rotation as a quaternion."""
        return self.to_message(boxes)

    def from_ros_boxes_3d(self, message: Any) -> BoundingBox3DList:
        """Converts from ``vision_msgs/Detection3DArray``."""
        return self.from_message(message, BoundingBox3DList)

    def to_ros_poses(self, poses: PoseList) -> Any:
        """Converts to ``opendr_msgs/Pose2DArray``."""
        return self.to_message(poses)

    def from_ros_poses(self, message: Any) -> PoseList:
        """Converts from ``opendr_msgs/Pose2DArray``."""
        return self.from_message(message, PoseList)

    def to_ros_category(self, category: Category) -> Any:
        """Converts to ``vision_msgs/Classification`` (ROS 1: ``Classification2D``)."""
        return self.to_message(category)

    def from_ros_category(self, message: Any) -> Category:
        """Converts from ``vision_msgs/Classification``."""
        return self.from_message(message, Category)

    def to_ros_point_cloud2(self, cloud: PointCloud) -> Any:
        """Converts to ``sensor_msgs/PointCloud2`` of floats."""
        return self.to_message(cloud)

    def from_ros_point_cloud2(self, message: Any) -> PointCloud:
        """Converts from ``sensor_msgs/PointCloud2`` with any layout of fields."""
        return self.from_message(message, PointCloud)

    def from_rosarray_to_timeseries(self, message: Any) -> Timeseries:
        """Converts from ``std_msgs/Float32MultiArray``; without a layout, it has one feature."""
        return self.from_message(message, Timeseries)


class ROS2Bridge(ROSBridge):
    """OpenDR's name of the bridge for ROS 2, the same as :class:`ROSBridge`."""


def _kind_name(kind: Union[type, str, None]) -> Optional[str]:
    return kind.__name__ if isinstance(kind, type) else kind


def _kind_of(value: Any) -> str:
    """Returns the name of the first class of the value's bases that the native module converts."""
    for kind in type(value).__mro__:
        try:
            if _opendr.ros_message_types(kind.__name__):
                return kind.__name__
        except NotFound:
            continue
    raise TypeError(f"expected a datum or target, e.g. an Image, not {value!r:.200}")


def _name_of(message_class: type) -> tuple[str, bool]:
    """Returns the name of the message type, and whether it is of ROS 1 (genpy)."""
    name = getattr(message_class, "_type", None)
    if name is not None and hasattr(message_class, "_md5sum"):
        return name, True
    if hasattr(message_class, "get_fields_and_field_types"):
        return f"{message_class.__module__.split('.')[0]}/msg/{message_class.__name__}", False
    raise TypeError(f"{message_class!r} is not a message class of rclpy or rospy")


def _default_class(kind: str) -> type:
    package, _, name = _opendr.ros_message_types(kind)[0].split("/")
    module = importlib.import_module(f"{package}.msg")
    # Some names end in 2D in ROS 1's vision_msgs.
    return cast(type, getattr(module, name, None) or getattr(module, f"{name}2D"))


def _serialized(message: Any, is_ros1: bool) -> bytes:
    if is_ros1:
        buffer = io.BytesIO()
        message.serialize(buffer)
        return buffer.getvalue()
    return bytes(importlib.import_module("rclpy.serialization").serialize_message(message))


def _deserialized(data: bytes, message_class: type, is_ros1: bool) -> Any:
    if is_ros1:
        return message_class().deserialize(data)
    return importlib.import_module("rclpy.serialization").deserialize_message(data, message_class)
