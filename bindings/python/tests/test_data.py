"""Data classes: OpenDR's constructors, layouts, texts; wrong input."""

from __future__ import annotations

import copy
import pickle
import subprocess
import sys

import numpy as np
import opendr
import pytest
from opendr.engine.data import (
    Audio,
    Calibration,
    Data,
    Image,
    ImageWithDetections,
    Observation,
    PointCloud,
    PointCloudWithCalibration,
    SkeletonSequence,
    Timeseries,
    Vector,
    Video,
)
from opendr.engine.target import BoundingBox, BoundingBoxList

ARRAY_CLASSES = {
    Vector: (3,),
    Timeseries: (4, 3),
    Video: (3, 4, 5, 6),
    PointCloud: (5, 4),
    SkeletonSequence: (1, 3, 4, 5, 2),
}
KITTI = {"P2": np.ones((3, 4)), "R0_rect": np.eye(3), "Tr_velo_to_cam": np.eye(4)[:3], "P0": np.zeros((3, 4))}


def pixels(*shape, dtype=np.uint8):
    return np.arange(np.prod(shape), dtype=dtype).reshape(shape)


def every_datum():
    image = Image(pixels(2, 4, 3))
    boxes = BoundingBoxList([BoundingBox(1, 2, 3, 4, 5, 0.5)])
    return [
        *(kind(np.ones(shape)) for kind, shape in ARRAY_CLASSES.items()),
        *(kind() for kind in ARRAY_CLASSES),
        image,
        ImageWithDetections(image, boxes),
        PointCloudWithCalibration(np.ones((2, 4)), KITTI, (370, 1224)),
        Calibration.from_dict(KITTI),
        Audio(np.zeros((8, 2), np.float32), 16000),
        Observation([1, 2]),
        Observation({"lidar": np.ones((2, 2)), "goal": [0.5]}),
    ]


@pytest.mark.parametrize("datum", every_datum(), ids=lambda datum: type(datum).__name__)
def test_value_semantics(datum):
    datum.timestamp, datum.frame_id = 5, "camera"
    for other in (copy.deepcopy(datum), pickle.loads(pickle.dumps(datum))):
        assert other == datum
        assert (other.timestamp, other.frame_id) == (5, "camera")
        other.timestamp = 6
        assert other != datum
    assert datum != 3
    assert isinstance(datum, Data)
    assert repr(datum).startswith(f"{type(datum).__name__}(")
    with pytest.raises(TypeError, match="unhashable"):
        hash(datum)


@pytest.mark.parametrize(("kind", "shape"), ARRAY_CLASSES.items())
def test_arrays(kind, shape):
    array = np.random.default_rng(0).random(shape, dtype=np.float32)
    datum = kind(array)
    assert datum.data is array
    copied = datum.numpy()
    assert np.array_equal(copied, array)
    assert not np.shares_memory(copied, array)
    assert np.shares_memory(np.asarray(datum), array)
    if hasattr(np, "from_dlpack"):
        assert np.shares_memory(np.from_dlpack(datum), array)
    assert np.array(datum, dtype=np.float64).dtype == np.float64
    assert kind(array.astype(np.int32)).data.dtype == np.float32
    assert kind(array.tolist()) == datum
    assert kind(array + 1) != datum
    assert str(datum) == ("Points: " if kind is PointCloud else "") + str(array)
    empty = kind()
    empty.data = array
    assert empty == datum


@pytest.mark.parametrize(("kind", "shape"), ARRAY_CLASSES.items())
def test_wrong_arrays(kind, shape):
    with pytest.raises(ValueError, match=f"{'Point Cloud' if kind is PointCloud else kind.__name__} is empty"):
        kind().numpy()
    for wrong in (np.ones((1, *shape)), np.ones(()), np.ones((0,) * (len(shape) + 1))):
        with pytest.raises(ValueError):
            kind(wrong)
        with pytest.raises(ValueError):
            kind().data = wrong
    for wrong in ("text", [None], np.array([object()]), np.array(["a"]), np.ones(shape, complex)):
        with pytest.raises(TypeError, match="should be an array of numbers"):
            kind(wrong)
    with pytest.raises(TypeError):
        kind().data = None
    with pytest.raises((TypeError, ValueError)):
        kind([[1, 2], [3]])


