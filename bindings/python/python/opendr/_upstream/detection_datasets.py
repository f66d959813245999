"""OpenDR's data sets of boxes in images."""

from __future__ import annotations

import os
from collections.abc import Sequence
from typing import Any, Callable, Optional, Union
from xml.etree import ElementTree

from opendr._errors import FormatError
from opendr._upstream.parts import Parts, inside, numbers
from opendr.engine.data import Image
from opendr.engine.datasets import DatasetIterator, ExternalDataset
from opendr.engine.target import BoundingBox, BoundingBoxList, CocoBoundingBox

PathLike = Union[str, "os.PathLike[str]"]
Transform = Optional[Callable[..., Any]]
_PICTURES = (".png", ".jpg", ".jpeg", ".bmp", ".webp")
#: Maximum size of an annotation file in bytes.
_MAX_BYTES = 16 << 20


class DetectionDataset(DatasetIterator):
    """Images with boxes, with transforms that are applied when samples are read.

    Args:
        classes: Names of the class indices.
        dataset_type: The format, as for ``ExternalDataset``.
        root: Folder of the data set.
        image_paths: Image files, where a subclass reads them.
        splits: Name or names of the splits; empty: the first split of the format.
        image_transform: Function of an image.
        target_transform: Function of the boxes.
        transform: Function from both to a sample.

    Raises:
        FileNotFoundError: The data set does not exist.
        ValueError: The format is another, or a sample is broken.
    """

    def __init__(
        self,
        classes: Sequence[str],
        dataset_type: str,
        root: PathLike,
        image_paths: Optional[Sequence[str]] = None,
        splits: Union[str, Sequence[str]] = "",
        image_transform: Transform = None,
        target_transform: Transform = None,
        transform: Transform = None,
    ) -> None:
        self.dataset_type = dataset_type
        self.root: str = os.fspath(root)
        self.splits = splits
        self.image_paths = None if image_paths is None else list(image_paths)
        self._parts: Optional[Parts] = self._open() if image_paths is None else None
        own = self._parts.classes if self._parts is not None else []
        self.classes: list[str] = list(classes) or own
        self._image_transform, self._target_transform, self._transform = image_transform, target_transform, transform

    @property
    def num_classes(self) -> int:
        """Number of classes."""
        return len(self.classes)

    def set_transform(self, transform: Transform) -> None:
        """Sets the function of image and boxes."""
        self._transform = transform

    def set_image_transform(self, transform: Transform) -> None:
        """Sets the function of images."""
        self._image_transform = transform

    def set_target_transform(self, transform: Transform) -> None:
        """Sets the function of boxes."""
        self._target_transform = transform

    def transform(self, transform: Callable[..., Any]) -> MappedDetectionDataset:
        """Returns this data set with a function of image and boxes that is applied to all samples."""
        return MappedDetectionDataset(self, transform)

    def get_image(self, item: int) -> Any:
        """Returns image ``item``."""
        image = self._image(item)
        return image if self._image_transform is None else self._image_transform(image)

    def get_bboxes(self, item: int) -> Any:
        """Returns the boxes of image ``item``."""
        boxes = self._boxes(item)
        return boxes if self._target_transform is None else self._target_transform(boxes)

    def __getitem__(self, idx: int) -> Any:
        image, boxes = self.get_image(idx), self.get_bboxes(idx)
        return (image, boxes) if self._transform is None else self._transform(image, boxes)

    def __len__(self) -> int:
        return len(self._parts) if self._parts is not None else len(self.image_paths or ())

    def _open(self) -> Parts:
        names: list[Optional[str]] = list(_names(self.splits)) or [None]
        external = ExternalDataset(self.root, self.dataset_type)
        return Parts([external.open(split=name, target=BoundingBoxList) for name in names])

    def _image(self, item: int) -> Image:
        if self._parts is None:
            return Image.open((self.image_paths or [])[item])
        image: Image = self._parts[item][0]
        return image

    def _boxes(self, item: int) -> BoundingBoxList:
        if self._parts is None:
            raise NotImplementedError(f"{type(self).__name__} does not read boxes; implement _boxes, or omit image_paths")
        part, index = self._parts.place(item)
        found: BoundingBoxList = part.target(index)
        return found


