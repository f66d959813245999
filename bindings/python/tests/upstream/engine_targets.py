"""Targets: constructors with positional arguments, texts and conversions."""

import numpy as np
from opendr.engine.target import (
    BaseTarget,
    BaseTranscription,
    BoundingBox,
    BoundingBox3D,
    BoundingBox3DList,
    BoundingBoxList,
    Category,
    CocoBoundingBox,
    Heatmap,
    Keypoint,
    Pose,
    Target,
    TrackingAnnotation,
    TrackingAnnotation3D,
    TrackingAnnotation3DList,
    TrackingAnnotationList,
    VoskTranscription,
    WhisperTranscription,
)

box = BoundingBox(3, 10, 20, 30, 40, 0.5)
assert box.mot(True, 7).tolist() == [7, 10, 20, 30, 40, 0.5] and box.coco()["area"] == 1200
boxes = BoundingBoxList([box])
boxes.add_box(CocoBoundingBox(1, 0, 0, 2, 2, [[0, 0, 2, 0, 2, 2]], 2, 0, 0.7))
assert len(boxes) == 2 and boxes[1].segmentation and boxes.boxes[0] is box
again = BoundingBoxList.from_coco(boxes.coco(), image_id=5)
assert again.image_id == 5 and again[0].width == 30
track = TrackingAnnotation(0, 1, 2, 3, 4, 9, 0.8, 2)
tracks = TrackingAnnotationList([track])
tracks.add_annotation(TrackingAnnotation.from_mot([2, 8, 1, 1, 1, 1]))
assert tracks.mot().tolist()[0][:2] == [2, 9] and tracks.bounding_box_list()[0].height == 4
assert TrackingAnnotationList.from_mot(tracks.mot().tolist())[1].id == 8
car = BoundingBox3D("Car", 0, 0, 0.1, [0, 0, 1, 1], [4, 1.5, 1.8], [1, 2, 3], 0.2, 0.9)
cars = BoundingBox3DList([car])
assert BoundingBox3DList.from_kitti(cars.kitti())[0].location.tolist() == [1, 2, 3]
followed = TrackingAnnotation3DList(
    [TrackingAnnotation3D("Car", 0, 0, 0.1, [0, 0, 1, 1], [4, 1.5, 1.8], [1, 2, 3], 0.2, 4, 0.9, 6)]
)
assert followed.kitti(True)["frame"].tolist() == [6] and followed.bounding_box_3d_list()[0].name == "Car"
assert str(Category(3, "cat", 0.9)) == "Class 3 (cat) with confidence 0.9" and Category(1).action is None
assert Keypoint([1.5, 2]).x == 1.5
pose = Pose(np.ones((18, 2)), 0.7)
assert pose["r_sho"].y == 1 and "nose" in str(pose) and pose.id is None
heatmap = Heatmap(np.zeros((2, 3), np.uint8), {0: "road"})
assert heatmap.shape() == (2, 3) and heatmap.class_names[0] == "road" and heatmap.opencv().shape == (2, 3)
assert str(WhisperTranscription("hello", [])) == "hello" and VoskTranscription("hi", True).accept_waveform
assert (
    isinstance(box, Target) and issubclass(Target, BaseTarget) and issubclass(WhisperTranscription, BaseTranscription)
)
