"""OpenDR's data sets for segmentation of images and point clouds."""

from __future__ import annotations

import os
from collections.abc import Iterator, Sequence
from typing import Any, Callable, NoReturn, Optional, Union

from opendr._errors import FormatError, Unsupported
from opendr.engine.data import Image, PointCloud
from opendr.engine.datasets import DatasetIterator, ExternalDataset, PointCloudsDatasetIterator
from opendr.engine.target import BoundingBoxList, Category, Heatmap

PathLike = Union[str, "os.PathLike[str]"]
_SEQUENCES = {
    "train": [*range(8), 9, 10],
    "valid": [8],
    "test": [*range(11, 22)],
}


class CamVidDataset(DatasetIterator):
    """CamVid: images of roads with class maps.

    Args:
        path: The folder with ``train``, ``train_labels`` (or ``trainannot``), ... and optionally ``class_dict.csv``.
        scale: No effect: images are read in their own size, and the training crops them.
        mode: The split.

    Raises:
        FileNotFoundError: The data set does not exist.
    """

    dataset_type = "camvid"

    def __init__(self, path: PathLike, scale: Sequence[int] = (720, 960), mode: str = "train") -> None:
        self.path: str = os.fspath(path)
        self.image_size = tuple(scale)
        self.mode = mode
        self._samples = ExternalDataset(self.path, self.dataset_type).open(split=mode)
        #: Names of the class indices.
        self.classes: list[str] = self._samples.classes

    @staticmethod
    def download_data(path: PathLike) -> NoReturn:
        """Raises ``opendr.Unsupported``: the data are available from their publisher only."""
        raise Unsupported(
            "CamVid cannot be downloaded here; get it from its publisher and give its folder"
        )

    def __getitem__(self, idx: int) -> Any:
        return self._samples[idx]

    def __len__(self) -> int:
        return len(self._samples)


class _StreetDataset(DatasetIterator):
    """Images with class maps, in Cityscapes' folders or in those of OpenDR's preparation (``images``, ``stuffthingmaps``)."""

    dataset_type = ""

    def __init__(self, path: PathLike) -> None:
        self.path: str = os.fspath(path)
        #: No effect: the learner prepares the images.
        self.pipeline: Any = None
        folders = [os.path.join(self.path, name) for name in ("images", "stuffthingmaps")]
        self._files = [sorted(_pictures(folder)) for folder in folders] if os.path.isdir(folders[0]) else None
        self._samples = None if self._files else ExternalDataset(self.path, self.dataset_type).open()
        #: Names of the class indices; empty for OpenDR's folders, which have none.
        self.classes: list[str] = [] if self._samples is None else self._samples.classes
        if self._files and self._files[1] and len(self._files[0]) != len(self._files[1]):
            raise FormatError(f"{self.path}: {len(self._files[0])} images have {len(self._files[1])} maps")

    def evaluate(self, *given: Any, **named: Any) -> NoReturn:
        """Raises ``opendr.Unsupported``: ``eval`` of a learner and ``opendr score`` replace it."""
        raise Unsupported("evaluate is not available; use eval of a learner, or `opendr score` for files")

    @staticmethod
    def prepare_data(*given: Any, **named: Any) -> NoReturn:
        """Raises ``opendr.Unsupported``: published data need no preparation."""
        raise Unsupported("no preparation is needed; give the folder of the published data set")

    def __getitem__(self, idx: int) -> tuple[Image, Optional[Heatmap]]:
        if self._samples is not None:
            image, target = self._samples[idx]
            return image, target
        images, maps = self._files or ([], [])
        target = None
        if maps:
            labels = Image.open(maps[idx]).data[0]
            target = Heatmap(labels)
        return Image.open(images[idx]), target

    def __len__(self) -> int:
        return len(self._samples) if self._samples is not None else len((self._files or [[]])[0])


class CityscapesDataset(_StreetDataset):
    """Cityscapes: images of streets with class maps.

    Args:
        path: Its folder, as published or as prepared by OpenDR.

    Raises:
        FileNotFoundError: The data set does not exist.
    """

    dataset_type = "cityscapes"


class KittiDataset(_StreetDataset):
    """KITTI's panoptic images, in Cityscapes' folders or as prepared by OpenDR.

    Args:
        path: Its folder.

    Raises:
        FileNotFoundError: The data set does not exist.
    """

    dataset_type = "cityscapes"