def test_indexing():
    assert (len(Vector([1, 2])), Vector([1, 2])[1], list(Vector([1, 2]))) == (2, 2.0, [1.0, 2.0])
    assert (len(Timeseries(np.ones((4, 3)))), Timeseries(np.ones((4, 3)))[1].shape) == (4, (3,))
    assert len(PointCloud(np.zeros((0, 4)))) == 0
    with pytest.raises(ValueError, match="x, y and z"):
        PointCloud(np.ones((2, 2)))
    with pytest.raises(ValueError, match="at least one"):
        Vector([])


def test_image_layouts():
    bgr = pixels(2, 4, 3)
    image = Image(bgr)
    chw = bgr[:, :, ::-1].transpose(2, 0, 1)
    assert (image.channels, image.height, image.width, image.dtype) == (3, 2, 4, np.uint8)
    assert np.array_equal(image.data, chw)
    assert np.shares_memory(image.data, bgr)
    assert np.array_equal(image.numpy(), chw)
    assert not np.shares_memory(image.numpy(), bgr)
    assert np.array_equal(image.opencv(), bgr)
    assert image.opencv().flags.c_contiguous
    assert np.array_equal(image.convert(), chw)
    assert np.array_equal(image.convert("channels_first", "bgr"), bgr.transpose(2, 0, 1))
    assert np.array_equal(image.convert("channels_last"), bgr[:, :, ::-1])
    assert np.array_equal(image.convert("channels_last", "bgr"), bgr)
    if hasattr(np, "from_dlpack"):
        assert np.array_equal(np.from_dlpack(image), chw)
    assert str(image) == str(chw)
    for wrong in ({"format": "hwc"}, {"channel_order": "gbr"}):
        with pytest.raises(ValueError, match="should be"):
            image.convert(**wrong)


def test_image_guess_is_opendrs():
    assert Image(pixels(3, 8, 9)).data.shape == (3, 8, 9)
    assert np.array_equal(Image(pixels(8, 9, 1)).data, pixels(8, 9, 1).transpose(2, 0, 1))
    rgba = pixels(8, 9, 4)
    assert np.array_equal(Image(rgba).data, rgba.transpose(2, 0, 1))
    assert np.array_equal(Image(rgba).opencv(), rgba[:, :, [2, 1, 0, 3]])
    # An image three pixels wide is taken for OpenCV's layout.
    assert Image(pixels(3, 8, 3)).data.shape == (3, 3, 8)
    assert Image(pixels(3, 8, 3), guess_format=False).data.shape == (3, 8, 3)
    grey = Image(pixels(1, 8, 9))
    assert grey.opencv().shape == (8, 9, 1)


def test_image_types():
    depth = Image(pixels(1, 8, 9, dtype=np.uint16) * 500, dtype=np.uint16)
    assert (depth.dtype, depth.numpy().max()) == (np.uint16, 71 * 500)
    metres = np.linspace(0, 9, 72, dtype=np.float32).reshape(1, 8, 9)
    assert np.array_equal(Image(metres, dtype="float32").data, metres)
    assert Image(metres).dtype == np.uint8
    assert Image(pixels(1, 8, 9).astype(np.int64)).dtype == np.uint8
    for wrong in (np.full((1, 8, 9), 256), np.full((1, 8, 9), -1), np.full((1, 8, 9), np.nan)):
        with pytest.raises(ValueError, match="do not fit uint8"):
            Image(wrong)
    with pytest.raises(ValueError, match="an Image cannot have samples of float64"):
        Image(metres, dtype=np.float64)
    same = Image(depth)
    assert (same == depth, same.dtype) == (True, np.uint16)
    same.data = np.zeros((1, 2, 2), np.uint16)
    assert (same.dtype, depth.height) == (np.uint16, 8)


