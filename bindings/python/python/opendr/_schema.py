"""Conversion of targets to and from the JSON objects of ``docs/json.md``, their form between Python and the native module.

There are two functions per type; the native module checks the JSON and completes it.
"""

from __future__ import annotations

import json
from collections.abc import Iterable
from typing import TYPE_CHECKING, Any, Callable, Optional

from opendr._errors import InvalidInput
from opendr.engine import data, target
from opendr.engine._checks import names_by_index

if TYPE_CHECKING:
    from numpy.typing import NDArray

Fields = dict[str, Any]


def dumps(value: target.BaseTarget) -> tuple[str, bool]:
    """Returns the JSON of a target, and whether it is a single item, which is written as a list of one.

    Raises:
        TypeError: The value is not a target.
        ValueError: A number is NaN or infinite.
    """
    if not isinstance(value, target.BaseTarget):
        raise TypeError(f"expected a target, e.g. a BoundingBoxList, not {value!r:.200}")
    whole = value._as_value()
    writer = next((_WRITERS[kind] for kind in type(whole).__mro__ if kind in _WRITERS), None)
    if writer is None:
        raise TypeError(f"{type(value).__name__} cannot be written as JSON")
    return json.dumps({**_header(whole), **writer(whole)}, allow_nan=False), whole is not value


def target_from_json(text: str, array: Optional[Any] = None) -> Any:
    """Returns the target of a JSON object of the native module; ``array`` has the values of a heatmap.

    Raises:
        opendr.InvalidInput: A number is null, which is JSON's form of NaN and infinities.
    """
    fields = json.loads(text)
    place = _null_in(fields) if "null" in text else None
    if place is not None:
        raise InvalidInput(f"{fields['type']}{place} is NaN or infinite; a target in Python has finite numbers")
    value = _READERS[fields["type"]](fields if array is None else {**fields, "array": array})
    _set_header(value, fields.get("stamp_ns"), fields.get("frame_id"))
    if "action" in fields:
        value.action = target.Action(fields["action"])
    return value


def _null_in(value: Any) -> Optional[str]:
    """Returns the path of the first null in a JSON value, e.g. ``.boxes[3].left``."""
    if value is None:
        return ""
    items: Iterable[tuple[str, Any]] = ()
    if isinstance(value, dict):
        items = ((f".{name}", item) for name, item in value.items())
    elif isinstance(value, list):
        items = ((f"[{index}]", item) for index, item in enumerate(value))
    for step, item in items:
        rest = _null_in(item)
        if rest is not None:
            return step + rest
    return None


def image_from_pixels(pixels: Any) -> data.Image:
    """Returns an :class:`Image` of native memory; its ``data`` are a read-only view, created on first access."""
    image = data.Image.__new__(data.Image)
    image._data, image._pixels = None, pixels
    _set_header(image, pixels.timestamp, pixels.frame_id)
    return image


def datum_from_parts(kind: str, parts: tuple[Any, ...], stamp_ns: Optional[int], frame_id: Optional[str]) -> Any:
    """Returns a datum of the class ``kind`` from the arguments of its constructor; arrays stay in native memory."""
    value = getattr(data, kind)(*parts)
    _set_header(value, stamp_ns, frame_id)
    return value


def heatmap_numbers(heatmap: target.Heatmap) -> NDArray[Any]:
    """Returns the values of a heatmap in a type of the native module: uint32 class indices, or float32 scores."""
    import numpy as np

    numbers = heatmap.data
    if numbers.dtype.kind != "f" and numbers.size and int(numbers.max()) > 0xFFFFFFFF:
        raise ValueError(f"the Heatmap has class indices up to {numbers.max()}; give indices below {1 << 32}")
    return np.asarray(numbers, dtype=np.float32 if numbers.dtype.kind == "f" else np.uint32)


def _set_header(value: Any, stamp_ns: Optional[int], frame_id: Optional[str]) -> None:
    if stamp_ns is not None:
        value.timestamp = stamp_ns
    if frame_id:
        value.frame_id = frame_id


def _header(value: target.BaseTarget) -> Fields:
    fields: Fields = {}
    if value.timestamp is not None:
        fields["stamp_ns"] = value.timestamp
    if value.frame_id:
        fields["frame_id"] = value.frame_id
    action = getattr(value, "action", None)
    if action is not None:
        fields["action"] = list(action.axes)
    return fields


def _with_classes(fields: Fields, value: Any) -> Fields:
    return {**fields, "classes": value.classes} if value.classes else fields


def _box(box: Any) -> Fields:
    fields = {
        **{"name": box.name, "left": box.left, "top": box.top, "width": box.width, "height": box.height},
        "confidence": box.confidence,
    }
    if box.landmarks:
        fields["landmarks"] = box.landmarks
    if getattr(box, "segmentation", None) is not None:
        outline = {"segmentation": box.segmentation, "area": box.area, "iscrowd": bool(box.iscrowd)}
        fields["segment"] = outline
    return fields


def _track(track: target.TrackingAnnotation) -> Fields:
    fields = {**_box(track), "id": track.id}
    return {**fields, "frame": track.frame} if track.frame >= 0 else fields