class MappedDetectionDataset(DatasetIterator):
    """A data set with a function of image and boxes that is applied when samples are read.

    Args:
        data: The data set.
        map_function: Function from an image and its boxes to a sample.
    """

    def __init__(self, data: DatasetIterator, map_function: Callable[..., Any]) -> None:
        self.data = data
        self.map_function = map_function
        self.classes: list[str] = list(getattr(data, "classes", []))

    def __getitem__(self, idx: int) -> Any:
        item = self.data[idx]
        return self.map_function(*item) if isinstance(item, tuple) else self.map_function(item)

    def __len__(self) -> int:
        return len(self.data)


class ConcatDataset(Parts):
    """The concatenation of data sets.

    Args:
        datasets: The data sets; those with class names have the same ones.

    Raises:
        ValueError: Their classes differ.
    """


class WiderFaceDataset(DetectionDataset):
    """WIDER FACE: the folders ``wider_face_split`` and ``WIDER_train``, ... of the published archives.

    Args:
        root: The folder that contains them.
        splits: The splits: ``"train"``, ``"val"``.
        ignore_tiny: Whether faces smaller than 10 pixels are dropped.
        image_transform: Function of an image.
        target_transform: Function of the boxes.
        transform: Function from both to a sample.

    Raises:
        FileNotFoundError: The data set does not exist.
    """

    def __init__(
        self,
        root: PathLike,
        splits: Union[str, Sequence[str]],
        ignore_tiny: bool = True,
        image_transform: Transform = None,
        target_transform: Transform = None,
        transform: Transform = None,
    ) -> None:
        self.ignore_tiny = ignore_tiny
        transforms = (image_transform, target_transform, transform)
        super().__init__(["face"], "wider_face", root, None, splits, *transforms)

    def _boxes(self, item: int) -> BoundingBoxList:
        found = super()._boxes(item)
        if not self.ignore_tiny:
            return found
        kept = [box for box in found.data if max(box.width, box.height) >= 10]
        return BoundingBoxList(kept, found.image_id, classes=found.classes)


class WiderPersonDataset(DetectionDataset):
    """WiderPerson: ``train.txt``, ``val.txt``, and the folders ``Images`` and ``Annotations`` of the published archive.

    Pedestrians, riders and partly visible persons have the class ``person``; ignore regions and crowds are marked as
    crowds, which metrics ignore.

    Args:
        root: The folder that contains them.
        splits: The splits: ``"train"``, ``"val"``.
        image_transform: Function of an image.
        target_transform: Function of the boxes.
        transform: Function from both to a sample.

    Raises:
        FileNotFoundError: A file does not exist.
        ValueError: A line is broken.
    """

    def __init__(
        self,
        root: PathLike,
        splits: Union[str, Sequence[str]],
        image_transform: Transform = None,
        target_transform: Transform = None,
        transform: Transform = None,
    ) -> None:
        folder, names = os.fspath(root), list[str]()
        for split in _names(splits):
            with open(inside(folder, f"{split}.txt"), encoding="utf-8") as file:
                names += [line.strip() for line in file if line.strip()]
        files = [inside(os.path.join(folder, "Images"), f"{name}.jpg") for name in names]
        self._annotations = [inside(os.path.join(folder, "Annotations"), f"{name}.jpg.txt") for name in names]
        transforms = (image_transform, target_transform, transform)
        super().__init__(["person"], "wider_person", root, files, splits, *transforms)

    def _boxes(self, item: int) -> BoundingBoxList:
        boxes, path = list[BoundingBox](), self._annotations[item]
        with open(path, encoding="utf-8") as file:
            lines = [line for line in file if line.strip()]
        for number, line in enumerate(lines[1:], 2):
            kind, x0, y0, x1, y1 = numbers(line, 5, f"{path}:{number}")
            place = (0, x0, y0, x1 - x0, y1 - y0)
            if kind in (1, 2, 3):
                boxes.append(BoundingBox(*place, class_name="person"))
            else:
                boxes.append(CocoBoundingBox(*place, iscrowd=1, class_name="person"))
        return BoundingBoxList(boxes, classes=self.classes)


