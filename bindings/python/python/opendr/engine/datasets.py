"""Data sets for training and evaluation."""

from __future__ import annotations

import os
from abc import ABC, abstractmethod
from collections.abc import Iterable, Iterator
from typing import Any, Callable, Optional, Union

from opendr.engine._checks import whole
from opendr.engine.data import Data, PointCloud
from opendr.engine.target import BaseTarget


class Dataset(ABC):
    """Base class of data sets."""


class DatasetIterator(Dataset):
    """A data set with random access: ``dataset[3]``, ``len(dataset)``, ``for sample in dataset``."""

    @abstractmethod
    def __getitem__(self, idx: int) -> Any:
        """Returns sample ``idx``: a datum and its target.

        Raises:
            IndexError: The index is out of range.
        """

    @abstractmethod
    def __len__(self) -> int:
        """Returns the number of samples."""

    def __iter__(self) -> Iterator[Any]:
        return (self[idx] for idx in range(len(self)))


class MappedDatasetIterator(DatasetIterator):
    """A data set with a function that is applied to every sample when it is read.

    Args:
        original: The data set.
        map_function: Function from a sample to a sample.

    Raises:
        TypeError: ``map_function`` is not callable.
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


class Subset(DatasetIterator):
    """Some samples of a data set, in a given order.

    Args:
        original: The data set.
        indices: Indices of the samples.

    Raises:
        IndexError: An index is out of range.
    """

    def __init__(self, original: DatasetIterator, indices: Iterable[int]) -> None:
        self.original = original
        self.indices: list[int] = [whole(index, "the index of a sample") for index in indices]
        for index in self.indices:
            if not 0 <= index < len(original):
                raise IndexError(f"sample index {index} is out of range; the data set has {len(original)} samples")

    def __getitem__(self, idx: int) -> Any:
        return self.original[self.indices[idx]]

    def __len__(self) -> int:
        return len(self.indices)

    @property
    def classes(self) -> list[str]:
        """Names of the class indices in the targets; empty where the data set has none."""
        return list(getattr(self.original, "classes", []))


def shuffled(dataset: DatasetIterator, seed: int) -> Subset:
    """Returns all samples in a random order determined by ``seed``."""
    from opendr import _opendr

    return Subset(dataset, _opendr.shuffled(len(dataset), seed))


def split(dataset: DatasetIterator, share: float, seed: int) -> tuple[Subset, Subset]:
    """Returns a random split determined by ``seed``, the same as in Rust: the first part has the fraction ``share`` of the
    samples, the second the rest. Frames of one sequence stay together.

    Raises:
        ValueError: ``share`` is not in [0, 1].
    """
    from opendr import _opendr

    sequence = getattr(dataset, "sequence", None)
    sequences = [None if sequence is None else sequence(idx) for idx in range(len(dataset))]
    first, second = _opendr.split(sequences, share, seed)
    return Subset(dataset, first), Subset(dataset, second)


class ExternalDataset(Dataset):
    """A data set on disk in a known format.

    Args:
        path: Folder or file of the data set.
        dataset_type: Format: ``"coco"``, ``"voc"``, ``"imagenet"``, ``"kitti"``, ``"mot"``, ... (``formats()`` lists
            them); case is ignored; ``"auto"`` detects the format.

    Raises:
        ValueError: An argument is not a str.
    """

    def __init__(self, path: Union[str, os.PathLike[str]], dataset_type: str) -> None:
        self.path = path
        self.dataset_type = dataset_type

    @property
    def path(self) -> str:
        """Folder or file of the data set."""
        return self._path

    @path.setter
    def path(self, path: Union[str, os.PathLike[str]]) -> None:
        if not isinstance(path, (str, os.PathLike)) or not isinstance(os.fspath(path), str):
            raise ValueError(f"path should be a str, not {path!r}")
        self._path: str = os.fspath(path)

    @property
    def dataset_type(self) -> str:
        """Format of the data set."""
        return self._dataset_type

    @dataset_type.setter
    def dataset_type(self, dataset_type: str) -> None:
        if not isinstance(dataset_type, str):
            raise ValueError(f"dataset_type should be a str, e.g. 'coco', not {dataset_type!r}")
        self._dataset_type = dataset_type

    def open(
        self, split: Optional[str] = None, target: Union[None, str, type[BaseTarget]] = None, skip_broken: bool = False
    ) -> OpenDataset:
        """Opens the data set for random access; images are read on access.

        Args:
            split: Name of the split in the data set: ``"val2017"``, ``"train"``, ...
            target: Target class, or its name, where annotations can be read as several types, e.g. ``PoseList`` of COCO.
            skip_broken: Whether broken samples are skipped and listed in ``problems``.

        Raises:
            FileNotFoundError: The data set does not exist, or files are missing.
            ValueError: The format is another, or a sample is broken.
        """
        return OpenDataset(self, split, target, skip_broken)

    def __repr__(self) -> str:
        return f"ExternalDataset({self.path!r}, {self.dataset_type!r})"


class OpenDataset(DatasetIterator):
    """The samples of an :class:`ExternalDataset`, returned by its method ``open``.

    ``dataset[3]`` is a pair of datum and target; a tuple of data and the target where samples have several data.
    """

    def __init__(
        self,
        dataset: ExternalDataset,
        split: Optional[str] = None,
        target: Union[None, str, type[BaseTarget]] = None,
        skip_broken: bool = False,
    ) -> None:
        from opendr._opendr import Dataset as Native

        kind = target.__name__ if isinstance(target, type) else target
        self._native = Native(dataset.path, dataset.dataset_type, split, kind, skip_broken)

    def __getitem__(self, idx: int) -> Any:
        data, target = self._native.get(self._index(idx))
        return data[0] if len(data) == 1 else tuple(data), target

    def __len__(self) -> int:
        return len(self._native)

    def target(self, idx: int) -> Optional[BaseTarget]:
        """Returns the target of sample ``idx``, without reading images where the format allows it."""
        target: Optional[BaseTarget] = self._native.target(self._index(idx))
        return target

    def name(self, idx: int) -> str:
        """Returns the name of sample ``idx`` in reports: the path of its file within the data set, or its index."""
        return self._native.name(self._index(idx))

    def sequence(self, idx: int) -> Optional[int]:
        """Returns the index of the sequence (video or drive) of the sample; None where there are no sequences."""
        return self._native.sequence(self._index(idx))

    @property
    def classes(self) -> list[str]:
        """Names of the class indices in the targets."""
        return self._native.classes

    @property
    def problems(self) -> list[str]:
        """Samples that were skipped as broken, each with its file and line or key."""
        return self._native.problems

    def _index(self, idx: int) -> int:
        index = whole(idx, "the index of a sample")
        index += len(self) if index < 0 else 0
        if not 0 <= index < len(self):
            raise IndexError(f"sample index {idx} is out of range; the data set has {len(self)} samples")
        return index


def formats() -> list[dict[str, Any]]:
    """Returns a table of each data set format: ``name``, ``aliases``, ``about``, ``layout``, ``targets``."""
    from opendr import _opendr

    return _opendr.formats()


class PointCloudsDatasetIterator(DatasetIterator):
    """The point clouds of a folder, in the order of their file names, without targets.

    Each file contains little-endian float32 numbers, point by point, as KITTI's ``.bin`` files.

    Args:
        path: The folder.
        num_point_features: Numbers per point: x, y, z in metres, then others.

    Raises:
        FileNotFoundError: The folder does not exist.
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
        """Returns cloud ``idx``.

        Raises:
            IndexError: The index is out of range.
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
