"""Trackers."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, Optional, Union

from opendr._native_learner import NativeLearner
from opendr._upstream.arguments import by_name
from opendr._upstream.rows import arguments as arguments_of
from opendr.engine._checks import whole
from opendr.engine.data import ImageWithDetections
from opendr.engine.datasets import DatasetIterator
from opendr.engine.target import (
    BoundingBox,
    BoundingBox3D,
    BoundingBox3DList,
    BoundingBoxList,
    TrackingAnnotation,
    TrackingAnnotation3D,
    TrackingAnnotation3DList,
    TrackingAnnotationList,
)


class NumberedFrames(NativeLearner):
    """A tracker that can be told the numbers of its frames."""

    def infer(self, image: Any, frame_ids: Any = None, **arguments: Any) -> Any:
        """Predicts as ``infer`` of every learner does; ``frame_ids`` are the numbers of the frames, one for an image,
        or a list."""
        return _numbered(super().infer(image, **arguments), frame_ids)


class DeepSort(NativeLearner):
    """DeepSORT, of images with their boxes in one or in two inputs."""

    _JOINED = arguments_of("batch>image frame_ids swap_left_top!swap")

    def infer(self, *inputs: Any, **arguments: Any) -> Any:
        """Predicts tracks, of an image and a detector's boxes as ``infer`` of every learner does, or as OpenDR: of an
        ``ImageWithDetections``, or a list of them, and the numbers of the frames (``frame_ids``)."""
        first = inputs[0] if inputs else arguments.get("batch", arguments.get("image"))
        several = isinstance(first, (list, tuple))
        items: list[Any] = list(first) if isinstance(first, (list, tuple)) else [first]
        if not items or not all(isinstance(item, ImageWithDetections) for item in items) or "detections" in arguments:
            return super().infer(*inputs, **arguments)
        owner = f"{type(self).__name__}.infer"
        found = by_name(owner, self._JOINED, inputs, arguments, stacklevel=3)
        frame_ids = found.pop("frame_ids", None)
        if isinstance(frame_ids, BoundingBoxList):
            raise TypeError(f"{owner}: an ImageWithDetections has its boxes; frame_ids are numbers of frames")
        del found["image"]
        tracks = [super(DeepSort, self).infer(item, item.boxes, **found) for item in items]
        return _numbered(tracks if several else tracks[0], frame_ids)

    def eval(self, dataset: Any, **options: Any) -> dict[str, Any]:
        """Measures as ``eval`` of every learner does; samples may be pairs of ``ImageWithDetections`` and
        annotations."""
        return super().eval(_Apart(dataset) if isinstance(dataset, DatasetIterator) else dataset, **options)


class _Apart(DatasetIterator):
    """A data set whose images and boxes are two data."""

    def __init__(self, dataset: DatasetIterator) -> None:
        self._dataset = dataset
        self.classes = list(getattr(dataset, "classes", []))

    def __getitem__(self, idx: int) -> Any:
        data, target = self._dataset[idx]
        return (data, data.boxes) if isinstance(data, ImageWithDetections) else data, target

    def __len__(self) -> int:
        return len(self._dataset)


def _numbered(tracks: Any, frame_ids: Any) -> Any:
    """Tracks with the numbers of their frames."""
    if frame_ids is None or isinstance(tracks, Iterator):
        return tracks
    answers = tracks if isinstance(tracks, list) else [tracks]
    numbers = list(frame_ids) if hasattr(frame_ids, "__iter__") else [frame_ids]
    if len(numbers) != len(answers):
        raise ValueError(f"{len(answers)} frames have {len(numbers)} numbers in frame_ids; give one for each")
    for answer, number in zip(answers, numbers):
        for track in answer.data:
            track.frame = whole(number, "frame_ids")
    return tracks


class BoxesInSpace(NativeLearner):
    """A tracker of boxes in space, which has no weights to load."""

    def infer(self, *inputs: Any, **arguments: Any) -> Any:
        """Predicts as ``infer`` of every learner does."""
        self._make_ready()
        return super().infer(*inputs, **arguments)

    def eval(self, dataset: Any, **options: Any) -> dict[str, Any]:
        """Measures as ``eval`` of every learner does."""
        self._make_ready()
        return super().eval(dataset, **options)

    def _make_ready(self) -> None:
        if not self.is_ready:
            self.load()


class SingleObject(NativeLearner):
    """A tracker of one object.

    A stream that begins with a single box (``BoundingBox``, ``TrackingAnnotation``) gives a single annotation a frame,
    as OpenDR does; one that begins with a list gives lists.
    """

    _single = False

    def infer(
        self,
        image: Any,
        init_box: Union[BoundingBoxList, BoundingBox, TrackingAnnotation, None] = None,
        **arguments: Any,
    ) -> Any:
        """Predicts where the object of ``init_box`` is; ``init_box`` comes with the first image of a stream."""
        if isinstance(init_box, TrackingAnnotation):
            init_box = init_box.bounding_box()
        if init_box is not None:
            self._single = isinstance(init_box, BoundingBox)
        first = BoundingBoxList([init_box]) if isinstance(init_box, BoundingBox) else init_box
        given = {} if first is None else {"init_box": first}
        answer = super().infer(image, **given, **arguments)
        if not self._single:
            return answer
        if isinstance(answer, Iterator):
            return map(_only, answer)
        return [_only(tracks) for tracks in answer] if isinstance(answer, list) else _only(answer)

    def reset(self) -> None:
        """Forgets what was seen: the next image begins anew."""
        self._single = False
        super().reset()


def _only(tracks: TrackingAnnotationList) -> Optional[TrackingAnnotation]:
    return tracks.data[0] if len(tracks) else None


class Vpit(NativeLearner):
    """A tracker of one object in the scans of a lidar."""

    def init(
        self,
        point_cloud: Any,
        label_lidar: Union[BoundingBox3D, BoundingBox3DList],
        draw: bool = False,
        clear_metrics: bool = False,
    ) -> None:
        """Begins a stream with the object's box in the first scan.

        Args:
            point_cloud: The scan.
            label_lidar: The box, a ``BoundingBox3D`` or a ``TrackingAnnotation3D``.
            draw: Nothing is drawn.
            clear_metrics: Nothing is counted.
        """
        box = label_lidar.bounding_box_3d() if isinstance(label_lidar, TrackingAnnotation3D) else label_lidar
        self.reset()
        self.infer(
            point_cloud=point_cloud, init_box=BoundingBox3DList([box]) if isinstance(box, BoundingBox3D) else box
        )

    def infer(
        self,
        point_cloud: Any,
        frame: Optional[int] = None,
        id: Optional[int] = None,
        init_box: Any = None,
        **arguments: Any,
    ) -> Any:
        """Predicts where the object is; ``init_box`` comes with the first scan of a stream, ``frame`` and ``id`` are
        those of the annotations."""
        if isinstance(frame, BoundingBox3DList):
            raise TypeError("frame should be an int; give the box of the first scan by name, as init_box")
        given = {} if init_box is None else {"init_box": init_box}
        found = super().infer(point_cloud, **given, **arguments)
        if frame is None and id is None or not isinstance(found, TrackingAnnotation3DList):
            return found
        return TrackingAnnotation3DList([_renamed(track, frame, id) for track in found.data], classes=found.classes)


def _renamed(track: TrackingAnnotation3D, frame: Optional[int], id: Optional[int]) -> TrackingAnnotation3D:
    names = ("name", "truncated", "occluded", "alpha", "bbox2d", "dimensions", "location", "rotation_y")
    return TrackingAnnotation3D(
        **{name: track.data[name] for name in names},
        id=track.id if id is None else id,
        score=track.confidence,
        frame=track.frame if frame is None else frame,
        class_name=track.class_name,
    )
