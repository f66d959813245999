"""Drawings of targets: the image that they belong to, files, windows, notebooks."""

from __future__ import annotations

import copy
import gc
import json
import os
import pickle
import sys
import weakref

import numpy as np
import opendr
import pytest
from opendr import _show
from opendr._drawing import draw_bounding_boxes, draw_target
from opendr._viewing import _IMAGES
from opendr.engine._image_reference import ImageReference
from opendr.engine.data import Image
from opendr.engine.target import (
    BoundingBox,
    BoundingBoxList,
    Category,
    Heatmap,
    Keypoint,
    Pose,
    TextRegion,
    TextRegionList,
    TrackingAnnotation,
    WhisperTranscription,
)
from test_target import every_target

PNG = b"\x89PNG\r\n\x1a\n"


def boxes():
    return BoundingBoxList([BoundingBox(0, 10, 20, 30, 40, 0.9)], classes=["person"])


def black(channels=3):
    return np.zeros((96, 128, channels), np.uint8)


def predicted(image, target=None):
    """Returns a target as a learner returns it for an image."""
    target = boxes() if target is None else target
    target._image = ImageReference.to(image)
    return target


def same(one, other):
    return np.array_equal(one.data, other.data)


DRAWN = ("BoundingBox", "CocoBoundingBox", "BoundingBoxList", "TrackingAnnotation", "TrackingAnnotationList", "Pose")
DRAWN += ("PoseList", "Category", "Heatmap", "Odometry", "TextRegion", "TextRegionList")


@pytest.mark.parametrize("target", every_target(), ids=lambda target: type(target).__name__)
def test_what_can_be_drawn_is_drawn_and_the_rest_is_refused(target):
    image = Image(np.full((96, 128, 3), 40, np.uint8))
    # Drawing leaves the image unchanged where there is nothing to draw; a keypoint alone cannot be passed to it.
    if isinstance(target, Keypoint) or same(draw_target(image, target._as_value()), image):
        assert type(target).__name__ not in DRAWN or target == Heatmap(np.array([0.5, 0.25], np.float32))
        with pytest.raises(opendr.Unsupported, match="has no place in an image; .*save"):
            target.plot(image)
        with pytest.raises(opendr.Unsupported, match="has no place"):
            target.show(image)
        assert predicted(image, copy.deepcopy(target))._repr_png_() is None
        return
    assert type(target).__name__ in DRAWN
    drawn = target.plot(image)
    assert same(drawn, draw_target(image, target._as_value()))
    assert (image.data == 40).all()
    with pytest.raises(opendr.InvalidInput, match=r"not known; give it: plot\(image\)"):
        target.plot()
    assert target._repr_png_() is None
    assert predicted(image, copy.deepcopy(target))._repr_png_().startswith(PNG)


def test_maps_without_a_drawing():
    for shape, kind in [((3, 4, 5), np.uint32), ((2, 3, 4, 5), np.float32), ((0, 4), np.float32), ((7,), np.float32)]:
        with pytest.raises(opendr.Unsupported, match=r"a Heatmap of shape \("):
            Heatmap(np.zeros(shape, kind)).plot(black())
    assert Heatmap(np.ones((3, 4, 5), np.float32)).plot(black()).data.any()


def test_images_of_every_kind(tmp_path):
    frame = black()
    frame[:, :, 0] = 200
    Image(frame).save(tmp_path / "frame.png")
    wanted = draw_bounding_boxes(Image(frame), boxes())
    for image in (Image(frame), frame, tmp_path / "frame.png", str(tmp_path / "frame.png")):
        drawn = boxes().plot(image)
        assert isinstance(drawn, Image)
        assert same(drawn, wanted)
    assert (frame == [200, 0, 0]).all()
    for other in (black(1), black(4), Image(np.zeros((1, 96, 128), np.uint16), dtype="uint16")):
        assert boxes().plot(other).data.shape == (3, 96, 128)
    for wrong in (5, b"abc", np.zeros((9, 9))):
        with pytest.raises((TypeError, ValueError)):
            boxes().plot(wrong)
    with pytest.raises(FileNotFoundError):
        boxes().plot("no/such/image.png")


