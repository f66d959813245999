"""Data sets."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from opendr.engine.data import PointCloud, Vector
from opendr.engine.datasets import (
    Dataset,
    DatasetIterator,
    ExternalDataset,
    MappedDatasetIterator,
    PointCloudsDatasetIterator,
)
from opendr.engine.target import Category


class Numbers(DatasetIterator):
    def __getitem__(self, idx):
        if not 0 <= idx < 3:
            raise IndexError(idx)
        return Vector([idx]), Category(idx)

    def __len__(self):
        return 3


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
