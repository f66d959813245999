"""Conversion of arguments to data and targets."""

from __future__ import annotations

import os
from typing import Any, Union

from opendr import _opendr
from opendr.engine import data, datasets, target

PathLike = Union[str, "os.PathLike[str]"]
#: A data set, or the path of one whose format is detected.
DatasetLike = Union[PathLike, datasets.Dataset]
#: Data types that are read from a path: images, videos and folders of frames, WAVE, tables (CSV, text, NPY), scans of KITTI.
READ_FROM_FILES = ("Image", "Video", "Audio", "Timeseries", "Vector", "SkeletonSequence", "PointCloud")
#: Data types that cannot be created from one array.
OF_SEVERAL_PARTS = ("Audio", "Calibration", "ImageWithDetections", "PointCloudWithCalibration")


def input_value(value: Any, name: str, kind: str) -> Any:
    """Converts ``value`` to the data or target class ``kind``."""
    is_target = hasattr(target, kind)
    kind_class: Any = getattr(target if is_target else data, kind)
    if isinstance(value, kind_class):
        return value
    if kind in READ_FROM_FILES and isinstance(value, (str, os.PathLike)):
        return _opendr.open_value(kind, os.fspath(value))
    if kind == "Audio" and isinstance(value, data.Timeseries):
        return value  # Speech learners assume their own sample rate for it, as OpenDR's did.
    article = "an" if kind[0] in "AEIOU" else "a"
    if is_target or kind in OF_SEVERAL_PARTS:
        raise TypeError(f"{name} should be {article} {kind}, not {type(value).__name__}")
    if value is None or isinstance(value, (str, bytes)):
        raise TypeError(f"{name} should be {article} {kind} or an array of numbers, not {value!r:.100}")
    if kind == "Image" and _is_depth(value):
        return data.Image(value.reshape(1, *_rows_and_columns(value)), dtype=value.dtype, guess_format=False)
    return kind_class(value)


def _is_depth(value: Any) -> bool:
    """Returns whether the value is an array of one channel whose samples do not fit into 8 bits: millimetres or metres."""
    one_channel = getattr(value, "ndim", 0) == 2 or (getattr(value, "ndim", 0) == 3 and 1 in (value.shape[0], value.shape[2]))
    return one_channel and str(getattr(value, "dtype", "")) in ("uint16", "float32")


def _rows_and_columns(value: Any) -> tuple[int, ...]:
    shape: tuple[int, ...] = value.shape
    return shape if len(shape) == 2 else (shape[1:] if shape[0] == 1 else shape[:2])
