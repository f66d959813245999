"""Target classes: OpenDR's constructors, texts and conversions; JSON; wrong input."""

from __future__ import annotations

import copy
import json
import pickle
import sys

import numpy as np
import pytest
from opendr.engine.target import (
    Action,
    ActionBase,
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
    Odometry,
    Pose,
    PoseList,
    RlTarget,
    SpeechCommand,
    TextRegion,
    TextRegionList,
    Target,
    TrackingAnnotation,
    TrackingAnnotation3D,
    TrackingAnnotation3DList,
    TrackingAnnotationList,
    VoskTranscription,
    WhisperTranscription,
)

PLACE_3D = (
    "Car",
    0.0,
    1,
    -1.57,
    [599.5, 156.25, 629.75, 189.5],
    [3.69, 1.67, 1.87],
    [-16.53, 2.39, 58.49],
    1.57,
)
RUNS = {"size": [2, 2], "counts": "13"}


def box(name=0, score=0.9, **more):
    return BoundingBox(name, 10.5, 20, 30, 40.25, score, **more)


def track(name=0, **more):
    return TrackingAnnotation(name, 10, 20.5, 30, 40, 7, 0.9, 3, **more)


def pose(**more):
    points = np.full((18, 2), -1)
    points[1] = [64, 32]
    return Pose(points, 0.75, **more)


CORNERS = [[1, 2], [11, 2.5], [11, 8], [1, 7.5]]


def every_target():
    coco = CocoBoundingBox(1, 1, 2, 3, 4, [[1, 2, 4, 2, 4, 6]], 6, 1, 0.5, class_name="cat", landmarks=[[1, 2]])
    return [
        Category(3, "cat", 0.9),
        Keypoint([120, 64.5], 0.5),
        Category(1, confidence=[0.25, 0.75]),
        box(),
        coco,
        CocoBoundingBox("cat", 1, 2, 3, 4, RUNS, 3),
        CocoBoundingBox(1, 1, 2, 3, 4, area=6, iscrowd=1),
        BoundingBoxList([box(), coco], image_id=7, classes=["dog", "cat"]),
        track(),
        TrackingAnnotationList([track(landmarks=[(1, 2)], segmentation=RUNS, area=3)], classes=["dog"]),
        BoundingBox3D(*PLACE_3D, 0.8),
        BoundingBox3DList([BoundingBox3D(*PLACE_3D, 0.8)]),
        TrackingAnnotation3D(*PLACE_3D, 3, 0.8, 12),
        TrackingAnnotation3DList([TrackingAnnotation3D(*PLACE_3D, 3, 0.8)]),
        pose(id=4),
        PoseList([pose(), Pose([[1.5, 2.5]] * 17, 0.5, keypoint_confidences=[0.5] * 17)]),
        Heatmap(np.array([[0, 1], [1, 0]], np.uint32), {0: "road", 1: "car"}),
        Heatmap(np.array([0.5, 0.25], np.float32)),
        TextRegion("EXIT", CORNERS, 0.75),
        TextRegionList([TextRegion("EXIT", CORNERS, 0.75), TextRegion("###", CORNERS)]),
        Odometry((0.5, 0.0, 2.0), (0.0, 0.6, 0.0, 0.8), 120),
        Odometry(),
        SpeechCommand("stop", 0.75, (0.5, 1.25)),
        SpeechCommand(3),
        RlTarget([0.5, -1.0]),
        BaseTranscription("turn left"),
        VoskTranscription("turn", True),
        WhisperTranscription(" turn left", [{"id": 0, "start": 0.5, "end": 1.5, "text": " turn left"}]),
    ]


@pytest.fixture(params=every_target(), ids=lambda target: type(target).__name__)
def target(request):
    return copy.deepcopy(request.param)