class XMLBasedDataset(DetectionDataset):
    """Images, and boxes in Pascal VOC's XML files, in folders of any names.

    Args:
        dataset_type: Name of the data set.
        root: The folder that contains both.
        classes: Class names; by default those of the annotations, in alphabetical order.
        image_transform: Function of an image.
        target_transform: Function of the boxes.
        transform: Function from both to a sample.
        splits: No effect: the folder is one split.
        images_dir: Folder of the images.
        annotations_dir: Folder of the annotations, whose names are those of the images.
        preload_anno: Whether annotations are read at once, otherwise on access.

    Raises:
        FileNotFoundError: A folder does not exist.
        ValueError: An annotation is broken.
    """

    def __init__(
        self,
        dataset_type: str,
        root: PathLike,
        classes: Optional[Sequence[str]] = None,
        image_transform: Transform = None,
        target_transform: Transform = None,
        transform: Transform = None,
        splits: Union[str, Sequence[str]] = "",
        images_dir: str = "images",
        annotations_dir: str = "annotations",
        preload_anno: bool = False,
    ) -> None:
        self.abs_images_dir = os.path.join(os.fspath(root), images_dir)
        self.abs_annot_dir = os.path.join(os.fspath(root), annotations_dir)
        names = sorted(name for name in os.listdir(self.abs_images_dir) if name.lower().endswith(_PICTURES))
        self._files = [os.path.join(self.abs_annot_dir, f"{os.path.splitext(name)[0]}.xml") for name in names]
        files = [os.path.join(self.abs_images_dir, name) for name in names]
        transforms = (image_transform, target_transform, transform)
        super().__init__(classes or (), dataset_type, root, files, splits, *transforms)
        self.preload_anno = preload_anno
        self.bboxes: list[BoundingBoxList] = []
        if not self.classes:
            self.classes = sorted({name for file in self._files for name, _ in _objects(file)})
        if preload_anno:
            self.bboxes = [self._boxes(item) for item in range(len(files))]

    def _boxes(self, item: int) -> BoundingBoxList:
        if self.bboxes:
            return self.bboxes[item]
        boxes, file = [], self._files[item]
        for name, (x0, y0, x1, y1) in _objects(file):
            if name not in self.classes:
                raise FormatError(f"{file}: unknown class {name!r:.100}; the classes are {', '.join(self.classes)}")
            # VOC counts pixels from 1, the last one included.
            place = (x0 - 1, y0 - 1, x1 - x0 + 1, y1 - y0 + 1)
            boxes.append(BoundingBox(self.classes.index(name), *place, class_name=name))
        return BoundingBoxList(boxes, classes=self.classes)


def _names(splits: Union[str, Sequence[str]]) -> list[str]:
    return [splits] if isinstance(splits, str) and splits else list(splits)


def _objects(file: str) -> list[tuple[str, list[float]]]:
    """Returns the objects of an annotation: class and corners."""
    with open(file, "rb") as stream:
        text = stream.read(_MAX_BYTES + 1)
    # Documents that define entities are rejected: they may expand without bound.
    if len(text) > _MAX_BYTES or b"<!DOCTYPE" in text or b"<!ENTITY" in text:
        raise FormatError(f"{file} is not an annotation: it is too large, or has a document type")
    try:
        objects = list(ElementTree.fromstring(text).iter("object"))
        corners = [
            " ".join(entry.findtext(f"bndbox/{edge}", "") for edge in ("xmin", "ymin", "xmax", "ymax"))
            for entry in objects
        ]
        names = [entry.findtext("name", "").strip().lower() for entry in objects]
    except ElementTree.ParseError as error:
        raise FormatError(f"{file}: {error}") from None
    return [(name, numbers(line, 4, file)) for name, line in zip(names, corners)]
