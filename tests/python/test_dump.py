"""`opendr infer --dump`: the tensors of each stage, compared with ONNX Runtime on the same model."""

import json

import numpy as np
import onnxruntime
import pytest


@pytest.fixture
def photo(shared):
    return shared / "data/photos/zidane.jpg"


def test_dump_has_the_tensors_of_each_stage(opendr, shared, photo, tmp_path):
    folder = tmp_path / "tensors"
    [line] = opendr.infer("yunet/640", photo, "--dump", folder)
    index = json.loads((folder / "dump.json").read_text())
    [item] = index["items"]
    assert index["format_version"] == 1 and item["runs"] == 1 and item["input"] == str(photo)
    by_stage = {}
    for entry in item["files"]:
        by_stage.setdefault(entry["stage"], []).append(entry)
    assert list(by_stage) == ["input", "network input", "network output", "prediction"]
    for entry in item["files"]:
        if "statistics" in entry:
            array = np.load(folder / item["folder"] / entry["file"], allow_pickle=False)
            statistics = entry["statistics"]
            assert list(array.shape) == entry["shape"] and statistics["not_finite"] == 0
            assert statistics["min"] == pytest.approx(float(array.min()))
            assert statistics["max"] == pytest.approx(float(array.max()))
            assert statistics["mean"] == pytest.approx(float(array.mean(dtype=np.float64)), rel=1e-6, abs=1e-6)
    load = lambda entry: np.load(folder / item["folder"] / entry["file"], allow_pickle=False)
    assert load(by_stage["input"][0]).shape == (720, 1280, 3)
    # The dumped input of the network gives the dumped outputs in ONNX Runtime, too.
    session = onnxruntime.InferenceSession(shared / "models/face_detection/yunet_n_640_640.onnx")
    inputs = {entry["name"]: load(entry) for entry in by_stage["network input"]}
    expected = dict(zip([output.name for output in session.get_outputs()], session.run(None, inputs)))
    assert len(by_stage["network output"]) == len(expected)
    for entry in by_stage["network output"]:
        np.testing.assert_allclose(load(entry), expected[entry["name"]], rtol=1e-3, atol=1e-4)
    [predictions] = json.loads((folder / item["folder"] / "prediction.json").read_text())
    boxes, printed = predictions["boxes"]["boxes"], line["outputs"]["boxes"]["boxes"]
    assert len(boxes) == len(printed) > 0
    # Lines are rounded to the digits that are read.
    for box, other in zip(boxes, printed):
        for key in ("left", "top", "width", "height", "confidence"):
            assert box[key] == pytest.approx(other[key], rel=1e-4)


def test_dump_of_wrong_use(opendr, shared, photo, tmp_path):
    (tmp_path / "broken.jpg").write_bytes(b"no image")
    done = opendr.run("infer", "yunet/640", tmp_path / "broken.jpg", photo, "--dump", tmp_path / "some")
    assert done.returncode == 1
    assert len(json.loads((tmp_path / "some/dump.json").read_text())["items"]) == 1
    done = opendr.run("infer", "yunet/640", photo, "--dump", tmp_path / "some")
    assert done.returncode == 11 and "new folder" in done.stderr
    done = opendr.run("infer", "yunet/640", photo, "--dump", tmp_path / "other", "--then", "sort")
    assert done.returncode == 12 and "--then" in done.stderr
    assert not (tmp_path / "other").exists()