def test_value_semantics(target):
    target.timestamp, target.frame_id, target.action = 5, "camera", [0.5, -1]
    for other in (copy.deepcopy(target), pickle.loads(pickle.dumps(target))):
        assert other == target
        assert (other.timestamp, other.frame_id, other.action) == (5, "camera", Action([0.5, -1.0]))
        other.action = None
        assert other != target
    assert isinstance(target, Target)
    assert isinstance(target, BaseTarget)
    assert repr(target).startswith(f"{type(target).__name__}(")
    assert target != 3


def test_json_round_trip(target):
    target.timestamp, target.frame_id = 5, "camera"
    if isinstance(target, WhisperTranscription):
        target = WhisperTranscription.from_json(target.to_json())
    read = type(target).from_json(target.to_json())
    assert type(read) is type(target)
    assert read.to_json() == target.to_json()
    if isinstance(target, Keypoint):
        assert target.to_json() == '{"x":120.0,"y":64.5,"confidence":0.5}'
        return
    assert json.loads(target.to_json())["stamp_ns"] == 5
    assert (read.timestamp, read.frame_id) == (5, "camera")
    names = {field for field in target._fields if field != "class_name"}
    if not isinstance(target, (BoundingBoxList, TrackingAnnotationList)):
        assert {name: repr(read._field(name)) for name in names} == {name: repr(target._field(name)) for name in names}
    with pytest.raises(TypeError, match="the JSON is of a"):
        (Heatmap if not isinstance(target, Heatmap) else Category).from_json(target.to_json())


def test_wrong_json():
    for text in ("", "{}", "[]", '{"type": "Image"}', '{"type": "BoundingBoxList", "boxes": [{}]}'):
        with pytest.raises(ValueError):
            BoundingBoxList.from_json(text)
    for text in ("3", "{}", "x"):
        with pytest.raises(ValueError):
            Keypoint.from_json(text)
    with pytest.raises(TypeError, match="BoundingBoxList"):
        BoundingBox.from_json(BoundingBoxList([box(), box()]).to_json())


def test_action():
    assert Action([0.5, -1]).axes == (0.5, -1.0)
    assert (len(Action([1])), Action([1, 0])[0], list(Action([0.5]))) == (1, 1.0, [0.5])
    assert isinstance(Action([0]), ActionBase)
    assert str(Action([0.5, -1])) == "Action [0.5, -1.0]"
    for axes in ([], [0] * 5, [1.01], [float("nan")]):
        with pytest.raises(ValueError):
            Action(axes)
    for axes in (None, ["a"], 3):
        with pytest.raises(TypeError, match="list of 1 to 4 numbers"):
            Action(axes)
    with pytest.raises(TypeError):
        box().action = "left"


def test_target_is_open():
    found = Target()
    assert (found.data, found.confidence, found.action) == (None, None, None)
    found.data, found.confidence = [1], 0.5
    assert (found.data, found.confidence) == ([1], 0.5)


def test_category():
    assert str(Category(3, confidence=0.9)) == "Class 3 with confidence 0.9"
    assert str(Category(3)) == "Class 3 "
    assert str(Category(3, "cat", 1)) == "Class 3 (cat) with confidence 1.0"
    assert str(Category(np.int64(3), "cat")) == "Class 3, (cat)"
    scores = Category(1, confidence=np.array([0.25, 0.75]))
    assert str(scores) == "Class 1 with confidence [0.25 0.75]"
    assert np.array_equal(scores.confidence, [0.25, 0.75])
    both = Category(1, confidence=0.75, probabilities=[0.25, 0.75])
    assert (both.confidence, both.probabilities.tolist()) == (0.75, [0.25, 0.75])
    assert type(Category(np.int32(3), confidence=np.float32(0.5)).data) is int
    for wrong in ("cat", 1.5, None, [1]):
        with pytest.raises(ValueError, match="give an int"):
            Category(wrong)
    with pytest.raises(TypeError, match="description"):
        Category(1, 3)
    with pytest.raises(ValueError, match="finite"):
        Category(1, confidence=float("nan"))