def test_class_names():
    named = boxes().plot(black(), ["pedestrian"])
    assert same(named, boxes().plot(black(), {0: "pedestrian"}))
    assert not same(named, boxes().plot(black()))
    assert same(Category(1, confidence=0.5).plot(black(), ["a", "b"]), Category(1, "b", 0.5).plot(black()))
    assert same(Category(1, "b", 0.5).plot(black(), ["a"]), Category(1, "b", 0.5).plot(black()))
    with pytest.raises(TypeError, match="class_names"):
        boxes().plot(black(), "person")


def test_the_image_is_not_kept_in_memory():
    image = Image(black())
    target = predicted(image)
    assert same(target.plot(), boxes().plot(image))
    image.data = np.full((3, 96, 128), 7, np.uint8)
    assert same(target.plot(), boxes().plot(image))
    gone = weakref.ref(image)
    del image
    gc.collect()
    assert gone() is None
    with pytest.raises(opendr.InvalidInput, match=r"no longer in memory; keep it in a variable, or give it: plot\(image\)"):
        target.plot()
    assert target._repr_png_() is None
    assert target._repr_html_().startswith("<table>")
    assert target.plot(black()).data.any()


def test_arrays_are_referenced_and_lists_cannot_be():
    frame = black()
    target = predicted(frame)
    frame[0, 0] = 255
    assert target.plot().data[:, 0, 0].tolist() == [255, 255, 255]
    del frame
    with pytest.raises(opendr.InvalidInput, match="no longer in memory"):
        target.plot()
    assert ImageReference.to(black().tolist()) is None


@pytest.mark.parametrize("given", ["path", "str", "opened"])
def test_files_are_read_again_while_they_are_unchanged(given, tmp_path, monkeypatch):
    path = tmp_path / "frame.png"
    Image(black()).save(path)
    monkeypatch.chdir(tmp_path)
    target = predicted({"path": path, "str": "frame.png", "opened": Image.open("frame.png")}[given])
    gc.collect()
    monkeypatch.chdir(tmp_path.parent)
    assert same(target.plot(), boxes().plot(black()))
    assert target._repr_png_().startswith(PNG)
    Image(np.full((96, 128, 3), 255, np.uint8)).save(path)
    os.utime(path, ns=(1, 1))
    for problem in (lambda: None, path.unlink):
        problem()
        with pytest.raises(opendr.InvalidInput, match="frame.png, has changed or is gone"):
            target.plot()
        assert target._repr_png_() is None


def test_new_data_of_an_image_are_not_those_of_its_file(tmp_path):
    Image(black()).save(tmp_path / "frame.png")
    image = Image.open(tmp_path / "frame.png")
    image.data = np.full((3, 96, 128), 255, np.uint8)
    target = predicted(image)
    assert target.plot().data[:, 0, 0].tolist() == [255] * 3
    del image
    with pytest.raises(opendr.InvalidInput, match="no longer in memory"):
        target.plot()


def test_copies_and_comparisons_ignore_the_image(tmp_path):
    image = Image(black())
    target = predicted(image)
    assert target == boxes()
    assert repr(target) == repr(boxes())
    for other in (copy.copy(target), copy.deepcopy(target), pickle.loads(pickle.dumps(target))):
        assert other == target
        assert other._image is None
    assert target.plot().data.any()
    image.save(tmp_path / "frame.png")
    assert pickle.loads(pickle.dumps(Image.open(tmp_path / "frame.png")))._file is None


def test_converted_targets_keep_the_image():
    image = Image(black())
    tracks = TrackingAnnotation(0, 10, 20, 30, 40, 7, 0.9)._as_value()
    predicted(image, tracks)
    assert same(tracks.bounding_box_list().plot(), tracks.bounding_box_list().plot(image))


