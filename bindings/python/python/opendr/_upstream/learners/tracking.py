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
    """A tracker with an argument for the indices of the frames."""

    def infer(self, image: Any, frame_ids: Any = None, **arguments: Any) -> Any:
        """Predicts as ``infer`` of every learner; ``frame_ids`` is the index of the frame, or a list of indices."""
        return _numbered(super().infer(image, **arguments), frame_ids)


class DeepSort(NativeLearner):
    """DeepSORT, with image and boxes as one input or as two."""

    _JOINED = arguments_of("batch>image frame_ids swap_left_top!swap")

    def infer(self, *inputs: Any, **arguments: Any) -> Any:
        """Predicts tracks from an image and a detector's boxes, as ``infer`` of every learner, or as in OpenDR: from an
        ``ImageWithDetections``, or a list of them, and the indices of the frames (``frame_ids``)."""
        first = inputs[0] if inputs else arguments.get("batch", arguments.get("image"))
        several = isinstance(first, (list, tuple))
        items: list[Any] = list(first) if isinstance(first, (list, tuple)) else [first]
        if not items or not all(isinstance(item, ImageWithDetections) for item in items) or "detections" in arguments:
            return super().infer(*inputs, **arguments)
        owner = f"{type(self).__name__}.infer"
        found = by_name(owner, self._JOINED, inputs, arguments, stacklevel=3)
        frame_ids = found.pop("frame_ids", None)
        if isinstance(frame_ids, BoundingBoxList):
            raise TypeError(f"{owner}: an ImageWithDetections has its boxes; frame_ids are indices of frames")
        del found["image"]
        tracks = [super(DeepSort, self).infer(item, item.boxes, **found) for item in items]
        return _numbered(tracks if several else tracks[0], frame_ids)

    def eval(self, dataset: Any, **options: Any) -> dict[str, Any]:
        """Evaluates as ``eval`` of every learner; samples may be pairs of ``ImageWithDetections`` and annotations."""
        return super().eval(_WithSeparateBoxes(dataset) if isinstance(dataset, DatasetIterator) else dataset, **options)


class _WithSeparateBoxes(DatasetIterator):
    """A data set with each ``ImageWithDetections`` converted to a pair of image and boxes."""

    def __init__(self, dataset: DatasetIterator) -> None:
        self._dataset = dataset
        self.classes = list(getattr(dataset, "classes", []))

    def __getitem__(self, idx: int) -> Any:
        data, target = self._dataset[idx]
        return (data, data.boxes) if isinstance(data, ImageWithDetections) else data, target

    def __len__(self) -> int:
        return len(self._dataset)


def _numbered(tracks: Any, frame_ids: Any) -> Any:
    """Sets the frame indices of tracks."""
    if frame_ids is None or isinstance(tracks, Iterator):
        return tracks
    lists = tracks if isinstance(tracks, list) else [tracks]
    indices = list(frame_ids) if hasattr(frame_ids, "__iter__") else [frame_ids]
    if len(indices) != len(lists):
        raise ValueError(f"{len(lists)} frames have {len(indices)} indices in frame_ids; give one for each")
    for one, index in zip(lists, indices):
        for track in one.data:
            track.frame = whole(index, "frame_ids")
    return tracks


class BoxesInSpace(NativeLearner):
    """A tracker of 3D boxes, which has no weights and is loaded on first use."""

    def infer(self, *inputs: Any, **arguments: Any) -> Any:
        """Predicts as ``infer`` of every learner."""
        self._make_ready()
        return super().infer(*inputs, **arguments)

    def eval(self, dataset: Any, **options: Any) -> dict[str, Any]:
        """Evaluates as ``eval`` of every learner."""
        self._make_ready()
        return super().eval(dataset, **options)

    def _make_ready(self) -> None:
        if not self.is_ready:
            self.load()


class SingleObject(NativeLearner):
    """A tracker of a single object.

    In a stream that begins with a single box (``BoundingBox``, ``TrackingAnnotation``), predictions are single
    annotations, as in OpenDR; in a stream that begins with a list they are lists.
    """

    _single = False

    def infer(
        self,
        image: Any,
        init_box: Union[BoundingBoxList, BoundingBox, TrackingAnnotation, None] = None,
        **arguments: Any,
    ) -> Any:
        """Predicts the box of the object; ``init_box`` is given with the first image of a stream."""
        if isinstance(init_box, TrackingAnnotation):
            init_box = init_box.bounding_box()
        if init_box is not None:
            self._single = isinstance(init_box, BoundingBox)
        first = BoundingBoxList([init_box]) if isinstance(init_box, BoundingBox) else init_box
        given = {} if first is None else {"init_box": first}
        predicted = super().infer(image, **given, **arguments)
        if not self._single:
            return predicted
        if isinstance(predicted, Iterator):
            return map(_only, predicted)
        return [_only(tracks) for tracks in predicted] if isinstance(predicted, list) else _only(predicted)

    def reset(self) -> None:
        """Resets the state: the next image begins a new stream."""
        self._single = False
        super().reset()


def _only(tracks: TrackingAnnotationList) -> Optional[TrackingAnnotation]:
    return tracks._with_header_in(tracks.data[0]) if len(tracks) else None


class Vpit(NativeLearner):
    """A tracker of a single object in lidar scans."""

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
            draw: No effect: nothing is drawn.
            clear_metrics: No effect: no metrics are kept.
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
        """Predicts the box of the object; ``init_box`` is given with the first scan of a stream, ``frame`` and ``id`` are
        set in the predictions."""
        if isinstance(frame, BoundingBox3DList):
            raise TypeError("frame should be an int; give the box of the first scan as the keyword argument init_box")
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