def test_keypoint():
    point = Keypoint([120, 64.5], 0.5)
    assert (point.x, point[1], point["x"], list(point), point.confidence) == (
        120.0,
        64.5,
        120.0,
        [120.0, 64.5],
        0.5,
    )
    x, y = point
    assert (x, y, str(point)) == (120.0, 64.5, "[120.0, 64.5]")
    assert np.asarray(point).tolist() == [120.0, 64.5]
    assert np.array([point, point]).shape == (2, 2)
    for key in ("z", None):
        with pytest.raises(ValueError, match="'x' and 'y'"):
            point[key]
    with pytest.raises(IndexError):
        point[2]
    for wrong in ([1], [1, 2, 3], [1, float("nan")]):
        with pytest.raises(ValueError):
            Keypoint(wrong)
    for wrong in (None, "12", ["1", "2"]):
        with pytest.raises(TypeError):
            Keypoint(wrong)


def test_pose():
    found = pose()
    text = str(found)
    beginning = "Pose ID: None\nDetection confidence: 0.75\nKeypoints name-position:\nnose: [-1, -1]\nneck: [64, 32]\n"
    assert text.startswith(beginning)
    assert text.endswith("l_ear: [-1, -1]\n")
    names = [line.split(":")[0] for line in text.splitlines()[3:]]
    assert tuple(names) == found.joints == tuple(Pose.kpt_names)
    # OpenDR crashes for a list.
    assert str(Pose(found.data.tolist(), 0.75)) == text
    assert (found["neck"].x, found[1].y, len(found), found.skeleton) == (64.0, 32.0, 18, "opendr18")
    assert (found.data.dtype, found.data.shape) == (np.float32, (18, 2))
    found.id = 4
    assert str(found).startswith("Pose ID: 4\n")
    for key in (18, -1, "tail", 1.5):
        with pytest.raises((ValueError, TypeError)):
            found[key]


def test_pose_of_other_skeletons():
    points = [Keypoint([index, 0.5], index / 17) for index in range(17)]
    found = Pose(points, 0.5)
    assert (found.skeleton, found["l_eye"].x, found.data.dtype) == ("coco17", 1.0, np.float32)
    assert found.keypoint_confidences[16] == np.float32(16 / 17)
    assert found.keypoints == [Keypoint(p.data, np.float32(p.confidence)) for p in points]
    assert [line.split(":")[0] for line in str(found).splitlines()[3:]] == list(found.joints)
    assert Pose(points[:3], 0.5).skeleton == "opendr18"
    with pytest.raises(ValueError, match="unknown skeleton 'dog'"):
        Pose(points, 0.5, skeleton="dog")
    for wrong in (np.zeros((18, 3)), np.zeros((0, 2)), [], np.full((18, 2), np.nan), np.zeros(18)):
        with pytest.raises(ValueError):
            Pose(wrong, 0.5)
    for wrong in (None, "pose", [["a", "b"]]):
        with pytest.raises(TypeError):
            Pose(wrong, 0.5)
    with pytest.raises(TypeError, match="confidence"):
        Pose(points, None)


def test_lists():
    boxes = BoundingBoxList()
    assert (len(boxes), boxes.confidence, str(boxes), boxes.image_id) == (0, 0, "[]", -1)
    boxes.add_box(box(score=0.5))
    # OpenDR's learners append to the list itself.
    boxes.data.append(box(score=1.0))
    assert (boxes.confidence, len(boxes), boxes[1].confidence, boxes.boxes is boxes.data) == (
        0.75,
        2,
        1.0,
        True,
    )
    assert [found.confidence for found in boxes[:1]] == [0.5]
    assert len(list(boxes)) == 2
    with pytest.raises(AttributeError, match="mean of its items'"):
        boxes.confidence = 0.5
    for wrong in (3, [1], [box(), None], "boxes", [track()]):
        with pytest.raises(TypeError):
            BoundingBoxList(wrong)
    with pytest.raises(TypeError, match="contains BoundingBox objects"):
        boxes.add_box(track())
    tracks = TrackingAnnotationList(found for found in [track()])
    tracks.add_annotation(track())
    assert (len(tracks), tracks.confidence) == (2, 0.9)
    with pytest.raises(TypeError, match="a name in classes"):
        BoundingBoxList([], classes=[3])