def test_saving(tmp_path):
    image = Image(np.full((96, 128, 3), 90, np.uint8))
    target = predicted(image)
    for extension in _IMAGES:
        target.save(tmp_path / f"drawing{extension}")
        drawn = Image.open(tmp_path / f"drawing{extension}")
        difference = np.abs(drawn.data.astype(int) - target.plot().data.astype(int))
        assert difference.mean() < 4 if extension in (".jpg", ".jpeg") else difference.max() == 0
    target.save(str(tmp_path / "DRAWING.PNG"))
    target.save(tmp_path / "boxes.json")
    text = (tmp_path / "boxes.json").read_text("utf-8")
    assert text == target.to_json()
    assert BoundingBoxList.from_json(text).to_json() == text
    target.save(tmp_path / "boxes.csv")
    rows = "name,class_name,left,top,width,height,confidence\n0,person,10.0,20.0,30.0,40.0,0.9\n"
    assert (tmp_path / "boxes.csv").read_bytes() == rows.encode()


def test_saving_what_cannot_be_saved(tmp_path):
    every = ".png, .jpg, .jpeg, .bmp, .webp, .json, .csv"
    for name in ("boxes.gif", "boxes", "boxes.csv.gz"):
        with pytest.raises(opendr.Unsupported, match=f"a BoundingBoxList is saved as {every}"):
            boxes().save(tmp_path / name)
    with pytest.raises(opendr.Unsupported, match="a WhisperTranscription is saved as .json, .csv$"):
        WhisperTranscription("left").save(tmp_path / "words.png")
    with pytest.raises(opendr.Unsupported, match=r"a Heatmap of shape \(2, 3, 4, 5\) is saved as .json$"):
        Heatmap(np.zeros((2, 3, 4, 5), np.float32)).save(tmp_path / "map.csv")
    with pytest.raises(opendr.InvalidInput, match="not known"):
        boxes().save(tmp_path / "boxes.png")
    with pytest.raises(OSError):
        boxes().save(tmp_path / "no" / "folder.json")
    assert list(tmp_path.iterdir()) == []


def test_texts_keep_their_letters(tmp_path):
    corners = [[1, 2], [11, 2], [11, 8], [1, 8]]
    target = TextRegionList([TextRegion('Größe, "5"\n字', corners, 0.5)])
    target.save(tmp_path / "texts.csv")
    assert '"Größe, ""5""\n字",0.5,1.0,2.0,' in (tmp_path / "texts.csv").read_text("utf-8")
    target.save(tmp_path / "texts.json")
    assert json.loads((tmp_path / "texts.json").read_bytes())["regions"][0]["text"] == 'Größe, "5"\n字'


def test_showing(monkeypatch, tmp_path, capsys):
    monkeypatch.setattr(_show, "window_works", lambda: False)
    monkeypatch.chdir(tmp_path)
    image = Image(black())
    predicted(image).show()
    assert capsys.readouterr().out == f"image written to {tmp_path / 'opendr.png'}\n"
    assert same(Image.open(tmp_path / "opendr.png"), boxes().plot(image))
    boxes().show(image, ["dog"])
    assert same(Image.open(tmp_path / "opendr-1.png"), boxes().plot(image, ["dog"]))


def test_showing_in_a_notebook(monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)
    displayed = []

    class Module:
        get_ipython = staticmethod(lambda: type("Shell", (), {"kernel": None})())
        display = staticmethod(displayed.append)

    monkeypatch.setitem(sys.modules, "IPython", Module())
    monkeypatch.setitem(sys.modules, "IPython.display", Module())
    boxes().show(black())
    assert len(displayed) == 1
    assert same(displayed[0], boxes().plot(black()))
    # The terminal of IPython has no kernel.
    Module.get_ipython = staticmethod(lambda: object())
    monkeypatch.setattr(_show, "window_works", lambda: False)
    boxes().show(black())
    assert len(displayed) == 1
    assert (tmp_path / "opendr.png").exists()


