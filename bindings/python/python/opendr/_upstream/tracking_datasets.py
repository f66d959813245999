"""OpenDR's data sets for tracking and person re-identification."""

from __future__ import annotations

import os
import warnings
from collections.abc import Mapping
from typing import Any, NoReturn, Union

from opendr._errors import Unsupported
from opendr._upstream.parts import inside, numbers
from opendr.engine.data import Image, ImageWithDetections
from opendr.engine.datasets import DatasetIterator, ExternalDataset
from opendr.engine.target import Category, TrackingAnnotation, TrackingAnnotationList

PathLike = Union[str, "os.PathLike[str]"]


class MotDataset(ExternalDataset):
    """A data set of the MOT Challenge; ``ExternalDataset(path, "mot")``.

    Args:
        path: Its folder.
    """

    def __init__(self, path: PathLike) -> None:
        super().__init__(path, "mot")

    @staticmethod
    def download(*given: Any, **named: Any) -> NoReturn:
        """Raises ``opendr.Unsupported``: the data are available from their publisher only."""
        _not_downloadable("MOT20")

    @staticmethod
    def download_nano_mot20(download_path: PathLike, create_dir: bool = False) -> NoReturn:
        """Raises ``opendr.Unsupported``: the data are available from their publisher only."""
        _not_downloadable("MOT20")


class Market1501Dataset(ExternalDataset):
    """Market-1501; ``ExternalDataset(path, "market1501")``.

    Args:
        path: Its folder.
    """

    def __init__(self, path: PathLike) -> None:
        super().__init__(path, "market1501")

    @staticmethod
    def download(*given: Any, **named: Any) -> NoReturn:
        """Raises ``opendr.Unsupported``: the data are available from their publisher only."""
        _not_downloadable("Market-1501")

    @staticmethod
    def download_nano_market1501(download_path: PathLike, create_dir: bool = False) -> NoReturn:
        """Raises ``opendr.Unsupported``: the data are available from their publisher only."""
        _not_downloadable("Market-1501")


class Market1501DatasetIterator(DatasetIterator):
    """The persons of a folder of Market-1501, with their ids.

    Args:
        path: The folder, e.g. ``bounding_box_train``.

    Raises:
        FileNotFoundError: The folder does not exist.
    """

    def __init__(self, path: PathLike) -> None:
        self.path: str = os.fspath(path)
        self.files = sorted(name for name in os.listdir(self.path) if name.lower().endswith((".jpg", ".png")))

    def __getitem__(self, idx: int) -> tuple[Image, Category]:
        name = self.files[idx]
        # Distractors have the id -1.
        (person,) = numbers(name.replace("_", " "), 1, os.path.join(self.path, name))
        return Image.open(os.path.join(self.path, name)), Category(int(person), name.split("_")[0])

    def __len__(self) -> int:
        return len(self.files)


class RawMotDatasetIterator(DatasetIterator):
    """The frames of the MOT Challenge with their tracks, in FairMOT's lists.

    A list has one image per line, relative to ``root``; its annotations have the same path below ``labels_with_ids``
    instead of ``images``: class, id, centre and size as fractions of the image size.

    Args:
        root: The folder to which the lists are relative.
        paths: Lists by the names of their data sets.
        options: OpenDR's further arguments, which have no effect: images are not transformed.

    Raises:
        FileNotFoundError: A list does not exist.
        ValueError: A path is outside ``root``.
    """

    #: OpenDR's input size of the network.
    default_resolution = [1088, 608]
    #: Persons.
    num_classes = 1
    classes = ["person"]

    def __init__(self, root: PathLike, paths: Mapping[str, PathLike], *given: Any, **options: Any) -> None:
        if given or options:
            names = ", ".join(options) or "the further arguments"
            text = f"{type(self).__name__}: {names} has no effect: images and boxes are not transformed"
            warnings.warn(text, UserWarning, stacklevel=2)
        self.root: str = os.fspath(root)
        #: The images of each data set.
        self.img_files: dict[str, list[str]] = {}
        for name, path in paths.items():
            with open(path, encoding="utf-8") as file:
                self.img_files[name] = [inside(self.root, line.strip()) for line in file if line.strip()]
        self._frames = [
            (number, frame, path)
            for number, files in enumerate(self.img_files.values())
            for frame, path in enumerate(files)
        ]

    def __getitem__(self, idx: int) -> tuple[Any, TrackingAnnotationList]:
        part, frame, path = self._frames[idx]
        image = Image.open(path)
        label = (
            os.path.splitext(path.replace(f"{os.sep}images{os.sep}", f"{os.sep}labels_with_ids{os.sep}"))[0] + ".txt"
        )
        return image, self._tracks(label, image, part, frame)

    def __len__(self) -> int:
        return len(self._frames)

    def _tracks(self, path: str, image: Image, part: int, frame: int) -> TrackingAnnotationList:
        tracks = []
        if os.path.exists(path):
            with open(path, encoding="utf-8") as file:
                lines = [line for line in file if line.strip()]
            for number, line in enumerate(lines, 1):
                _, person, x, y, width, height = numbers(line, 6, f"{path}:{number}")
                size = (width * image.width, height * image.height)
                corner = (x * image.width - size[0] / 2, y * image.height - size[1] / 2)
                # Ids are unique across data sets.
                known = (part << 32) + int(person)
                tracks.append(
                    TrackingAnnotation(0, *corner, *size, id=known, score=1, frame=frame, class_name="person")
                )
        return TrackingAnnotationList(tracks, classes=self.classes)


class MotDatasetIterator(RawMotDatasetIterator):
    """The same as :class:`RawMotDatasetIterator`: the training augments the images itself."""


class RawMotWithDetectionsDatasetIterator(RawMotDatasetIterator):
    """As :class:`RawMotDatasetIterator`, with the boxes of the tracks as detections: the input of DeepSORT."""

    def __getitem__(self, idx: int) -> tuple[Any, TrackingAnnotationList]:
        image, tracks = super().__getitem__(idx)
        return ImageWithDetections(image, tracks.bounding_box_list()), tracks


def _not_downloadable(name: str) -> NoReturn:
    raise Unsupported(f"{name} cannot be downloaded here; get it from its publisher and give its folder")