def test_bounding_box():
    found = box()
    assert str(found) == "[-1.   10.5  20.   30.   40.25  0.9 ]"
    assert found.mot().dtype == np.float32
    assert found.mot(frame=3).tolist() == [3, 10.5, 20, 30, 40.25, np.float32(0.9)]
    assert found.mot(with_confidence=False).tolist() == [-1, 10.5, 20, 30, 40.25]
    plain = {"bbox": [10.5, 20.0, 30.0, 40.25], "category_id": 0, "area": 1207.5}
    assert found.coco(with_confidence=False) == plain
    assert found.coco() == {**plain, "confidence": 0.9}
    assert box(np.int64(3)).name == 3
    assert box(np.str_("person")).name == "person"
    exact = np.float32(0.9)
    assert BoundingBox(0, *[np.float32(1.5)] * 4, exact).confidence == exact
    assert box().landmarks is not box().landmarks


@pytest.mark.parametrize(
    ("arguments", "error", "message"),
    [
        ((None, 1, 2, 3, 4), TypeError, "name should be"),
        ((1.5, 1, 2, 3, 4), TypeError, "name should be"),
        ((0, None, 2, 3, 4), TypeError, "left should be a number"),
        ((0, 1, "2", 3, 4), TypeError, "top should be a number"),
        ((0, 1, 2, [3], 4), TypeError, "width should be a number"),
        ((0, 1, 2, 3, float("nan")), ValueError, "height is nan"),
        ((0, 1, 2, 3, 4, float("inf")), ValueError, "score is inf"),
    ],
)
@pytest.mark.filterwarnings("ignore::DeprecationWarning")
def test_wrong_boxes(arguments, error, message):
    with pytest.raises(error, match=message):
        BoundingBox(*arguments)
    with pytest.raises(error, match=message):
        CocoBoundingBox(*arguments[:5], score=arguments[5] if len(arguments) > 5 else 0)


def test_nan_that_is_set_later_is_refused():
    found = box()
    found.left = float("nan")
    for call in (found.to_json, found.mot, found.__str__):
        with pytest.raises(ValueError):
            call()


def test_coco_boxes():
    first, second = CocoBoundingBox(1, 0, 0, 2, 2), CocoBoundingBox(1, 0, 0, 2, 2)
    first.segmentation.append([1.0])
    assert second.segmentation == []
    found = CocoBoundingBox(1, 0, 0, 2, 2, {"size": (2, 2), "counts": b"13"}, 3, True, 0.5)
    assert str(found) == (
        "{'bbox': [0.0, 0.0, 2.0, 2.0], 'category_id': 1, 'area': 3.0, "
        "'segmentation': {'size': [2, 2], 'counts': '13'}, 'iscrowd': 1, 'confidence': 0.5}"
    )
    assert found.coco() == {
        **{"bbox": [0.0, 0.0, 2.0, 2.0], "category_id": 1, "area": 3.0},
        **{"segmentation": RUNS, "iscrowd": 1, "confidence": 0.5},
    }
    assert "confidence" not in found.coco(with_confidence=False)
    for wrong in ({"size": [2, 2]}, {"counts": "13"}, {"size": [2], "counts": "13"}):
        with pytest.raises(ValueError, match="'size'"):
            CocoBoundingBox(1, 0, 0, 2, 2, wrong)
    with pytest.raises(TypeError, match="segmentation"):
        CocoBoundingBox(1, 0, 0, 2, 2, "13")