class SemanticKittiDataset(DatasetIterator):
    """SemanticKITTI: scans with the class of each point.

    Args:
        path: The folder that contains ``sequences``.
        split: ``"train"`` (the default), ``"valid"`` or ``"test"``.

    Raises:
        FileNotFoundError: There is no sequence of the split.
        ValueError: The split is unknown.
    """

    dataset_type = "SemanticKITTIDataset"

    def __init__(self, path: PathLike, split: Optional[str] = None) -> None:
        self.path: str = os.fspath(path)
        #: No effect: the learner prepares the scans.
        self.pipeline: Any = None
        self.split = (split or "train").lower()
        if self.split not in _SEQUENCES:
            raise ValueError(f"split = {split!r}: give one of {', '.join(_SEQUENCES)}")
        folders = [os.path.join(self.path, "sequences", f"{number:02}") for number in _SEQUENCES[self.split]]
        self._parts = [
            (PointCloudsDatasetIterator(os.path.join(folder, "velodyne")), os.path.join(folder, "labels"))
            for folder in folders
            if os.path.isdir(os.path.join(folder, "velodyne"))
        ]
        if not self._parts:
            raise FileNotFoundError(f"no scans of the split {self.split} in {os.path.join(self.path, 'sequences')}")
        self._samples = [(clouds, labels, index) for clouds, labels in self._parts for index in range(len(clouds))]

    @staticmethod
    def load_point_cloud(path: PathLike) -> PointCloud:
        """Reads a scan of four little-endian float32 numbers per point."""
        import numpy as np

        return PointCloud(np.fromfile(path, dtype="<f4").reshape(-1, 4))

    def evaluate(self, *given: Any, **named: Any) -> NoReturn:
        """Raises ``opendr.Unsupported``: ``opendr.metrics`` replaces it."""
        raise Unsupported("evaluate is not available; use opendr.metrics")

    @staticmethod
    def prepare_data(*given: Any, **named: Any) -> NoReturn:
        """Raises ``opendr.Unsupported``: published data need no preparation."""
        raise Unsupported("no preparation is needed; give the folder of the published data set")

    def __getitem__(self, idx: int) -> tuple[PointCloud, Optional[Heatmap]]:
        import numpy as np

        clouds, folder, index = self._samples[idx]
        cloud = clouds[index]
        path = os.path.join(folder, f"{os.path.splitext(clouds.files[index])[0]}.label")
        if not os.path.exists(path):
            return cloud, None
        labels = np.fromfile(path, dtype="<u4")
        if len(labels) != len(cloud):
            raise FormatError(f"{path} has labels of {len(labels)} points, the scan has {len(cloud)}")
        # The upper half is the instance id.
        return cloud, Heatmap(labels & 0xFFFF)

    def __len__(self) -> int:
        return len(self._samples)


class HighResolutionDataset(DatasetIterator):
    """Square patches of images with boxes: class 1 inside a box, class 0 outside of all.

    Args:
        dataset_folder: Folder of images and Pascal VOC's XML files.
        patch_size: Side of the patches, pixels.
        non_zero_threshold: Fraction of a patch covered by boxes above which its class is 1. Patches that are covered less,
            but not uncovered, are dropped.
        transform: Function of a patch.

    Raises:
        FileNotFoundError: The folder has no data set.
        ValueError: An annotation is broken.
    """

    classes = ["background", "object"]

    def __init__(
        self,
        dataset_folder: PathLike,
        patch_size: int = 64,
        non_zero_threshold: float = 0.5,
        transform: Optional[Callable[[Image], Any]] = None,
    ) -> None:
        if patch_size < 1:
            raise ValueError(f"patch_size = {patch_size} is out of range; give 1 or more")
        self._images = ExternalDataset(dataset_folder, "voc").open(target=BoundingBoxList)
        self.patch_size, self.transform = patch_size, transform
        self._patches = [
            (index, patch, label)
            for index in range(len(self._images))
            for patch, label in self._labelled(index, non_zero_threshold)
        ]

    def get_labels(self) -> list[int]:
        """Returns the classes of all patches."""
        return [label for _, _, label in self._patches]

    def __getitem__(self, idx: int) -> tuple[Any, Category]:
        index, (left, top), label = self._patches[idx]
        pixels = self._images[index][0].data[:, top : top + self.patch_size, left : left + self.patch_size]
        patch = Image(pixels.copy(), guess_format=False)
        category = Category(label, self.classes[label])
        return (patch if self.transform is None else self.transform(patch)), category

    def __len__(self) -> int:
        return len(self._patches)

    def _labelled(self, index: int, threshold: float) -> Iterator[tuple[tuple[int, int], int]]:
        import numpy as np

        image, boxes = self._images[index]
        covered = np.zeros((image.height, image.width), dtype=bool)
        for box in boxes.data:
            left, top = max(0, round(box.left)), max(0, round(box.top))
            covered[top : round(box.top + box.height), left : round(box.left + box.width)] = True
        side = self.patch_size
        for top in range(0, image.height - side + 1, side):
            for left in range(0, image.width - side + 1, side):
                share = float(covered[top : top + side, left : left + side].mean())
                if share > threshold:
                    yield (left, top), 1
                elif share == 0:
                    yield (left, top), 0


def _pictures(folder: str) -> list[str]:
    if not os.path.isdir(folder):
        return []
    return [os.path.join(folder, name) for name in os.listdir(folder) if name.lower().endswith((".png", ".jpg"))]
