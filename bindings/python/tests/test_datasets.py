"""Data sets."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from opendr.engine.data import Image, PointCloud, Vector
from opendr.engine.datasets import (
    Dataset,
    DatasetIterator,
    ExternalDataset,
    MappedDatasetIterator,
    PointCloudsDatasetIterator,
    Subset,
    shuffled,
    split,
)
from opendr.engine.target import Category


class Numbers(DatasetIterator):
    def __getitem__(self, idx):
        if not 0 <= idx < 3:
            raise IndexError(idx)
        return Vector([idx]), Category(idx)

    def __len__(self):
        return 3


def test_parts_follow_from_the_seed():
    train, val = split(Numbers(), 0.67, 3)
    assert sorted(train.indices + val.indices) == [0, 1, 2]
    assert (len(train), len(val)) == (2, 1)
    assert split(Numbers(), 0.67, 3)[0].indices == train.indices
    assert len({tuple(shuffled(Numbers(), seed).indices) for seed in range(20)}) > 3
    assert Subset(Numbers(), [2, 0])[0][1].data == 2
    for wrong in (lambda: split(Numbers(), 1.5, 0), lambda: Subset(Numbers(), [3])):
        with pytest.raises((ValueError, IndexError)):
            wrong()


def test_open_reads_samples_and_lists_what_is_broken(tmp_path):
    import json

    Image(np.zeros((3, 20, 30), np.uint8)).save(tmp_path / "a.png")
    box = {"id": 1, "image_id": 7, "category_id": 18, "bbox": [1, 2, 10, 5], "area": 50, "iscrowd": 0}
    files = {
        "images": [{"id": 7, "file_name": "a.png", "width": 30, "height": 20}],
        "categories": [{"id": 18, "name": "dog"}],
        "annotations": [box, {**box, "id": 2, "bbox": [1, 2, 3]}],
    }
    (tmp_path / "instances_val.json").write_text(json.dumps(files))
    dataset = ExternalDataset(tmp_path, "auto").open(skip_broken=True)
    image, target = dataset[0]
    assert (image.data.shape, len(dataset), dataset.classes, dataset.name(0)) == ((3, 20, 30), 1, ["dog"], "a.png")
    assert [(box.name, box.width, box.class_name) for box in target] == [(0, 10.0, "dog")]
    assert dataset.target(-1) == target and dataset.sequence(0) is None
    assert len(dataset.problems) == 1 and "bbox" in dataset.problems[0], dataset.problems
    with pytest.raises(ValueError, match="bbox"):
        ExternalDataset(tmp_path, "coco").open()[0]
    with pytest.raises(IndexError):
        dataset[1]


def test_mapped():
    read = []

    def twice(sample):
        read.append(sample)
        return sample[0], Category(sample[1].data * 2)

    mapped = MappedDatasetIterator(Numbers(), twice)
    assert (len(mapped), read) == (3, [])
    assert mapped[2][1].data == 4
    assert len(read) == 1
    assert [target.data for _, target in mapped] == [0, 2, 4]
    assert isinstance(mapped, Dataset)
    with pytest.raises(IndexError):
        mapped[3]
    with pytest.raises(TypeError, match="map_function"):
        MappedDatasetIterator(Numbers(), None)


def test_iterator_is_abstract():
    with pytest.raises(TypeError, match="abstract"):
        DatasetIterator()


def test_external():
    dataset = ExternalDataset(Path("data") / "coco", "COCO")
    assert (dataset.path, dataset.dataset_type) == (str(Path("data") / "coco"), "COCO")
    assert repr(ExternalDataset("a", "voc")) == "ExternalDataset('a', 'voc')"
    dataset.path = "other"
    assert dataset.path == "other"
    for arguments in [(3, "coco"), (None, "coco"), (b"data", "coco"), ("data", None), ("data", 3)]:
        with pytest.raises(ValueError, match="should be a str"):
            ExternalDataset(*arguments)


def test_point_clouds(tmp_path):
    clouds = [np.arange(8, dtype="<f4").reshape(2, 4), np.ones((3, 4), "<f4"), np.zeros((0, 4), "<f4")]
    for name, cloud in zip(["b.bin", "a.bin", "c.bin"], clouds):
        cloud.tofile(tmp_path / name)
    (tmp_path / "folder").mkdir()
    dataset = PointCloudsDatasetIterator(tmp_path)
    assert len(dataset) == 3
    assert dataset[1] == PointCloud(clouds[0])
    assert [len(cloud) for cloud in dataset] == [3, 2, 0]
    with pytest.raises(IndexError):
        dataset[3]


def test_wrong_point_clouds(tmp_path):
    (tmp_path / "cut.bin").write_bytes(b"\0" * 21)
    with pytest.raises(ValueError, match=r"cut\.bin has 21 bytes"):
        PointCloudsDatasetIterator(tmp_path)[0]
    with pytest.raises(ValueError, match="num_point_features is 2"):
        PointCloudsDatasetIterator(tmp_path, 2)
    with pytest.raises(FileNotFoundError):
        PointCloudsDatasetIterator(tmp_path / "missing")
