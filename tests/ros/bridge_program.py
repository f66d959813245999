"""Tests the bridge of the Python package on real messages, in a Python with rclpy; prints the results as JSON."""

import json
import sys

from opendr.engine.data import Image
from opendr.engine.target import BoundingBox, BoundingBoxList, TrackingAnnotationList
from opendr.ros_bridge import ROS2Bridge, ROSBridge
from sensor_msgs.msg import CompressedImage, PointCloud2
from sensor_msgs.msg import Image as ImageMessage
from std_msgs.msg import String
from vision_msgs.msg import Detection2DArray


def main():
    bridge = ROSBridge()
    message = ImageMessage()
    message.header.frame_id = "eye"
    message.header.stamp.sec = 7
    message.height, message.width, message.encoding, message.step = 2, 3, "bgr8", 9
    message.data = bytes(range(18))
    image = bridge.from_message(message)
    again = bridge.to_ros_image(image)
    depth = ImageMessage(height=1, width=2, encoding="16UC1", step=4, data=b"\xff\xff\x01\x00")
    boxes = BoundingBoxList([BoundingBox(name=3, left=1.5, top=2, width=10, height=4, score=0.25)])
    detections = ROS2Bridge().to_ros_boxes(boxes)
    back = bridge.from_ros_boxes(detections)
    tracks = bridge.from_message(detections, TrackingAnnotationList)
    compressed = bridge.to_message(image, CompressedImage)
    errors = []
    for broken in (ImageMessage(height=2, width=2, encoding="rgb8", step=6), PointCloud2(width=1, height=1), String(), 3):
        try:
            bridge.from_message(broken, None if broken != 3 else "Image")
        except Exception as error:
            errors.append(type(error).__name__)
    json.dump(
        {
            "shape": list(image.numpy().shape),
            "frame_id": image.frame_id,
            "stamp": image.timestamp,
            "first": image.numpy()[:, 0, 0].tolist(),
            "same": bytes(again.data) == bytes(message.data) and again.encoding == "bgr8" and again.header == message.header,
            "depth": bridge.from_ros_image_to_depth(depth).numpy().ravel().tolist(),
            "class_id": detections.detections[0].results[0].hypothesis.class_id,
            "centre": detections.detections[0].bbox.center.position.x,
            "back": [back[0].left, back[0].top, back[0].width, back[0].height, back[0].confidence, back[0].name],
            "tracks": len(tracks),
            "jpeg": bytes(compressed.data[:2]).hex(),
            "usual": type(bridge.to_message(image)).__name__,
            "detections": isinstance(detections, Detection2DArray),
            "errors": errors,
            "image": isinstance(image, Image),
        },
        sys.stdout,
    )


main()
