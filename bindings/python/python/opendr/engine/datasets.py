"""What learners train on and are measured by."""

from __future__ import annotations

import os
from abc import ABC, abstractmethod
from collections.abc import Iterator
from typing import Any, Callable, Union

from opendr.engine._checks import whole
from opendr.engine.data import Data, PointCloud
from opendr.engine.target import BaseTarget


class Dataset(ABC):
    """Any data set."""


class DatasetIterator(Dataset):
    """A data set whose samples can be had one by one: ``dataset[3]``, ``len(dataset)``, ``for sample in dataset``."""

    @abstractmethod
    def __getitem__(self, idx: int) -> Any:
        """Sample number ``idx``: a datum and its target.

        Raises:
            IndexError: There is none.
        """

    @abstractmethod
    def __len__(self) -> int:
        """How many samples there are."""

    def __iter__(self) -> Iterator[Any]:
        return (self[idx] for idx in range(len(self)))


class MappedDatasetIterator(DatasetIterator):
    """A data set whose samples pass through a function when they are read.

    Args:
        original: The data set.
        map_function: From a sample to a sample.

    Raises:
        TypeError: ``map_function`` cannot be called.
    """

    def __init__(self, original: DatasetIterator, map_function: Callable[[Any], tuple[Data, BaseTarget]]) -> None:
        if not callable(map_function):
            raise TypeError(f"map_function should be a function of a sample, not {map_function!r}")
        self.original = original
        self.map_function = map_function

    def __getitem__(self, idx: int) -> Any:
        return self.map_function(self.original[idx])

    def __len__(self) -> int:
        return len(self.original)


class ExternalDataset(Dataset):
    """A data set on disk in a known format.

    Args:
        path: Its folder or file.
        dataset_type: Its format: ``"coco"``, ``"voc"``, ``"imagenet"``, ``"kitti"``, ``"mot"``, ...; upper and lower
            case are the same.

    Raises:
        ValueError: One of them is no text.
    """

    def __init__(self, path: Union[str, os.PathLike[str]], dataset_type: str) -> None:
        self.path = path
        self.dataset_type = dataset_type

    @property
    def path(self) -> str:
        """Its folder or file."""
        return self._path

    @path.setter
    def path(self, path: Union[str, os.PathLike[str]]) -> None:
        if not isinstance(path, (str, os.PathLike)) or not isinstance(os.fspath(path), str):
            raise ValueError(f"path should be a str, not {path!r}")
        self._path: str = os.fspath(path)

    @property
    def dataset_type(self) -> str:
        """Its format."""
        return self._dataset_type

    @dataset_type.setter
    def dataset_type(self, dataset_type: str) -> None:
        if not isinstance(dataset_type, str):
            raise ValueError(f"dataset_type should be a str, e.g. 'coco', not {dataset_type!r}")
        self._dataset_type = dataset_type

    def __repr__(self) -> str:
        return f"ExternalDataset({self.path!r}, {self.dataset_type!r})"


class PointCloudsDatasetIterator(DatasetIterator):
    """The point clouds of a folder, in the order of their names, without targets.

    Each file holds little-endian float32 numbers, point by point, as KITTI's ``.bin`` files.

    Args:
        path: The folder.
        num_point_features: Numbers a point: x, y, z in metres, then whatever else.

    Raises:
        FileNotFoundError: There is no such folder.
        ValueError: A point has fewer than 3 numbers.
    """

    def __init__(self, path: Union[str, os.PathLike[str]], num_point_features: int = 4) -> None:
        self.path: str = os.fspath(path)
        self.num_point_features: int = whole(num_point_features, "num_point_features")
        if self.num_point_features < 3:
            raise ValueError(f"num_point_features is {num_point_features}; give 3 (x, y, z) or more")
        with os.scandir(self.path) as entries:
            self.files: list[str] = sorted(entry.name for entry in entries if entry.is_file())

    def __getitem__(self, idx: int) -> PointCloud:
        """Cloud number ``idx``.

        Raises:
            IndexError: There is none.
            ValueError: The file ends within a point.
        """
        import numpy as np

        path = os.path.join(self.path, self.files[idx])
        numbers = np.fromfile(path, dtype="<f4")
        if numbers.size % self.num_point_features or os.path.getsize(path) % 4:
            raise ValueError(
                f"{path} has {os.path.getsize(path)} bytes, not a multiple of {self.num_point_features} float32 "
                "numbers; give the right num_point_features"
            )
        return PointCloud(numbers.reshape(-1, self.num_point_features))

    def __len__(self) -> int:
        return len(self.files)
