"""Conversion to the package supervision, and what its annotators and metrics do with it."""

from __future__ import annotations

import sys

import numpy as np
import opendr
import pytest
import supervision
import supervision.metrics
from opendr.engine.target import (
    BoundingBox,
    BoundingBoxList,
    Category,
    CocoBoundingBox,
    Heatmap,
    Pose,
    PoseList,
    TextRegion,
    TextRegionList,
    TrackingAnnotation,
    TrackingAnnotationList,
)

#: 2 to 4 of 5 columns, 1 to 2 of 4 rows, as runs down the columns.
RUNS = {"size": [4, 5], "counts": [9, 2, 2, 2, 2, 2, 1]}
MASK = np.zeros((4, 5), bool)
MASK[1:3, 2:5] = True
#: The same pixels.
POLYGON = [[2, 1, 5, 1, 5, 3, 2, 3]]


def frame():
    return np.zeros((96, 128, 3), np.uint8)


def test_masks_of_boxes():
    boxes = BoundingBoxList([CocoBoundingBox(0, 2, 1, 3, 2, RUNS, 6), BoundingBox(0, 0, 0, 1, 1)], classes=["person"])
    found = boxes.to_supervision()
    assert found.mask.dtype == bool
    assert np.array_equal(found.mask, [MASK, np.zeros_like(MASK)])
    assert found.mask.flags.writeable
    assert BoundingBoxList([BoundingBox(0, 0, 0, 1, 1)]).to_supervision().mask is None
    # COCO's boxes without a mask.
    assert BoundingBoxList([CocoBoundingBox(0, 0, 0, 1, 1)]).to_supervision().mask is None
    assert np.array_equal(boxes.to_supervision(image_size=(4, 5)).mask[0], MASK)


def test_polygons_need_the_size_of_the_image():
    boxes = BoundingBoxList([CocoBoundingBox(0, 2, 1, 3, 2, POLYGON, 6)])
    with pytest.raises(opendr.InvalidInput, match=r"give image_size=\(height, width\)"):
        boxes.to_supervision()
    assert np.array_equal(boxes.to_supervision((4, 5)).mask[0], MASK)
    assert boxes.to_supervision((40, 50)).mask.shape == (1, 40, 50)
    # Run lengths state the size for the polygons of the same image.
    both = BoundingBoxList([CocoBoundingBox(0, 2, 1, 3, 2, POLYGON, 6), CocoBoundingBox(0, 2, 1, 3, 2, RUNS, 6)])
    assert np.array_equal(both.to_supervision().mask, [MASK, MASK])
    with pytest.raises(opendr.InvalidInput, match="a mask has 4x5 pixels, the image 4x6"):
        both.to_supervision((4, 6))


def test_masks_of_tracks():
    tracks = TrackingAnnotationList([TrackingAnnotation(0, 2, 1, 3, 2, 7, 0.9, segmentation=RUNS, area=6)])
    found = tracks.to_supervision()
    assert found.tracker_id.tolist() == [7]
    assert np.array_equal(found.mask, [MASK])


def test_key_points():
    points = np.full((17, 2), [10.0, 20.0])
    points[3] = -1
    region = BoundingBox(0, 5, 6, 7, 8)
    poses = PoseList([Pose(points, 0.75, id=4, keypoint_confidences=[0.5] * 17, region=region), Pose(points, 0.5, region=region)])
    found = poses.to_supervision()
    assert isinstance(found, supervision.KeyPoints)
    assert found.xy.shape == (2, 17, 2) and found.xy.dtype == np.float32
    assert found.keypoint_confidence[0].tolist() == [0.5] * 17
    assert found.detection_confidence.tolist() == [0.75, 0.5]
    assert found.visible[0].tolist() == [joint != 3 for joint in range(17)]
    assert found.data["tracker_id"].tolist() == [4, -1]
    assert found.data["xyxy"].tolist() == [[5, 6, 12, 14]] * 2
    assert PoseList([Pose(points, 0.5)]).to_supervision().data == {}
    assert len(PoseList().to_supervision()) == 0
    with pytest.raises(opendr.Unsupported, match="the poses have 17 and 18"):
        PoseList([Pose(points, 0.5), Pose([[1, 2]] * 18, 0.5)]).to_supervision()


