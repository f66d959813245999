"""Rendered data sets: files, labels, repeatability, refusals."""

import json
from pathlib import Path

import numpy as np
import pytest

import opendr.simulation
from opendr.engine.datasets import ExternalDataset


def annotations(folder: Path):
    (file,) = folder.glob("annotations/*.json")
    return json.loads(file.read_text())


def test_persons_are_written_as_coco(tmp_path):
    sheet = opendr.simulation.render("persons", tmp_path / "set", frames=6, size=(160, 120), seed=3)
    assert sheet is not None and sheet.is_file()
    found = annotations(tmp_path / "set")
    assert len(found["images"]) == 6
    assert [category["name"] for category in found["categories"]] == ["person"]
    assert found["annotations"]
    for annotation in found["annotations"]:
        left, top, width, height = annotation["bbox"]
        assert 0 <= left and left + width <= 160 and 0 <= top and top + height <= 120
        assert 0 < annotation["area"] <= width * height
        assert annotation["segmentation"]["size"] == [120, 160]


def test_a_seed_gives_the_same_images(tmp_path):
    for name, seed in [("first", 5), ("again", 5), ("other", 6)]:
        opendr.simulation.render("person_keypoints", tmp_path / name, frames=2, size=(64, 48), seed=seed)
    images = {name: sorted((tmp_path / name / "train").glob("*.png")) for name in ("first", "again", "other")}
    assert len(images["first"]) == 2
    content = {name: [image.read_bytes() for image in files] for name, files in images.items()}
    assert content["first"] == content["again"] != content["other"]
    for annotation in annotations(tmp_path / "first")["annotations"]:
        assert len(annotation["keypoints"]) == 51


def test_geometry_is_written_beside_the_images(tmp_path):
    opendr.simulation.render("persons", tmp_path, frames=3, size=(64, 48), geometry=True)
    cameras = sorted((tmp_path / "cameras").glob("*.json"))
    assert len(cameras) == 3
    camera = json.loads(cameras[0].read_text())
    axes = np.array(camera["axes"])
    assert np.allclose(axes @ axes.T, np.eye(3), atol=1e-5)
    assert len(list((tmp_path / "depth").glob("*.png"))) == len(list((tmp_path / "normals").glob("*.png"))) == 3


@pytest.mark.parametrize("world,kind,folder", [("faces", "imagenet", "train"), ("street", "kitti", "training/velodyne")])
def test_other_worlds(tmp_path, world, kind, folder):
    opendr.simulation.render(world, tmp_path, frames=2, size=(48, 48))
    assert any((tmp_path / folder).iterdir())
    assert ExternalDataset(str(tmp_path), kind)


def test_refusals(tmp_path):
    with pytest.raises(ValueError, match="persons, person_keypoints"):
        opendr.simulation.render("moon", tmp_path)
    with pytest.raises(ValueError, match="no depth and normals"):
        opendr.simulation.render("street", tmp_path, geometry=True)
    with pytest.raises(ValueError, match="at least 1"):
        opendr.simulation.render("persons", tmp_path, frames=0)
    with pytest.raises(ValueError, match="8x8"):
        opendr.simulation.render("persons", tmp_path, frames=1, size=(8, 8))
