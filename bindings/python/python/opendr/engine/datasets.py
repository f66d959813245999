"""What learners train on and are measured by."""

from __future__ import annotations

import os
from abc import ABC, abstractmethod
from collections.abc import Iterable, Iterator
from typing import Any, Callable, Optional, Union

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


class Subset(DatasetIterator):
    """Some samples of a data set, in an order of their own.

    Args:
        original: The data set.
        indices: The numbers of the samples.

    Raises:
        IndexError: There is no such sample.
    """

    def __init__(self, original: DatasetIterator, indices: Iterable[int]) -> None:
        self.original = original
        self.indices: list[int] = [whole(index, "the number of a sample") for index in indices]
        for index in self.indices:
            if not 0 <= index < len(original):
                raise IndexError(f"there is no sample {index} among {len(original)}")

    def __getitem__(self, idx: int) -> Any:
        return self.original[self.indices[idx]]

    def __len__(self) -> int:
        return len(self.indices)

    @property
    def classes(self) -> list[str]:
        """What class numbers in the targets mean; empty where the data set does not tell."""
        return list(getattr(self.original, "classes", []))


def shuffled(dataset: DatasetIterator, seed: int) -> Subset:
    """All samples in a random order that follows from ``seed``."""
    from opendr import _opendr

    return Subset(dataset, _opendr.shuffled(len(dataset), seed))


def split(dataset: DatasetIterator, share: float, seed: int) -> tuple[Subset, Subset]:
    """Two parts without a sample in common, the first with ``share`` of the samples, drawn by ``seed``; the same parts as in
    Rust. Frames of one sequence stay together.

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
        path: Its folder or file.
        dataset_type: Its format: ``"coco"``, ``"voc"``, ``"imagenet"``, ``"kitti"``, ``"mot"``, ... (``formats()``
            lists them); upper and lower case are the same; ``"auto"`` recognises it.

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

    def open(
        self, split: Optional[str] = None, target: Union[None, str, type[BaseTarget]] = None, skip_broken: bool = False
    ) -> OpenDataset:
        """Opens it, to read its samples one by one; pictures are read when they are asked for.

        Args:
            split: The part, as the data set calls it: ``"val2017"``, ``"train"``, ...
            target: The class of the targets that are wanted, or its name, where annotations can be read as several, e.g.
                ``PoseList`` of COCO.
            skip_broken: Whether what is broken is left out, and listed in ``problems``.

        Raises:
            FileNotFoundError: It is not there, or files are missing.
            ValueError: It is of another format, or something is broken.
        """
        return OpenDataset(self, split, target, skip_broken)

    def __repr__(self) -> str:
        return f"ExternalDataset({self.path!r}, {self.dataset_type!r})"


class OpenDataset(DatasetIterator):
    """The samples of an :class:`ExternalDataset`; its method ``open`` makes it.

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
        """The target of sample number ``idx``; no picture is read where that can be spared."""
        target: Optional[BaseTarget] = self._native.target(self._index(idx))
        return target

    def name(self, idx: int) -> str:
        """What reports call sample number ``idx``: the path of its file within the data set, or its number."""
        return self._native.name(self._index(idx))

    def sequence(self, idx: int) -> Optional[int]:
        """The number of the video or drive that the sample is a frame of; None when samples are no frames."""
        return self._native.sequence(self._index(idx))

    @property
    def classes(self) -> list[str]:
        """What class numbers in the targets mean."""
        return self._native.classes

    @property
    def problems(self) -> list[str]:
        """What was left out as broken, each with its file and line or key."""
        return self._native.problems

    def _index(self, idx: int) -> int:
        index = whole(idx, "the number of a sample")
        index += len(self) if index < 0 else 0
        if not 0 <= index < len(self):
            raise IndexError(f"there is no sample {idx} among {len(self)}")
        return index


def formats() -> list[dict[str, Any]]:
    """The formats of data sets that there are: ``name``, ``aliases``, ``about``, ``layout``, ``targets``."""
    from opendr import _opendr

    return _opendr.formats()


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