def test_images_in_notebooks(tmp_path):
    def shown(image):
        (tmp_path / "shown.png").write_bytes(image._repr_png_())
        return Image.open(tmp_path / "shown.png").data

    colours = np.random.default_rng(0).integers(0, 256, (9, 8, 3), np.uint8)
    assert np.array_equal(shown(Image(colours)), Image(colours).data)
    depth = Image(np.array([[[500, 1500], [2500, 500]]], np.uint16), dtype="uint16")
    assert shown(depth)[0].tolist() == [[0, 128], [255, 0]]
    floats = Image(np.array([[[-1.0, np.nan], [1.0, np.inf]]], np.float32), dtype="float32")
    assert shown(floats)[0].tolist() == [[0, 0], [255, 0]]
    assert shown(Image(np.full((1, 2, 2), np.nan, np.float32), dtype="float32")).max() == 0


def test_tables_in_notebooks():
    text = boxes()._repr_html_()
    assert text.startswith("<table><caption>BoundingBoxList: 1 row</caption>")
    assert "<th>class_name</th>" in text and "<td>person</td><td>10</td>" in text
    without_image = predicted(Image(black()))
    assert without_image._repr_html_() == text
    image = Image(black())
    assert predicted(image)._repr_html_() is None
    hostile = BoundingBoxList([BoundingBox("<script>alert(1)</script>", 1, 2, 3, 4)])
    assert "<script>" not in hostile._repr_html_()
    many = BoundingBoxList([BoundingBox(0, 1, 2, 3, 4)] * 1000)._repr_html_()
    assert "1000 rows, of which the first 40" in many
    assert many.count("<tr>") == 41
    assert Heatmap(np.zeros((2, 3, 4), np.float32))._repr_html_() is None
    broken = boxes()
    broken.data.append("no box")
    assert broken._repr_html_() is None
    assert predicted(image, broken)._repr_png_() is None


def test_predictions_show_themselves(faces, photo, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    image = Image.open(photo)
    wanted = faces.infer(image).plot(image)
    assert not same(wanted, image)
    assert same(faces.infer(image).plot(), wanted)
    assert same(faces.infer(str(photo)).plot(), wanted)
    assert same(faces.infer(Image.open(photo)).plot(), wanted)
    assert same(faces.stream().infer(image).plot(), wanted)
    frame = image.opencv()
    assert same(faces.infer(frame).plot(), wanted)
    assert [same(found.plot(), wanted) for found in faces.infer([photo, image])] == [True, True]
    # A frame exists until the next prediction.
    for found in faces.infer(opendr.Source(photo, photo)):
        assert same(found.plot(), wanted)
    with pytest.raises(opendr.InvalidInput, match="no longer in memory"):
        found.plot()
    faces.infer(image).save("faces.png")
    assert same(Image.open("faces.png"), wanted)


def test_predictions_from_predictions_refer_to_the_same_image(nanodet, photo):
    tracker = opendr.learner("sort", verbose=False)
    found = nanodet.infer(str(photo))
    tracks = tracker.infer(found)
    assert tracks._image is found._image
    assert same(tracks.plot(), tracks.plot(photo))


def test_infer_keeps_no_image(faces, photo):
    images = [Image.open(photo) for _ in range(3)]
    references = [weakref.ref(image) for image in images]
    predictions = faces.infer(images)
    del images
    gc.collect()
    assert [reference() for reference in references] == [None] * 3
    assert all(same(found.plot(), predictions[0].plot(photo)) for found in predictions)


def test_pose_alone(tmp_path):
    pose = Pose([[10 + 5 * index, 20 + 3 * index] for index in range(18)], 0.9)
    assert same(pose.plot(black()), pose._as_value().plot(black()))
    pose.save(tmp_path / "pose.csv")
    assert (tmp_path / "pose.csv").read_text("utf-8").splitlines()[2] == "0,,neck,15.0,23.0,0.0,0.9"