def _box_3d(box: target.BoundingBox3D) -> Fields:
    rows = {name: box.data[name].tolist() for name in ("bbox2d", "dimensions", "location")}
    names = ("name", "truncated", "occluded", "alpha", "rotation_y")
    return {**{name: box.data[name] for name in names}, **rows, "confidence": box.confidence}


def _track_3d(track: target.TrackingAnnotation3D) -> Fields:
    fields = {**_box_3d(track), "id": track.id}
    return {**fields, "frame": track.frame} if track.frame >= 0 else fields


def _pose(pose: target.Pose) -> Fields:
    points = zip(pose.data.tolist(), pose.keypoint_confidences.tolist())
    fields = {
        "keypoints": [{"x": x, "y": y, "confidence": confidence} for (x, y), confidence in points],
        "confidence": pose.confidence,
        "skeleton": pose.skeleton,
    }
    if pose.id is not None:
        fields["id"] = pose.id
    if pose.region is not None:
        fields["region"] = _box(pose.region)
    return fields


def _write_boxes(boxes: target.BoundingBoxList) -> Fields:
    fields = {"type": "BoundingBoxList", "boxes": [_box(box) for box in boxes.data]}
    return _with_classes(fields if boxes.image_id < 0 else {**fields, "image_id": boxes.image_id}, boxes)


def _write_tracks(tracks: target.TrackingAnnotationList) -> Fields:
    fields = {"type": "TrackingAnnotationList", "annotations": [_track(track) for track in tracks.data]}
    return _with_classes(fields, tracks)


def _write_boxes_3d(boxes: target.BoundingBox3DList) -> Fields:
    return _with_classes({"type": "BoundingBox3DList", "boxes": [_box_3d(box) for box in boxes.data]}, boxes)


def _write_tracks_3d(tracks: target.TrackingAnnotation3DList) -> Fields:
    fields = {"type": "TrackingAnnotation3DList", "annotations": [_track_3d(track) for track in tracks.data]}
    return _with_classes(fields, tracks)


def _write_poses(poses: target.PoseList) -> Fields:
    return {"type": "PoseList", "poses": [_pose(pose) for pose in poses.data]}


def _write_category(category: target.Category) -> Fields:
    fields: Fields = {"type": "Category", "class": category.data}
    if category.description is not None:
        fields["description"] = category.description
    if category._confidence is not None:
        fields["confidence"] = category._confidence
    if category.probabilities is not None:
        fields["probabilities"] = category.probabilities.tolist()
    return fields


def _write_heatmap(heatmap: target.Heatmap) -> Fields:
    fields: Fields = {"type": "Heatmap", "shape": [0], "scores": []}
    names = names_by_index(heatmap.class_names or {})
    return {**fields, "classes": names} if names else fields


def _write_texts(texts: target.TextRegionList) -> Fields:
    regions = [
        {"text": region.text, "corners": region.corners.tolist(), "confidence": region.confidence} for region in texts.data
    ]
    return {"type": "TextRegionList", "regions": regions}


def _write_odometry(odometry: target.Odometry) -> Fields:
    fields = {"type": "Odometry", "num_landmarks": odometry.num_landmarks}
    if odometry.position is None:
        return fields
    return {**fields, "pose": {"position": odometry.position, "orientation": odometry.orientation}}


def _write_command(command: target.SpeechCommand) -> Fields:
    fields = {"type": "SpeechCommand", "command": command.data, "confidence": command.confidence}
    return fields if command.span_s is None else {**fields, "span_s": command.span_s}


def _write_rl(action: target.RlTarget) -> Fields:
    return {"type": "RlTarget", "values": action.data.tolist()}


def _write_transcription(words: target.BaseTranscription) -> Fields:
    return {"type": "BaseTranscription", "text": words.text}


def _write_vosk(words: target.VoskTranscription) -> Fields:
    return {"type": "VoskTranscription", "text": words.text, "accept_waveform": words.accept_waveform}


def _write_whisper(words: target.WhisperTranscription) -> Fields:
    return {"type": "WhisperTranscription", "text": words.text, "segments": words.segments}


_WRITERS: dict[type[Any], Callable[[Any], Fields]] = {
    target.BoundingBoxList: _write_boxes,
    target.TrackingAnnotationList: _write_tracks,
    target.BoundingBox3DList: _write_boxes_3d,
    target.TrackingAnnotation3DList: _write_tracks_3d,
    target.PoseList: _write_poses,
    target.Category: _write_category,
    target.Heatmap: _write_heatmap,
    target.TextRegionList: _write_texts,
    target.Odometry: _write_odometry,
    target.SpeechCommand: _write_command,
    target.WhisperTranscription: _write_whisper,
    target.VoskTranscription: _write_vosk,
    target.BaseTranscription: _write_transcription,
    target.RlTarget: _write_rl,
}


def _class_name(fields: Fields, classes: list[str]) -> str:
    name = fields["name"]
    return classes[name] if isinstance(name, int) and 0 <= name < len(classes) else ""


