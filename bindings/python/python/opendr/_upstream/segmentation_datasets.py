"""OpenDR's data sets of classes of pixels and points."""

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
    """CamVid: images of roads with the classes of their pixels.

    Args:
        path: The folder with ``train``, ``train_labels`` (or ``trainannot``), ... and maybe ``class_dict.csv``.
        scale: Kept as it is: images are read in their size, and cropped by the training itself.
        mode: The part.

    Raises:
        FileNotFoundError: It does not exist.
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
        """Raises ``opendr.Unsupported``: the data have to be had from whoever publishes them."""
        raise Unsupported(
            "CamVid cannot be downloaded from here; get it from whoever publishes it, and give its folder"
        )

    def __getitem__(self, idx: int) -> Any:
        return self._samples[idx]

    def __len__(self) -> int:
        return len(self._samples)


class _StreetDataset(DatasetIterator):
    """Pictures with classes, as published (Cityscapes' folders), or as OpenDR prepared them (``images``,
    ``stuffthingmaps``)."""

    dataset_type = ""

    def __init__(self, path: PathLike) -> None:
        self.path: str = os.fspath(path)
        #: Kept as it is: images are prepared by the learner.
        self.pipeline: Any = None
        folders = [os.path.join(self.path, name) for name in ("images", "stuffthingmaps")]
        self._files = [sorted(_pictures(folder)) for folder in folders] if os.path.isdir(folders[0]) else None
        self._samples = None if self._files else ExternalDataset(self.path, self.dataset_type).open()
        #: Names of the class indices; empty where OpenDR's folders do not tell.
        self.classes: list[str] = [] if self._samples is None else self._samples.classes
        if self._files and self._files[1] and len(self._files[0]) != len(self._files[1]):
            raise FormatError(f"{self.path}: {len(self._files[0])} pictures have {len(self._files[1])} maps")

    def evaluate(self, *given: Any, **named: Any) -> NoReturn:
        """Raises ``opendr.Unsupported``: ``eval`` of a learner, or ``opendr score``, measures."""
        raise Unsupported("evaluate is not here; use eval of a learner, or `opendr score` of files")

    @staticmethod
    def prepare_data(*given: Any, **named: Any) -> NoReturn:
        """Raises ``opendr.Unsupported``: data are read as they are published."""
        raise Unsupported("nothing has to be prepared: give the folder of the data set as it is published")

    def __getitem__(self, idx: int) -> tuple[Image, Optional[Heatmap]]:
        if self._samples is not None:
            image, target = self._samples[idx]
            return image, target
        pictures, maps = self._files or ([], [])
        target = None
        if maps:
            labels = Image.open(maps[idx]).data[0]
            target = Heatmap(labels)
        return Image.open(pictures[idx]), target

    def __len__(self) -> int:
        return len(self._samples) if self._samples is not None else len((self._files or [[]])[0])


class CityscapesDataset(_StreetDataset):
    """Cityscapes: images of streets with classes.

    Args:
        path: Its folder, as it is published, or as OpenDR prepared it.

    Raises:
        FileNotFoundError: It does not exist.
    """

    dataset_type = "cityscapes"


class KittiDataset(_StreetDataset):
    """KITTI's panoptic images, in Cityscapes' folders or as OpenDR prepared them.

    Args:
        path: Its folder.

    Raises:
        FileNotFoundError: It does not exist.
    """

    dataset_type = "cityscapes"


class SemanticKittiDataset(DatasetIterator):
    """SemanticKITTI: scans with the class of each point.

    Args:
        path: The folder that has ``sequences``.
        split: ``"train"``, ``"valid"`` or ``"test"``; train when there is none.

    Raises:
        FileNotFoundError: There is no sequence of the part.
        ValueError: There is no such part.
    """

    dataset_type = "SemanticKITTIDataset"

    def __init__(self, path: PathLike, split: Optional[str] = None) -> None:
        self.path: str = os.fspath(path)
        #: Kept as it is: scans are prepared by the learner.
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
            raise FileNotFoundError(f"no scans of the part {self.split} in {os.path.join(self.path, 'sequences')}")
        self._places = [(clouds, labels, index) for clouds, labels in self._parts for index in range(len(clouds))]

    @staticmethod
    def load_point_cloud(path: PathLike) -> PointCloud:
        """Reads a scan, four little-endian float32 numbers a point."""
        import numpy as np

        return PointCloud(np.fromfile(path, dtype="<f4").reshape(-1, 4))

    def evaluate(self, *given: Any, **named: Any) -> NoReturn:
        """Raises ``opendr.Unsupported``: metrics of ``opendr.metrics`` measure."""
        raise Unsupported("evaluate is not here; use opendr.metrics")

    @staticmethod
    def prepare_data(*given: Any, **named: Any) -> NoReturn:
        """Raises ``opendr.Unsupported``: data are read as they are published."""
        raise Unsupported("nothing has to be prepared: give the folder of the data set as it is published")

    def __getitem__(self, idx: int) -> tuple[PointCloud, Optional[Heatmap]]:
        import numpy as np

        clouds, folder, index = self._places[idx]
        cloud = clouds[index]
        path = os.path.join(folder, f"{os.path.splitext(clouds.files[index])[0]}.label")
        if not os.path.exists(path):
            return cloud, None
        labels = np.fromfile(path, dtype="<u4")
        if len(labels) != len(cloud):
            raise FormatError(f"{path} has labels of {len(labels)} points, the scan has {len(cloud)}")
        # The upper half numbers the object.
        return cloud, Heatmap(labels & 0xFFFF)

    def __len__(self) -> int:
        return len(self._places)


class HighResolutionDataset(DatasetIterator):
    """Squares of images with boxes: class 1 in a box, class 0 outside of all.

    Args:
        dataset_folder: Images, with Pascal VOC's XML files beside them.
        patch_size: Side of the squares, pixels.
        non_zero_threshold: Squares that lie in boxes with a larger share than this, and in one of them with a smaller,
            are left out.
        transform: From a square to whatever.

    Raises:
        FileNotFoundError: There is nothing.
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
        self._pictures = ExternalDataset(dataset_folder, "voc").open(target=BoundingBoxList)
        self.patch_size, self.transform = patch_size, transform
        self._patches = [
            (index, patch, label)
            for index in range(len(self._pictures))
            for patch, label in self._labelled(index, non_zero_threshold)
        ]

    def get_labels(self) -> list[int]:
        """The classes of all squares."""
        return [label for _, _, label in self._patches]

    def __getitem__(self, idx: int) -> tuple[Any, Category]:
        index, (left, top), label = self._patches[idx]
        pixels = self._pictures[index][0].data[:, top : top + self.patch_size, left : left + self.patch_size]
        patch = Image(pixels.copy(), guess_format=False)
        category = Category(label, self.classes[label])
        return (patch if self.transform is None else self.transform(patch)), category

    def __len__(self) -> int:
        return len(self._patches)

    def _labelled(self, index: int, threshold: float) -> Iterator[tuple[tuple[int, int], int]]:
        import numpy as np

        image, boxes = self._pictures[index]
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