@pytest.mark.parametrize(
    ("data", "error", "message"),
    [
        (None, ValueError, "Image is of type None"),
        (np.zeros((8, 9), np.uint8), ValueError, "3-dimensional images are expected"),
        (np.zeros((1, 3, 8, 9), np.uint8), ValueError, "3-dimensional images are expected"),
        (np.zeros((2, 8, 9), np.uint8), ValueError, "1, 3 or 4 channels"),
        (np.zeros((3, 0, 9), np.uint8), ValueError, "at least one pixel"),
        (np.zeros((0, 0, 3), np.uint8), ValueError, "at least one pixel"),
        ("street.jpg", TypeError, "should be an array of numbers"),
        (np.full((3, 2, 2), None), TypeError, "should be an array of numbers"),
        (np.full((3, 2, 2), "a"), TypeError, "should be an array of numbers"),
        (np.zeros((3, 2, 2), complex), TypeError, "should be an array of numbers"),
    ],
)
def test_wrong_images(data, error, message):
    with pytest.raises(error, match=message):
        Image(data)


def test_image_files(tmp_path):
    image = Image(pixels(3, 8, 9), guess_format=False)
    path = tmp_path / "picture.png"
    image.save(path)
    opened = Image.open(path)
    assert opened == image
    assert (opened.width, opened.height, opened.dtype) == (9, 8, np.uint8)
    for other in (copy.deepcopy(opened), pickle.loads(pickle.dumps(opened))):
        assert other == image
    changed = opened.numpy()
    changed[:] = 0
    assert opened == image
    opened.data = changed
    assert (opened != image, opened.numpy().any()) == (True, False)
    with pytest.raises(FileNotFoundError, match="The image file does not exist."):
        Image.open(tmp_path / "missing.png")
    with pytest.raises(FileNotFoundError, match="The image file does not exist."):
        Image.open("picture\udcff.png")
    (tmp_path / "text.png").write_text("no picture")
    with pytest.raises(ValueError):
        Image.open(tmp_path / "text.png")
    with pytest.raises(opendr.Unsupported, match="end the file name with"):
        image.save(tmp_path / "picture.unknown")
    with pytest.raises(OSError):
        image.save(tmp_path / "no_folder" / "picture.png")


def test_pillow():
    pil = pytest.importorskip("PIL.Image")
    rgb = pixels(2, 4, 3)
    image = Image.from_pil(pil.fromarray(rgb))
    assert np.array_equal(image.data, rgb.transpose(2, 0, 1))
    assert np.array_equal(np.asarray(image.to_pil()), rgb)
    grey = Image.from_pil(pil.fromarray(rgb[:, :, 0]))
    assert (grey.channels, grey.to_pil().mode) == (1, "L")
    with pytest.raises(ValueError, match="uint8"):
        Image(np.ones((1, 2, 2)), dtype="float32").to_pil()


def test_image_with_detections():
    boxes = BoundingBoxList([BoundingBox(1, 2, 3, 4, 5, 0.5)])
    image = Image(pixels(8, 9, 3))
    image.timestamp = 7
    datum = ImageWithDetections(image, boxes)
    assert (datum.boundingBoxList is boxes, datum.boxes is boxes, datum.timestamp) == (True, True, 7)
    assert np.array_equal(datum.data, image.data)
    assert str(datum) == f"ImageWithDetections {image.data}{boxes}"
    assert ImageWithDetections(pixels(8, 9, 3), boxes).data.shape == (3, 8, 9)
    with pytest.raises(TypeError, match="boundingBoxList"):
        ImageWithDetections(image, [1])


