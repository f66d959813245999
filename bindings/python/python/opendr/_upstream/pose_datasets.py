"""OpenDR's data sets of poses and falls."""

from __future__ import annotations

import csv
import os
import warnings
from collections.abc import Sequence
from typing import Any, Union

from opendr._errors import FormatError
from opendr._upstream.parts import inside
from opendr.engine.data import Image
from opendr.engine.datasets import DatasetIterator, ExternalDataset
from opendr.engine.target import Category, PoseList

PathLike = Union[str, "os.PathLike[str]"]


class CocoValDataset(DatasetIterator):
    """COCO's images and poses.

    Args:
        labels: ``ROOT/annotations/person_keypoints_PART.json``.
        images_folder: ``ROOT/PART``.

    Raises:
        FileNotFoundError: The data set does not exist.
        ValueError: The folders of annotations and images are not those of COCO.
    """

    def __init__(self, labels: PathLike, images_folder: PathLike) -> None:
        folder = os.path.abspath(os.fspath(images_folder))
        root, part = os.path.split(folder)
        expected = os.path.join(root, "annotations", f"person_keypoints_{part}.json")
        if os.path.abspath(os.fspath(labels)) != expected:
            raise ValueError(f"{os.fspath(labels)} is not in COCO's folder; give {expected}")
        self._samples = ExternalDataset(root, "coco").open(split=part, target=PoseList)

    def __getitem__(self, idx: int) -> tuple[Image, PoseList]:
        image, poses = self._samples[idx]
        return image, poses

    def __len__(self) -> int:
        return len(self._samples)


class CocoTrainDataset(CocoValDataset):
    """The same as :class:`CocoValDataset`: the training computes the maps of joints itself.

    Args:
        labels: ``ROOT/annotations/person_keypoints_PART.json``.
        images_folder: ``ROOT/PART``.
        options: OpenDR's further arguments, which have no effect.
    """

    def __init__(self, labels: PathLike, images_folder: PathLike, *given: Any, **options: Any) -> None:
        if given or options:
            names = ", ".join(options) or "the further arguments"
            text = f"CocoTrainDataset: {names} has no effect: the training computes the maps of joints itself"
            warnings.warn(text, UserWarning, stacklevel=2)
        super().__init__(labels, images_folder)


class URFallDatasetIterator(DatasetIterator):
    """Images of persons, with categories fallen and standing.

    Args:
        data: Images, or their files.
        labels: Categories: 1 fallen, -1 standing, 0 in between.

    Raises:
        ValueError: The lengths differ.
    """

    def __init__(self, data: Sequence[Any], labels: Sequence[Category]) -> None:
        if len(data) != len(labels):
            raise ValueError(f"{len(data)} images have {len(labels)} labels; give the same number of both")
        self.data, self.labels = list(data), list(labels)

    def __getitem__(self, idx: int) -> tuple[Any, Category]:
        return self.data[idx], self.labels[idx]

    def __len__(self) -> int:
        return len(self.labels)


def falls_of(dataset: ExternalDataset) -> URFallDatasetIterator:
    """Opens UR Fall (``ur_fall_dataset``), or a folder with ``annotations.csv`` (``test``).

    Raises:
        FileNotFoundError: A table does not exist.
        ValueError: The type is another, or a row is broken.
    """
    kind, files, labels = dataset.dataset_type.lower(), list[str](), list[Category]()
    if kind == "ur_fall_dataset":
        for table in ("urfall-cam0-adls.csv", "urfall-cam0-falls.csv"):
            for path, row in _rows(dataset.path, table):
                folder = f"{row[0]}-cam0-rgb"
                files.append(inside(dataset.path, f"{folder}/{folder}-{_whole(row[1], path):03d}.png"))
                labels.append(Category(_whole(row[2], path)))
    elif kind == "test":
        for path, row in _rows(dataset.path, "annotations.csv"):
            files.append(inside(dataset.path, f"{row[1]}.png"))
            labels.append(Category(_whole(row[2], path)))
    else:
        raise ValueError(f"a data set of falls has the type 'ur_fall_dataset' or 'test', not {kind!r}")
    return URFallDatasetIterator(files, labels)


def _rows(folder: str, table: str) -> list[tuple[str, list[str]]]:
    path = os.path.join(folder, table)
    with open(path, newline="", encoding="utf-8") as file:
        rows = [row for row in csv.reader(file) if row]
    broken = next((row for row in rows if len(row) < 3), None)
    if broken is not None:
        raise FormatError(f"{path}: a row has three cells, not {broken!r:.200}")
    return [(path, row) for row in rows]


def _whole(text: str, path: str) -> int:
    try:
        return int(text)
    except ValueError:
        raise FormatError(f"{path}: {text!r:.100} is not an integer") from None
