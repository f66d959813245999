"""Inputs and outputs of a learner written in Python, from the annotations of its ``infer``."""

from __future__ import annotations

import inspect
import typing
from dataclasses import dataclass
from typing import Annotated, Any, get_args, get_origin

from opendr.engine import data, target
from opendr.engine._parameters import without_none

#: The default name of an input or output of each type.
_NAMES: dict[type, str] = {
    data.Image: "image",
    data.ImageWithDetections: "image_with_detections",
    data.Video: "video",
    data.PointCloud: "point_cloud",
    data.PointCloudWithCalibration: "point_cloud_with_calibration",
    data.Calibration: "calibration",
    data.Timeseries: "timeseries",
    data.Vector: "vector",
    data.Audio: "audio",
    data.SkeletonSequence: "skeleton_sequence",
    data.Observation: "observation",
    target.BoundingBoxList: "boxes",
    target.TrackingAnnotationList: "tracks",
    target.BoundingBox3DList: "boxes_3d",
    target.TrackingAnnotation3DList: "tracks_3d",
    target.PoseList: "poses",
    target.Category: "category",
    target.Heatmap: "heatmap",
    target.Odometry: "odometry",
    target.TextRegionList: "texts",
    target.SpeechCommand: "command",
    target.BaseTranscription: "transcription",
    target.WhisperTranscription: "transcription",
    target.VoskTranscription: "transcription",
    target.RlTarget: "target",
}


@dataclass(frozen=True)
class Init:
    """Marks an input of the first call of a stream: ``first_box: Annotated[BoundingBoxList, Init()]``."""


def ports_of(infer: Any, problems: list[str]) -> list[dict[str, Any]]:
    """Returns the inputs of ``infer``: ``name``, ``type``, ``init``, ``optional``. Errors are added to ``problems``."""
    hints, ports = _hints(infer, problems), []
    for name, parameter in list(inspect.signature(infer).parameters.items())[1:]:
        # Python 3.9 and 3.10 put Optional around the annotation of a parameter whose default is None.
        hint, implicit = without_none(hints.get(name))
        init = False
        if get_origin(hint) is Annotated:
            hint, *extras = get_args(hint)
            init = any(isinstance(extra, Init) or extra is Init for extra in extras)
        hint, optional = without_none(hint)
        if parameter.kind in (parameter.VAR_POSITIONAL, parameter.VAR_KEYWORD):
            problems.append(f"infer takes *{name}; name each input")
        elif hint not in _NAMES:
            problems.append(f"the parameter {name!r} of infer has no data or target type, e.g. `{name}: Image`")
        else:
            given = optional or implicit or parameter.default is not parameter.empty
            ports.append({"name": name, "type": hint.__name__, "init": init, "optional": given})
    return ports


def outputs_of(infer: Any, problems: list[str]) -> list[dict[str, Any]]:
    """Returns the outputs of ``infer``: ``name`` and ``type``. Several outputs are the fields of a ``NamedTuple`` of
    targets; a single one has the default name of its type. Errors are added to ``problems``."""
    returned = _hints(infer, []).get("return")
    if returned in _NAMES:
        return [{"name": _NAMES[returned], "type": returned.__name__}]
    fields = _hints(returned, []) if isinstance(returned, type) and issubclass(returned, tuple) else {}
    if not fields or not all(hint in _NAMES for hint in fields.values()):
        problems.append("infer has no return annotation: write `-> BoundingBoxList`, or a NamedTuple of targets")
        return []
    return [{"name": name, "type": hint.__name__} for name, hint in fields.items()]


def _hints(annotated: Any, problems: list[str]) -> dict[str, Any]:
    try:
        return typing.get_type_hints(annotated, include_extras=True)
    except (NameError, TypeError) as error:
        problems.append(f"the annotations of infer cannot be read ({error}); import their names in the module")
        return {}
