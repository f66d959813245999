"""Messages of ROS 1 and ROS 2 to data and targets and back, for nodes of your own:

    from opendr.ros_bridge import ROSBridge
    from vision_msgs.msg import Detection2DArray

    bridge = ROSBridge()
    image = bridge.from_message(message)                    # sensor_msgs/Image, CompressedImage, PointCloud2, ...
    boxes = learner.infer(image)
    publisher.publish(bridge.to_message(boxes, Detection2DArray))

The messages are those of rclpy or rospy; which ROS it is follows from their class. Stamp and frame id survive, as do scores,
identities and depth at full precision. What a message has no field for is said in docs/ros.md.
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
    """Converts messages; OpenDR's names (``to_ros_image``, ...) stand for the usual pairs.

    Args:
        class_ids: How classes are told, ``"names"`` (where one is known) or ``"numbers"``.
        jpeg_quality: Of compressed pictures, 1 (small) to 100 (good).
    """

    def __init__(self, class_ids: str = "names", jpeg_quality: int = 90) -> None:
        self.class_ids = class_ids
        self.jpeg_quality = jpeg_quality

    @overload
    def from_message(self, message: Any, kind: type[T]) -> T: ...

    @overload
    def from_message(self, message: Any, kind: Optional[str] = None) -> Any: ...

    def from_message(self, message: Any, kind: Union[type, str, None] = None) -> Any:
        """The datum or target of a message; ``kind`` where it may be several (e.g. ``TrackingAnnotationList``).

        Raises:
            opendr.Format: The message contradicts itself.
            opendr.Unsupported: It is of a kind that is not read.
        """
        name, is_ros1 = _name_of(type(message))
        return _opendr.value_from_ros(_serialized(message, is_ros1), name, is_ros1, _kind_name(kind))

    def to_message(self, value: Any, message_class: Optional[type] = None) -> Any:
        """The message of a datum or target; of the usual class when none is given.

        Raises:
            opendr.InvalidInput: The message has no place for it.
            ImportError: No package of the usual class is installed.
        """
        kind = _kind_of(value)
        if message_class is None:
            message_class = _usual_class(kind)
        name, is_ros1 = _name_of(message_class)
        data = _opendr.ros_from_value(value, kind, name, is_ros1, self.class_ids, self.jpeg_quality)
        return _deserialized(data, message_class, is_ros1)

    def to_ros_image(self, image: Image) -> Any:
        """``sensor_msgs/Image``, in the samples and the order of channels that the picture has."""
        return self.to_message(image)

    def from_ros_image(self, message: Any) -> Image:
        """The picture of a ``sensor_msgs/Image`` or ``CompressedImage``."""
        return self.from_message(message, Image)

    def from_ros_image_to_depth(self, message: Any) -> Image:
        """As :meth:`from_ros_image`: 16 bits and floats are kept."""
        return self.from_message(message, Image)

    def to_ros_boxes(self, boxes: BoundingBoxList) -> Any:
        """``vision_msgs/Detection2DArray``."""
        return self.to_message(boxes)

    def from_ros_boxes(self, message: Any) -> BoundingBoxList:
        """The boxes of a ``vision_msgs/Detection2DArray``."""
        return self.from_message(message, BoundingBoxList)

    to_ros_bounding_box_list = to_ros_boxes
    from_ros_bounding_box_list = from_ros_boxes

    def to_ros_tracking_annotation_list(self, tracks: TrackingAnnotationList) -> Any:
        """``vision_msgs/Detection2DArray`` with identities."""
        return self.to_message(tracks)

    def from_ros_tracking_annotation(self, message: Any) -> TrackingAnnotationList:
        """The followed objects of a ``vision_msgs/Detection2DArray``."""
        return self.from_message(message, TrackingAnnotationList)

    def to_ros_boxes_3d(self, boxes: BoundingBox3DList) -> Any:
        """``vision_msgs/Detection3DArray``, the turn as a quaternion."""
        return self.to_message(boxes)

    def from_ros_boxes_3d(self, message: Any) -> BoundingBox3DList:
        """The boxes of a ``vision_msgs/Detection3DArray``."""
        return self.from_message(message, BoundingBox3DList)

    def to_ros_poses(self, poses: PoseList) -> Any:
        """``opendr_msgs/Pose2DArray``."""
        return self.to_message(poses)

    def from_ros_poses(self, message: Any) -> PoseList:
        """The poses of an ``opendr_msgs/Pose2DArray``."""
        return self.from_message(message, PoseList)

    def to_ros_category(self, category: Category) -> Any:
        """``vision_msgs/Classification`` (ROS 1: ``Classification2D``)."""
        return self.to_message(category)

    def from_ros_category(self, message: Any) -> Category:
        """The class of a ``vision_msgs/Classification``."""
        return self.from_message(message, Category)

    def to_ros_point_cloud2(self, cloud: PointCloud) -> Any:
        """``sensor_msgs/PointCloud2`` of floats."""
        return self.to_message(cloud)

    def from_ros_point_cloud2(self, message: Any) -> PointCloud:
        """The cloud of a ``sensor_msgs/PointCloud2`` with any layout of fields."""
        return self.from_message(message, PointCloud)

    def from_rosarray_to_timeseries(self, message: Any) -> Timeseries:
        """The time series of a ``std_msgs/Float32MultiArray``; without a layout, one feature through time."""
        return self.from_message(message, Timeseries)


class ROS2Bridge(ROSBridge):
    """OpenDR's name of the bridge for ROS 2; both are the same here."""


def _kind_name(kind: Union[type, str, None]) -> Optional[str]:
    return kind.__name__ if isinstance(kind, type) else kind


def _kind_of(value: Any) -> str:
    """The name of the class that the native half knows, of the value or of what it derives from."""
    for kind in type(value).__mro__:
        try:
            if _opendr.ros_message_types(kind.__name__):
                return kind.__name__
        except NotFound:
            continue
    raise TypeError(f"a datum or target is wanted, e.g. an Image, not {value!r:.200}")


def _name_of(message_class: type) -> tuple[str, bool]:
    """The message's name, and whether its class is one of ROS 1 (genpy)."""
    name = getattr(message_class, "_type", None)
    if name is not None and hasattr(message_class, "_md5sum"):
        return name, True
    if hasattr(message_class, "get_fields_and_field_types"):
        return f"{message_class.__module__.split('.')[0]}/msg/{message_class.__name__}", False
    raise TypeError(f"{message_class!r} is no message of rclpy or rospy")


def _usual_class(kind: str) -> type:
    package, _, name = _opendr.ros_message_types(kind)[0].split("/")
    module = importlib.import_module(f"{package}.msg")
    # What ROS 1's vision_msgs calls otherwise.
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