def _box_arguments(fields: Fields, classes: list[str]) -> Fields:
    """Returns the arguments that the constructors of boxes and tracks have in common."""
    arguments = {name: fields[name] for name in ("name", "left", "top", "width", "height")}
    arguments |= {"score": fields.get("confidence", 0.0), "landmarks": fields.get("landmarks", ())}
    outline = fields.get("segment")
    if outline is not None:
        arguments |= {**outline, "iscrowd": int(outline["iscrowd"])}
    return {**arguments, "class_name": _class_name(fields, classes)}


def _read_box(fields: Fields, classes: list[str]) -> target.BoundingBox:
    kind = target.BoundingBox if fields.get("segment") is None else target.CocoBoundingBox
    return kind(**_box_arguments(fields, classes))


def _read_boxes(fields: Fields) -> target.BoundingBoxList:
    classes = fields.get("classes", [])
    boxes = [_read_box(box, classes) for box in fields["boxes"]]
    return target.BoundingBoxList(boxes, fields.get("image_id", -1), classes=classes)


def _read_tracks(fields: Fields) -> target.TrackingAnnotationList:
    classes = fields.get("classes", [])
    tracks = [
        target.TrackingAnnotation(**_box_arguments(track, classes), **_identity(track))
        for track in fields["annotations"]
    ]
    return target.TrackingAnnotationList(tracks, classes=classes)


def _identity(fields: Fields) -> Fields:
    return {"id": fields["id"], "frame": fields.get("frame", -1)}


def _box_3d_arguments(fields: Fields, classes: list[str]) -> Fields:
    names = ("name", "truncated", "occluded", "alpha", "bbox2d", "dimensions", "location", "rotation_y")
    arguments = {name: fields[name] for name in names}
    return {**arguments, "score": fields["confidence"], "class_name": _class_name(fields, classes)}


def _read_boxes_3d(fields: Fields) -> target.BoundingBox3DList:
    classes = fields.get("classes", [])
    boxes = [target.BoundingBox3D(**_box_3d_arguments(box, classes)) for box in fields["boxes"]]
    return target.BoundingBox3DList(boxes, classes=classes)


def _read_tracks_3d(fields: Fields) -> target.TrackingAnnotation3DList:
    classes = fields.get("classes", [])
    tracks = [
        target.TrackingAnnotation3D(**_box_3d_arguments(track, classes), **_identity(track))
        for track in fields["annotations"]
    ]
    return target.TrackingAnnotation3DList(tracks, classes=classes)


def _read_poses(fields: Fields) -> target.PoseList:
    poses = []
    for pose in fields["poses"]:
        points = pose["keypoints"]
        poses.append(
            target.Pose(
                [[float(point["x"]), float(point["y"])] for point in points],
                pose["confidence"],
                id=pose.get("id"),
                skeleton=pose["skeleton"],
                region=_read_box(pose["region"], []) if "region" in pose else None,
                keypoint_confidences=[point["confidence"] for point in points],
            )
        )
    return target.PoseList(poses)


def _read_category(fields: Fields) -> target.Category:
    return target.Category(
        *(fields["class"], fields.get("description"), fields.get("confidence")),
        probabilities=fields.get("probabilities"),
    )


def _read_heatmap(fields: Fields) -> target.Heatmap:
    import numpy as np

    if "array" in fields:
        numbers = np.asarray(fields["array"])
    elif "labels" in fields:
        numbers = np.array(fields["labels"], dtype=np.uint32).reshape(fields["shape"])
    else:
        numbers = np.array(fields["scores"], dtype=np.float32).reshape(fields["shape"])
    names = dict(enumerate(fields.get("classes", [])))
    return target.Heatmap(numbers, names or None)


def _read_command(fields: Fields) -> target.SpeechCommand:
    return target.SpeechCommand(fields["command"], fields["confidence"], fields.get("span_s"))


def _read_odometry(fields: Fields) -> target.Odometry:
    pose = fields.get("pose", {})
    return target.Odometry(pose.get("position"), pose.get("orientation"), fields["num_landmarks"])


_READERS: dict[str, Callable[[Fields], Any]] = {
    "BoundingBoxList": _read_boxes,
    "TrackingAnnotationList": _read_tracks,
    "BoundingBox3DList": _read_boxes_3d,
    "TrackingAnnotation3DList": _read_tracks_3d,
    "PoseList": _read_poses,
    "Category": _read_category,
    "Heatmap": _read_heatmap,
    "TextRegionList": lambda fields: target.TextRegionList(
        [target.TextRegion(region["text"], region["corners"], region["confidence"]) for region in fields["regions"]]
    ),
    "Odometry": _read_odometry,
    "SpeechCommand": _read_command,
    "RlTarget": lambda fields: target.RlTarget(fields["values"]),
    "BaseTranscription": lambda fields: target.BaseTranscription(fields["text"]),
    "VoskTranscription": lambda fields: target.VoskTranscription(fields["text"], fields["accept_waveform"]),
    "WhisperTranscription": lambda fields: target.WhisperTranscription(fields["text"], fields["segments"]),
}