def test_bounding_box_list_conversions():
    boxes = BoundingBoxList([box(), BoundingBox("person", -1, 2, 300, 4, 0.5)])
    wanted = "[[ -1.    10.5   20.    30.    40.25   0.9 ]\n [ -1.    -1.     2.   300.     4.     0.5 ]]"
    assert str(boxes) == str(boxes.mot()) == wanted
    assert (boxes.mot(False).shape, boxes.mot().dtype) == ((2, 5), np.float32)
    assert BoundingBoxList().mot().shape == (0, 6)
    entries = boxes.coco()
    assert [entry["category_id"] for entry in entries] == [0, "person"]
    read = BoundingBoxList.from_coco(entries, image_id=5)
    assert (read.data, read.image_id) == (boxes.data, 5)
    assert all(entry["image_id"] == 5 for entry in read.coco())
    outlined = BoundingBoxList.from_coco(
        [
            {
                "bbox": np.array([0, 0, 2, 2]),
                "category_id": np.int64(1),
                "segmentation": [[0, 0, 2, 0, 2, 2]],
                "iscrowd": 0,
            }
        ]
    )
    assert type(outlined[0]) is CocoBoundingBox
    assert (outlined[0].area, outlined[0].confidence) == (4.0, 0.0)
    for wrong in (
        [{}],
        [3],
        [{"bbox": [1, 2, 3], "category_id": 1}],
        [{"bbox": [1, 2, 3, np.nan], "category_id": 1}],
    ):
        with pytest.raises(ValueError):
            BoundingBoxList.from_coco(wrong)


def test_tracks():
    row = [3.0, 7.0, 10.0, 20.5, 30.0, 40.0, 0.9]
    found = TrackingAnnotation.from_mot(np.array(row, np.float32))
    assert (found.id, found.frame, found.name, found.left) == (7, 3, 0, 10.0)
    assert str(found) == "[ 3.   7.  10.  20.5 30.  40.   0.9]"
    assert found.mot().tolist() == np.array(row, np.float32).tolist()
    assert found.mot(with_confidence=False).tolist() == row[:6]
    assert TrackingAnnotation.from_mot(row[:6]).confidence == 1.0
    tracks = TrackingAnnotationList.from_mot(np.array([row, row]))
    assert tracks.mot().shape == (2, 7)
    assert tracks.mot(False).shape == (2, 6)
    assert (len(TrackingAnnotationList.from_mot([])), TrackingAnnotationList().mot().shape) == (0, (0, 7))
    for wrong in (row[:5], [float("nan")] * 7):
        with pytest.raises(ValueError):
            TrackingAnnotation.from_mot(wrong)
    with pytest.raises(TypeError):
        TrackingAnnotationList.from_mot(["abcdef"])
    with pytest.raises(TypeError, match="id should be an int"):
        TrackingAnnotation(0, 1, 2, 3, 4, "7")


def test_tracks_without_identity():
    tracks = TrackingAnnotationList([track(class_name="dog"), track(segmentation=RUNS, area=3)], classes=["dog"])
    tracks.timestamp, tracks.frame_id = 5, "camera"
    boxes = tracks.bounding_box_list()
    assert (boxes.timestamp, boxes.frame_id, boxes.classes) == (5, "camera", ["dog"])
    assert boxes[0] == BoundingBox(0, 10, 20.5, 30, 40, 0.9, class_name="dog")
    assert boxes[1] == CocoBoundingBox(0, 10, 20.5, 30, 40, RUNS, 3, 0, 0.9)