def test_key_points_are_drawn_where_the_joints_are():
    points = np.stack([np.linspace(10, 90, 17), np.linspace(20, 80, 17)], axis=1)
    found = PoseList([Pose(points, 0.75)]).to_supervision()
    drawn = supervision.VertexAnnotator(radius=2).annotate(frame(), found)
    assert all(drawn[int(y), int(x)].any() for x, y in points)
    assert supervision.EdgeAnnotator().annotate(frame(), found).any()


def test_old_versions_are_refused(monkeypatch):
    monkeypatch.delitem(supervision.KeyPoints.__dataclass_fields__, "detection_confidence")
    with pytest.raises(ImportError, match="0.29 or later, not .*: pip install --upgrade supervision"):
        PoseList().to_supervision()


def test_classifications():
    found = Category(1, "cat", 0.75, probabilities=[0.25, 0.75]).to_supervision()
    assert isinstance(found, supervision.Classifications)
    assert found.class_id.tolist() == [0, 1] and found.confidence.tolist() == [0.25, 0.75]
    assert [int(index) for index in found.get_top_k(1)[0]] == [1]
    alone = Category(3, "dog", 0.5).to_supervision()
    assert alone.class_id.tolist() == [3] and alone.confidence.tolist() == [0.5]
    assert Category(3).to_supervision().confidence is None


def test_class_maps():
    found = Heatmap(np.array([[0, 2, 2], [0, 2, 5]], np.uint32), {2: "car", 5: "bus"}).to_supervision()
    assert found.class_id.tolist() == [2, 5] and found.data["class_name"].tolist() == ["car", "bus"]
    assert found.mask.tolist() == [[[False, True, True], [False, True, False]], [[False] * 3, [False, False, True]]]
    assert found.xyxy.tolist() == [[1, 0, 3, 2], [2, 1, 3, 2]]
    # Class 0 counts where it has a name other than that of the background.
    for names, classes in (({0: "Background"}, [1]), ({0: "road"}, [0, 1]), (None, [1])):
        assert Heatmap(np.array([[0, 1]], np.uint32), names).to_supervision().class_id.tolist() == classes
    assert len(Heatmap(np.zeros((2, 2), np.uint32)).to_supervision()) == 0
    for other in (np.zeros((2, 2), np.float32), np.zeros((2, 2, 2), np.uint32)):
        with pytest.raises(opendr.Unsupported, match="e.g. the argmax of scores"):
            Heatmap(other).to_supervision()


def test_texts():
    corners = [[1, 2], [11, 2.5], [11, 8], [1, 7.5]]
    found = TextRegionList([TextRegion("EXIT", corners, 0.75)]).to_supervision()
    assert found.xyxy.tolist() == [[1, 2, 11, 8]] and found.confidence.tolist() == [0.75]
    assert found.data["class_name"].tolist() == ["EXIT"] and found.data["xyxyxyxy"][0].tolist() == corners
    assert supervision.OrientedBoxAnnotator().annotate(frame(), found).any()
    assert len(TextRegionList().to_supervision()) == 0


@pytest.mark.parametrize("target", [PoseList(), Category(0), Heatmap(np.zeros((1, 1), np.uint32)), TextRegionList()])
def test_supervision_is_missing(target, monkeypatch):
    monkeypatch.setitem(sys.modules, "supervision", None)
    with pytest.raises(ImportError, match="pip install supervision"):
        target.to_supervision()


def test_metrics_of_supervision(nanodet, photo):
    found = nanodet.infer(photo).to_supervision()
    half = found[: len(found) // 2]
    metric = supervision.metrics.MeanAveragePrecision()
    assert metric.update(found, found).compute().map50_95 == pytest.approx(1.0)
    assert metric.update(half, found).compute().map50_95 < 0.99
