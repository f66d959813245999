"""Drawing, with and without a display."""

from __future__ import annotations

import os
import subprocess
import sys

import numpy as np
import pytest
from opendr import _show
from opendr._drawing import draw, draw_bounding_boxes, draw_target, get_bbox
from opendr.engine.data import Image
from opendr.engine.target import (
    BoundingBox,
    BoundingBoxList,
    Category,
    Heatmap,
    Pose,
    PoseList,
    TrackingAnnotation,
    TrackingAnnotationList,
)

BOXES = BoundingBoxList([BoundingBox(0, 10, 20, 30, 40, 0.9)])


def black(channels=3):
    return np.zeros((96, 128, channels), np.uint8)


@pytest.fixture
def headless(monkeypatch):
    for name in ("DISPLAY", "WAYLAND_DISPLAY"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setattr(_show.sys, "platform", "linux")


def test_opencv_pictures_are_drawn_on_in_place():
    picture = black()
    assert draw_bounding_boxes(picture, BOXES, ["person"]) is picture
    rows, columns = np.nonzero(picture.any(axis=2))
    assert picture[40, 10].any()
    assert not picture[40, 25].any()
    assert rows.max() <= 62
    assert columns.max() < 128
    with_opacity = black(4)
    draw_bounding_boxes(with_opacity, BOXES, ["person"])
    assert np.array_equal(with_opacity[:, :, :3], picture)
    assert not with_opacity[:, :, 3].any()


def test_images_stay_as_they_are():
    image = Image(black())
    image.timestamp, image.frame_id = 5, "camera"
    drawn = draw_bounding_boxes(image, BOXES, ["person"])
    picture = draw_bounding_boxes(black(), BOXES, ["person"])
    assert not image.data.any()
    assert np.array_equal(drawn.opencv(), picture)
    assert (drawn.timestamp, drawn.frame_id) == (5, "camera")


def test_colours_are_not_exchanged():
    picture = black()
    picture[:, :, 0] = 200
    draw_bounding_boxes(picture, BoundingBoxList())
    assert (picture == [200, 0, 0]).all()


def test_class_names():
    listed = draw_bounding_boxes(black(), BOXES, ["person"])
    assert np.array_equal(draw_bounding_boxes(black(), BOXES, {0: "person"}), listed)
    named = BoundingBoxList(BOXES.data, classes=["person"])
    assert np.array_equal(draw_bounding_boxes(black(), named), listed)
    assert not np.array_equal(draw_bounding_boxes(black(), BOXES, ["cat"]), listed)


def test_targets():
    pose = Pose([[10 + 5 * index, 20 + 3 * index] for index in range(18)], 0.9)
    picture = draw(black(), pose)
    assert picture[20, 10].any()
    assert np.array_equal(draw(black(), PoseList([pose])), picture)
    tracks = TrackingAnnotationList([TrackingAnnotation(0, 10, 20, 30, 40, 7, 0.9)])
    for target in (BOXES, tracks, pose, Heatmap(np.ones((96, 128), np.uint32)), Category(0, "cat", 0.9)):
        assert draw_target(black(), target).any(), target
    assert draw_target(Image(black()), BOXES).data.any()


def test_bbox_of_pose():
    points = np.full((18, 2), -1)
    assert get_bbox(Pose(points, 0.5)) == (0, 0, 0, 0)
    points[3], points[7] = [10, 40], [30, 20]
    assert get_bbox(Pose(points, 0.5)) == (10, 20, 21, 21)
    assert all(type(number) is int for number in get_bbox(Pose(points, 0.5)))


@pytest.mark.parametrize(
    ("picture", "error"),
    [
        (None, TypeError),
        ("street.jpg", TypeError),
        ([[0]], TypeError),
        (np.zeros((96, 128), np.uint8), ValueError),
        (np.zeros((3, 96, 128), np.uint8), ValueError),
        (np.zeros((96, 128, 3), np.float32), ValueError),
        (np.broadcast_to(np.uint8(0), (96, 128, 3)), ValueError),
    ],
)
def test_wrong_pictures(picture, error):
    with pytest.raises(error):
        draw_bounding_boxes(picture, BOXES)


def test_wrong_targets():
    for call in [
        lambda: draw_bounding_boxes(black(), None),
        lambda: draw_bounding_boxes(black(), [1]),
        lambda: draw_bounding_boxes(black(), BOXES, "person"),
        lambda: draw(black(), BOXES),
        lambda: draw_target(black(), 3),
    ]:
        with pytest.raises(TypeError):
            call()


def test_headless_pictures_are_written(headless, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    for name in ("opendr.png", "opendr-1.png"):
        picture = draw_bounding_boxes(black(), BOXES, ["person"], show=True)
        assert capsys.readouterr().out == f"image written to {tmp_path / name}\n"
        assert np.array_equal(Image.open(tmp_path / name).opencv(), picture)
    draw_bounding_boxes(Image(black()), BOXES, show=True)
    assert (tmp_path / "opendr-2.png").exists()


def test_a_folder_that_cannot_be_written(headless, tmp_path, monkeypatch):
    folder = tmp_path / "temporary"
    folder.mkdir()
    monkeypatch.setattr(_show.tempfile, "gettempdir", lambda: str(folder))
    # Root may write anywhere, so the current folder is removed instead.
    gone = tmp_path / "gone"
    gone.mkdir()
    monkeypatch.chdir(gone)
    gone.rmdir()
    assert _show.write_image(Image(black())) == str(folder / "opendr.png")
    monkeypatch.chdir(tmp_path)


def test_a_display_that_does_not_answer(tmp_path):
    (tmp_path / "cv2.py").write_text("import os\n\ndef namedWindow(name):\n    os.abort()\n")
    environment = {
        **os.environ,
        "DISPLAY": ":12345",
        "PYTHONPATH": os.pathsep.join([str(tmp_path), *sys.path]),
    }
    code = "from opendr import _show; print(_show.window_works())"
    seen = subprocess.run(
        [sys.executable, "-c", code],
        cwd=tmp_path,
        env=environment,
        capture_output=True,
        text=True,
        check=True,
    )
    assert seen.stdout == "False\n"


def test_a_window(tmp_path, monkeypatch):
    shown = []

    class FakeWindows:
        WND_PROP_VISIBLE = 4

        def imshow(self, title, pixels):
            shown.append(pixels)

        def waitKey(self, milliseconds):
            return -1

        def getWindowProperty(self, title, name):
            return 0.0

        def destroyWindow(self, title):
            shown.append(title)

    monkeypatch.setitem(sys.modules, "cv2", FakeWindows())
    monkeypatch.setattr(_show, "window_works", lambda: True)
    picture = draw_bounding_boxes(black(), BOXES, show=True)
    assert np.array_equal(shown[0], picture)
    assert shown[1] == "OpenDR"