def test_boxes_in_space():
    found = BoundingBox3D(*PLACE_3D, 0.8)
    assert (found.name, found.occluded, found.rotation_y, found.location[2]) == ("Car", 1, 1.57, 58.49)
    assert found.data["dimensions"].tolist() == [3.69, 1.67, 1.87]
    columns = found.kitti()
    assert str(found) == str(columns)
    assert list(columns) == [
        *("name", "truncated", "occluded", "alpha", "bbox", "dimensions", "location", "rotation_y", "score"),
        *("index", "group_ids"),
    ]
    assert (columns["bbox"].shape, columns["index"].dtype, columns["name"][0]) == ((1, 4), np.int32, "Car")
    ignored = BoundingBox3D("DontCare", -1, -1, -10, [0] * 4, [-1] * 3, [-1000] * 3, -10)
    boxes = BoundingBox3DList([found, ignored])
    assert boxes.kitti()["index"].tolist() == [0, -1]
    assert str(boxes) == str(boxes.kitti())
    assert BoundingBox3DList.from_kitti(boxes.kitti()).data == boxes.data
    assert BoundingBox3DList().kitti()["location"].shape == (0, 3)
    assert len(BoundingBox3DList.from_kitti(BoundingBox3DList().kitti())) == 0
    with pytest.raises(ValueError, match="^truncated, occluded"):
        BoundingBox3DList.from_kitti({"name": ["Car"]})
    with pytest.raises(ValueError, match="give one per box"):
        BoundingBox3DList.from_kitti({**boxes.kitti(), "alpha": [1.0]})
    for at, value in [(4, [1, 2, 3]), (5, [1, 2]), (6, [1, 2, np.nan]), (3, np.inf)]:
        with pytest.raises(ValueError):
            BoundingBox3D(*PLACE_3D[:at], value, *PLACE_3D[at + 1 :])
    with pytest.raises(TypeError, match="location should be 3 numbers"):
        BoundingBox3D(*PLACE_3D[:6], None, 0.0)


def test_tracks_in_space():
    found = TrackingAnnotation3D(*PLACE_3D, 3, 0.8, 12)
    # OpenDR raises AttributeError.
    assert (found.action, found.id, found.frame) == (None, 3, 12)
    assert str(found) == str(found.kitti(True))
    assert {"id", "frame"} & set(found.kitti(False)) == set()
    assert found.bounding_box_3d() == BoundingBox3D(*PLACE_3D, 0.8)
    tracks = TrackingAnnotation3DList([found, TrackingAnnotation3D(*PLACE_3D, 4)])
    columns = tracks.kitti()
    assert (columns["id"].tolist(), columns["frame"].tolist()) == ([3, 4], [12, -1])
    assert TrackingAnnotation3DList.from_kitti(columns, columns["id"], columns["frame"]).data == tracks.data
    assert TrackingAnnotation3DList.from_kitti(columns, [3, 4])[0].frame == -1
    assert tracks.bounding_box_3d_list().data == [BoundingBox3D(*PLACE_3D, score) for score in (0.8, 0)]
    assert TrackingAnnotation3DList().kitti()["id"].shape == (0,)
    with pytest.raises(ValueError):
        TrackingAnnotation3DList.from_kitti(columns, [3])


def test_heatmap():
    labels = np.array([[0, 0], [0, 11]])
    found = Heatmap(labels, {0: "road"})
    assert (str(found), found.shape(), found.class_names) == ("[[ 0  0]\n [ 0 11]]", (2, 2), {0: "road"})
    assert found.data is labels
    assert not np.shares_memory(found.numpy(), labels)
    assert np.array_equal(found.opencv(), labels)
    assert np.shares_memory(np.asarray(found), labels)
    assert str(Heatmap(np.array([0.5, -1.0], np.float32))) == "[ 0.5 -1. ]"
    for wrong in (None, [[0, 1]], "map", np.array(["a"]), np.array([None])):
        with pytest.raises(TypeError, match="NumPy array"):
            Heatmap(wrong)
    for wrong in (np.float32(1), np.array(1.0), np.zeros((1,) * 9), np.array([-1])):
        with pytest.raises((ValueError, TypeError)):
            Heatmap(wrong)
    for wrong in (["road"], {0: 3}):
        with pytest.raises(TypeError):
            Heatmap(labels, wrong)