def test_calibration():
    cloud = PointCloudWithCalibration(np.ones((2, 4)), KITTI, np.array([370, 1224]))
    assert (cloud.image_shape, sorted(cloud.calib)) == (
        (370, 1224),
        ["P0", "P2", "R0_rect", "Tr_velo_to_cam"],
    )
    assert np.array_equal(cloud.calibration.p2, np.ones((3, 4)))
    assert str(cloud) == f"Points: {np.ones((2, 4), np.float32)}\nCalib:{KITTI}"
    wide = Calibration(np.eye(4), np.eye(4), np.eye(4))
    assert [matrix.shape for matrix in wide.data.values()] == [(3, 4), (3, 3), (3, 4)]
    assert np.array_equal(wide.numpy(), np.eye(4)[:3])
    assert PointCloudWithCalibration(np.ones((2, 4)), wide).calibration == wide
    for p2 in (np.eye(3), np.ones((4, 4)), np.full((3, 4), np.nan), np.ones(12)):
        with pytest.raises(ValueError, match="P2"):
            Calibration(p2, np.eye(3), np.eye(4))
    with pytest.raises(ValueError, match="R0_rect, Tr_velo_to_cam is missing"):
        Calibration.from_dict({"P2": np.eye(4)})
    with pytest.raises(TypeError, match="calib"):
        PointCloudWithCalibration(np.ones((2, 4)), [1])


def test_audio():
    assert np.array_equal(Audio(np.array([-32768, 16384], np.int16), 8000).data, [[-1.0], [0.5]])
    assert np.array_equal(Audio(np.array([[0, 128]], np.uint8), 8000).data, [[-1.0, 0.0]])
    audio = Audio(np.array([[0.0, 1.0], [0.5, 0.5]]), np.int32(2))
    assert (audio.channels, audio.duration_s, len(audio)) == (2, 1.0, 2)
    assert np.array_equal(audio.mono(), [0.5, 0.5])
    with pytest.raises(TypeError, match="not PCM"):
        Audio([1, 2], 8000)
    with pytest.raises(ValueError, match="sample_rate is 0"):
        Audio([0.5], 0)
    with pytest.raises(TypeError, match="sample_rate"):
        Audio([0.5], 16e3)


def test_observation():
    row = Observation(np.ones((2, 3)))
    assert (row.numpy().shape, row.parts) == ((6,), {})
    parts = Observation({"lidar": [[1, 2], [3, 4]], "goal": [0.5]})
    assert np.array_equal(parts.numpy(), np.array([1, 2, 3, 4, 0.5], np.float32))
    assert parts.parts["lidar"].shape == (2, 2)
    assert str(parts) == str({"lidar": parts.parts["lidar"], "goal": parts.parts["goal"]})
    for empty in ([], {}):
        with pytest.raises(ValueError, match="Observation is empty"):
            Observation(empty)
    with pytest.raises(TypeError):
        Observation({3: [1.0]})


def test_import_is_light():
    code = (
        "import sys, opendr.engine.data, opendr.engine.target; "
        "print(sorted({'numpy', 'cv2', 'supervision', 'PIL'} & set(sys.modules)))"
    )
    seen = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert seen.stdout.strip() == "[]"


@pytest.mark.parametrize("shape", [(4, 6), (1, 4, 6), (4, 6, 1)])
@pytest.mark.parametrize("dtype", ["uint16", "float32"])
def test_plain_arrays_of_depth_keep_their_samples(shape, dtype):
    from opendr._input_value import input_value

    depth = np.arange(700, 724).reshape(shape).astype(dtype)
    image = input_value(depth, "depth", "Image")
    assert image.dtype == dtype and image.data.shape == (1, 4, 6)
    assert (image.data.ravel() == depth.ravel()).all()
    assert input_value(np.zeros((4, 6, 3), np.uint8), "image", "Image").dtype == "uint8"
