"""OpenDR's data sets of point clouds: KITTI's 3D boxes and tracks."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, Any, NoReturn, Optional, Union

from opendr._errors import FormatError, Unsupported
from opendr._upstream.parts import numbers
from opendr.engine.data import Image, PointCloudWithCalibration
from opendr.engine.datasets import DatasetIterator, ExternalDataset, PointCloudsDatasetIterator
from opendr.engine.target import (
    BoundingBox3D,
    BoundingBox3DList,
    TrackingAnnotation3D,
    TrackingAnnotation3DList,
)

if TYPE_CHECKING:
    from numpy.typing import NDArray

PathLike = Union[str, "os.PathLike[str]"]
#: Rows and columns of KITTI's matrices, by their number of elements.
_SHAPES = {12: (3, 4), 9: (3, 3)}


class KittiDataset(ExternalDataset):
    """KITTI's detection benchmark; ``ExternalDataset(path, "kitti")``.

    Args:
        path: Its folder.
        kitti_subsets_path: No effect: the splits are in ``ImageSets`` of the data set.
    """

    def __init__(self, path: PathLike, kitti_subsets_path: PathLike = "") -> None:
        super().__init__(path, "kitti")
        self.kitti_subsets_path: str = os.fspath(kitti_subsets_path)

    @staticmethod
    def download(*given: Any, **named: Any) -> NoReturn:
        """Raises ``opendr.Unsupported``: the data are available from their publisher only."""
        _not_downloadable()

    @staticmethod
    def download_mini_kitti(download_path: PathLike, *given: Any, **named: Any) -> NoReturn:
        """Raises ``opendr.Unsupported``: the data are available from their publisher only."""
        _not_downloadable()

    @staticmethod
    def download_nano_kitti(download_path: PathLike, *given: Any, **named: Any) -> NoReturn:
        """Raises ``opendr.Unsupported``: the data are available from their publisher only."""
        _not_downloadable()


class LabeledPointCloudsDatasetIterator(DatasetIterator):
    """Scans with 3D boxes, in the order of the file names.

    Args:
        lidar_path: The folder of the scans, little-endian float32 numbers.
        label_path: The folder of KITTI's labels.
        calib_path: The folder of KITTI's calibrations.
        image_path: The folder of the images, for their size.
        num_point_features: Numbers per point.

    Raises:
        FileNotFoundError: A folder does not exist.
        ValueError: The folders have different numbers of files.
    """

    def __init__(
        self,
        lidar_path: PathLike,
        label_path: PathLike,
        calib_path: PathLike,
        image_path: Optional[PathLike] = None,
        num_point_features: int = 4,
    ) -> None:
        self._clouds = PointCloudsDatasetIterator(lidar_path, num_point_features)
        self._labels, self._calibrations = _files(label_path), _files(calib_path)
        self._images = None if image_path is None else _files(image_path)
        counts = [len(self._clouds), len(self._labels), len(self._calibrations), len(self._images or self._labels)]
        if len(set(counts)) > 1:
            raise ValueError(f"the numbers of scans, labels, calibrations and images differ: {counts}")

    def __getitem__(self, idx: int) -> tuple[PointCloudWithCalibration, BoundingBox3DList]:
        boxes = [_box(words, place) for _, words, place in _rows(self._labels[idx], 0)]
        shape = None if self._images is None else _shape(self._images[idx])
        cloud = PointCloudWithCalibration(self._clouds[idx].data, parse_calib(self._calibrations[idx]), shape)
        return cloud, BoundingBox3DList(boxes)

    def __len__(self) -> int:
        return len(self._clouds)


class KittiTrackingDatasetIterator(DatasetIterator):
    """Sequences of detected 3D boxes and annotated tracks, in the order of the file names.

    Args:
        inputs_path: The folder of the boxes.
        ground_truths_path: The folder of KITTI's tracking labels.
        inputs_format: Format of the boxes: ``"detection"`` (frame, then a label) or ``"tracking"``.

    Raises:
        FileNotFoundError: A folder does not exist.
        ValueError: The folders have different numbers of files, or the format is unknown.
    """

    def __init__(self, inputs_path: PathLike, ground_truths_path: PathLike, inputs_format: str = "detection") -> None:
        if inputs_format not in ("detection", "tracking"):
            raise ValueError(f"inputs_format = {inputs_format!r}: give 'detection' or 'tracking'")
        self.inputs_format = inputs_format
        self.inputs_files, self.ground_truths_files = _files(inputs_path), _files(ground_truths_path)
        counts = [len(self.inputs_files), len(self.ground_truths_files)]
        if counts[0] != counts[1]:
            raise ValueError(f"the numbers of inputs and ground truths differ: {counts}")

    @staticmethod
    def download(*given: Any, **named: Any) -> NoReturn:
        """Raises ``opendr.Unsupported``: the data are available from their publisher only."""
        _not_downloadable()

    @staticmethod
    def download_labels(download_path: PathLike, create_dir: bool = False) -> NoReturn:
        """Raises ``opendr.Unsupported``: the data are available from their publisher only."""
        _not_downloadable()

    def __getitem__(self, idx: int) -> tuple[list[BoundingBox3DList], list[TrackingAnnotation3DList]]:
        before = 2 if self.inputs_format == "tracking" else 1
        rows = [row for row in _rows(self.inputs_files[idx], before) if row[1][0] != "DontCare"]
        truths = _rows(self.ground_truths_files[idx], 2)
        frames = 1 + max((int(row[0][0]) for row in (*rows, *truths)), default=-1)
        boxes = _by_frame([(int(row[0][0]), _box(*row[1:])) for row in rows], frames)
        tracks = _by_frame([(int(row[0][0]), _track(*row)) for row in truths], frames)
        return [BoundingBox3DList(found) for found in boxes], [TrackingAnnotation3DList(found) for found in tracks]

    def __len__(self) -> int:
        return len(self.inputs_files)


class LabeledTrackingPointCloudsDatasetIterator(DatasetIterator):
    """The scans of one recording with annotated tracks.

    Args:
        lidar_path: The folder of the scans, little-endian float32 numbers.
        label_path: The file of KITTI's tracking labels.
        calib_path: The file of KITTI's calibration.
        image_path: The folder of the images, for their size.
        labels_format: ``"tracking"`` for annotations with identities, ``"detection"`` for boxes.
        num_point_features: Numbers per point.

    Raises:
        FileNotFoundError: A file or folder does not exist.
        ValueError: A line is broken, or the format is unknown.
    """

    def __init__(
        self,
        lidar_path: PathLike,
        label_path: PathLike,
        calib_path: PathLike,
        image_path: Optional[PathLike] = None,
        labels_format: str = "tracking",
        num_point_features: int = 4,
    ) -> None:
        if labels_format not in ("detection", "tracking"):
            raise ValueError(f"labels_format = {labels_format!r}: give 'detection' or 'tracking'")
        self._clouds = PointCloudsDatasetIterator(lidar_path, num_point_features)
        self._images = None if image_path is None else _files(image_path)
        self._tracking = labels_format == "tracking"
        self.calib = parse_calib(calib_path)
        rows = [(int(row[0][0]), _track(*row)) for row in _rows(os.fspath(label_path), 2)]
        self._tracks = _by_frame(rows, max(len(self._clouds), 1 + max((frame for frame, _ in rows), default=-1)))

    @staticmethod
    def download(*given: Any, **named: Any) -> NoReturn:
        """Raises ``opendr.Unsupported``: the data are available from their publisher only."""
        _not_downloadable()

    @staticmethod
    def download_pico_kitti(download_path: PathLike, create_dir: bool = False) -> NoReturn:
        """Raises ``opendr.Unsupported``: the data are available from their publisher only."""
        _not_downloadable()

    def __getitem__(
        self, idx: int
    ) -> tuple[PointCloudWithCalibration, Union[TrackingAnnotation3DList, BoundingBox3DList]]:
        shape = None if self._images is None else _shape(self._images[idx])
        tracks = TrackingAnnotation3DList(self._tracks[range(len(self))[idx]])
        target = tracks if self._tracking else tracks.bounding_box_3d_list()
        return PointCloudWithCalibration(self._clouds[idx].data, self.calib, shape), target

    def __len__(self) -> int:
        return len(self._clouds)


def parse_calib(calib_path: PathLike) -> dict[str, NDArray[Any]]:
    """Reads the matrices of KITTI's calibration by name.

    Raises:
        opendr.FormatError: A line has neither 9 nor 12 numbers.
    """
    import numpy as np

    matrices = {}
    with open(calib_path, encoding="utf-8") as file:
        lines = [line.strip() for line in file if line.strip()]
    for line in lines:
        name, _, values = line.replace(":", " ").partition(" ")
        shape = _SHAPES.get(len(values.split()))
        if shape is None:
            raise FormatError(f"{os.fspath(calib_path)}: {name!r:.100} has {len(values.split())} numbers, not 9 or 12")
        matrix = np.array(numbers(values, shape[0] * shape[1], os.fspath(calib_path))).reshape(shape)
        # KITTI's tracking benchmark has other names.
        matrices[{"R_rect": "R0_rect", "Tr_velo_cam": "Tr_velo_to_cam"}.get(name, name)] = matrix
    return matrices


Row = tuple[list[float], list[str], str]


def _rows(path: str, before: int) -> list[Row]:
    """Reads a label file: for each line the numbers before the label (frame, track id), the label, and its position."""
    rows = []
    with open(path, encoding="utf-8") as file:
        lines = [line.split() for line in file]
    for number, words in enumerate(lines, 1):
        place = f"{path}:{number}"
        if words:
            rows.append((numbers(" ".join(words[:before]), before, place), words[before:], place))
    return rows


def _fields(words: list[str], place: str) -> dict[str, Any]:
    if not words:
        raise FormatError(f"{place} has no label")
    values = numbers(" ".join(words[1:]), 14, place)
    height, width, length = values[7:10]
    score = numbers(words[15], 1, place)[0] if len(words) > 15 else 0.0
    return {
        **{"name": words[0], "truncated": values[0], "occluded": int(values[1]), "alpha": values[2]},
        **{"bbox2d": values[3:7], "dimensions": [length, height, width], "location": values[10:13]},
        **{"rotation_y": values[13], "score": score},
    }


def _box(words: list[str], place: str) -> BoundingBox3D:
    return BoundingBox3D(**_fields(words, place))


def _track(before: list[float], words: list[str], place: str) -> TrackingAnnotation3D:
    return TrackingAnnotation3D(**_fields(words, place), id=int(before[1]), frame=int(before[0]))


def _by_frame(items: list[tuple[int, Any]], frames: int) -> list[list[Any]]:
    found: list[list[Any]] = [[] for _ in range(frames)]
    for frame, item in items:
        if not 0 <= frame < frames:
            raise FormatError(f"frame {frame} is out of range; there are {frames} frames")
        found[frame].append(item)
    return found


def _files(folder: PathLike) -> list[str]:
    path = os.fspath(folder)
    return [os.path.join(path, name) for name in sorted(os.listdir(path))]


def _shape(path: str) -> tuple[int, int]:
    image = Image.open(path)
    return image.height, image.width


def _not_downloadable() -> NoReturn:
    raise Unsupported("KITTI cannot be downloaded here; get it from its publisher and give its folder")