def test_heatmaps_of_huge_class_numbers():
    with pytest.raises(ValueError, match="class index 4000000000 is too high"):
        Heatmap(np.zeros((2, 2), int), {4_000_000_000: "sky"}).to_json()
    with pytest.raises(ValueError, match="indices up to 4294967296"):
        Heatmap(np.array([1 << 32])).to_json()
    found = Heatmap(np.array([(1 << 32) - 1]), {"other": "road", -1: "none", 1: "sky"})
    assert json.loads(found.to_json())["classes"] == ["", "sky"]
    assert Heatmap.from_json(found.to_json()).data.tolist() == [(1 << 32) - 1]


def test_speech():
    command = SpeechCommand("stop", 0.75, [0.5, 1])
    assert (str(command), command.command, command.span_s) == (
        "Command stop with confidence 0.75",
        "stop",
        (0.5, 1.0),
    )
    assert str(BaseTranscription("turn left")) == "turn left"
    vosk = VoskTranscription("turn", accept_waveform=True)
    assert (vosk.text, vosk.data, vosk.accept_waveform, str(vosk)) == ("turn", "turn", True, "turn")
    whisper = WhisperTranscription(" hello", [{"start": 0.5}])
    assert (whisper.segments[0]["start"], str(whisper)) == (0.5, " hello")
    assert isinstance(whisper, BaseTranscription)
    for call in [
        lambda: BaseTranscription(None),
        lambda: WhisperTranscription("a", ["b"]),
        lambda: SpeechCommand(1.5),
        lambda: SpeechCommand("stop", "loud"),
    ]:
        with pytest.raises(TypeError):
            call()
    with pytest.raises(ValueError):
        SpeechCommand("stop", 0.5, [0.5])


def test_odometry_is_a_matrix_or_unknown():
    half = 0.5**0.5
    odometry = Odometry([1, 2, 3], [0, half, 0, half], 80)
    assert odometry.data == odometry.position == (1.0, 2.0, 3.0)
    # Turned to the right: what was ahead of the camera is now to its left.
    ahead = odometry.matrix @ [0, 0, 1, 1]
    np.testing.assert_allclose(ahead, [2, 2, 3, 1], atol=1e-12)
    with pytest.raises(ValueError, match="tracking begins or is lost"):
        Odometry().matrix  # noqa: B018
    for call in [lambda: Odometry([1, 2, 3]), lambda: Odometry([1, 2, float("nan")], [0, 0, 0, 1])]:
        with pytest.raises(ValueError):
            call()


def test_rl_target_is_an_array_and_a_number():
    target = RlTarget([0.5, -1])
    assert (str(target), len(target), target.data.dtype) == ("[ 0.5 -1. ]", 2, np.float32)
    assert np.array_equal(np.asarray(target), [0.5, -1])
    assert (int(RlTarget([1])), float(RlTarget(0.5)), [10, 20][RlTarget([1])]) == (1, 0.5, 20)
    with pytest.raises(ValueError):
        int(target)
    with pytest.raises(TypeError):
        RlTarget("left")


def test_supervision_is_missing(monkeypatch):
    monkeypatch.setitem(sys.modules, "supervision", None)
    with pytest.raises(ImportError, match="pip install supervision"):
        BoundingBoxList([box()]).to_supervision()


def test_supervision():
    pytest.importorskip("supervision")
    found = BoundingBoxList([box(1), box("dog"), box("cow")], classes=["dog", "cat"]).to_supervision()
    assert np.array_equal(found.xyxy[0], [10.5, 20, 40.5, 60.25])
    assert (found.class_id.tolist(), found.tracker_id) == ([1, 0, -1], None)
    assert list(found.data["class_name"]) == ["cat", "dog", "cow"]
    assert np.allclose(found.confidence, 0.9)
    assert len(BoundingBoxList().to_supervision()) == 0
    assert TrackingAnnotationList([track()]).to_supervision().tracker_id.tolist() == [7]
