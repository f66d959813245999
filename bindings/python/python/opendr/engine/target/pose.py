"""Poses: the keypoints of persons and hands."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING, Any, ClassVar, Optional, SupportsIndex, Union

from opendr.engine._arrays import array_of
from opendr.engine._checks import Real, real, whole
from opendr.engine.target._table import Column, Table, floats, ints, texts
from opendr.engine.target.base_target import Target
from opendr.engine.target.bounding_box import BoundingBox
from opendr.engine.target.keypoint import Keypoint
from opendr.engine.target.skeleton import JOINTS, skeleton_of
from opendr.engine.target.target_list import TargetList

if TYPE_CHECKING:
    import supervision
    from numpy.typing import ArrayLike, NDArray


class Pose(Target):
    """The keypoints of one person (or hand, or animal) in an image, in pixels, in the order of its skeleton.

    ``pose["l_wri"]`` and ``pose[7]`` are :class:`Keypoint` objects.

    Args:
        keypoints: ``[joints, 2]``, x and y in pixels; (-1, -1) means not detected. An array, a list of pairs, or a
            list of :class:`Keypoint`, whose scores are kept.
        confidence: Score of the pose, in [0, 1].
        id: Id of the person's track.
        skeleton: Names of the joints, e.g. ``"opendr18"`` or ``"left_hand21"``; by default guessed from their count.
        keypoint_confidences: Score of each joint, in [0, 1]; 0 by default.
        region: The person's box, if known: a ``CocoBoundingBox`` has area and crowd flag, as annotations of COCO do.

    Raises:
        TypeError: A value is not a number, or ``region`` is not a box.
        ValueError: The shape is another, a number is not finite, or the skeleton is unknown.
    """

    #: OpenDR's names of its 18 joints; those of a pose are its ``joints``.
    kpt_names: ClassVar[list[str]] = list(JOINTS["opendr18"])
    num_kpts: ClassVar[int] = 18
    _fields: ClassVar[tuple[str, ...]] = ("data", "confidence", "id", "skeleton", "keypoint_confidences", "region")

    def __init__(
        self,
        keypoints: Union[ArrayLike, Iterable[Keypoint]],
        confidence: Real,
        *,
        id: Optional[SupportsIndex] = None,
        skeleton: Optional[str] = None,
        keypoint_confidences: Optional[ArrayLike] = None,
        region: Optional[BoundingBox] = None,
    ) -> None:
        if region is not None and not isinstance(region, BoundingBox):
            raise TypeError(f"region should be a BoundingBox, not {region!r:.100}")
        points = list(keypoints) if isinstance(keypoints, Iterable) else []
        joints = [point for point in points if isinstance(point, Keypoint)]
        if joints and len(joints) == len(points):
            keypoints = [joint.data for joint in joints]
            if keypoint_confidences is None:
                keypoint_confidences = [joint.confidence or 0.0 for joint in joints]
        self.data = keypoints
        self.confidence = real(confidence, "confidence")
        self.id: Optional[int] = None if id is None else whole(id, "id")
        self.region: Optional[BoundingBox] = region
        self.skeleton: str = skeleton_of(skeleton, len(self.data))
        self.keypoint_confidences = [0.0] * len(self.data) if keypoint_confidences is None else keypoint_confidences

    @property
    def data(self) -> NDArray[Any]:
        """``[joints, 2]``, pixels, float32."""
        data: NDArray[Any] = self._data
        return data

    @data.setter
    def data(self, data: Any) -> None:
        import numpy as np

        points = array_of(data, "float32", "keypoints")
        if points.ndim != 2 or points.shape[0] < 1 or points.shape[1] != 2 or not np.isfinite(points).all():
            raise ValueError(
                f"keypoints of shape {points.shape} should be finite numbers [joints, 2]; give x and y of each joint"
            )
        self._data = points

    @property
    def keypoint_confidences(self) -> NDArray[Any]:
        """Score of each joint, ``[joints]``, float32."""
        return self._keypoint_confidences

    @keypoint_confidences.setter
    def keypoint_confidences(self, confidences: ArrayLike) -> None:
        import numpy as np

        scores = array_of(confidences, "float32", "keypoint_confidences")
        if scores.shape != (len(self.data),) or not np.isfinite(scores).all():
            raise ValueError(
                f"keypoint_confidences of shape {scores.shape} should be {len(self.data)} finite numbers, one per joint"
            )
        self._keypoint_confidences: NDArray[Any] = scores

    @property
    def joints(self) -> tuple[str, ...]:
        """The names of the joints, in order."""
        return JOINTS[self.skeleton]

    @property
    def keypoints(self) -> list[Keypoint]:
        """The joints with their scores."""
        return list(self)

    def __len__(self) -> int:
        return len(self.data)

    def __iter__(self) -> Iterator[Keypoint]:
        return (self[index] for index in range(len(self)))

    def __getitem__(self, key: Union[SupportsIndex, str]) -> Keypoint:
        """Returns the joint of an index or name.

        Raises:
            ValueError: The joint does not exist.
        """
        if isinstance(key, str):
            if key not in self.joints[: len(self)]:
                raise ValueError(f"no keypoint {key!r}; the keypoints are {', '.join(self.joints[: len(self)])}")
            index = self.joints.index(key)
        else:
            index = whole(key, "the index of a keypoint")
        if not 0 <= index < len(self):
            raise ValueError(f"no keypoint {index}; the indices are 0 to {len(self) - 1}")
        return Keypoint(self.data[index].tolist(), self._keypoint_confidences[index])


class PoseList(TargetList[Pose]):
    """The poses of one image, in descending order of score.

    Args:
        poses: The poses.
    """

    _item = Pose

    def __init__(self, poses: Optional[Iterable[Pose]] = None) -> None:
        super().__init__(poses)

    @property
    def poses(self) -> list[Pose]:
        """The poses; the same list as ``data``."""
        return self.data

    def to_supervision(self) -> supervision.KeyPoints:
        """Returns the poses as ``supervision.KeyPoints``: ``xy``, ``keypoint_confidence``, ``detection_confidence``, ``visible``
        (False for a joint that is not detected), in ``data`` ``"tracker_id"`` (-1 for a pose without one) where a pose has an id,
        and ``"xyxy"`` where every pose has a region.

        Raises:
            ImportError: The package supervision, 0.29 or later, is not installed.
            opendr.Unsupported: The poses have different numbers of joints.
        """
        from opendr.engine.target._supervision import key_points

        return key_points(self.data)

    def _is_drawn(self) -> bool:
        return True

    def _table(self) -> Table:
        # The pose of each joint, with its index.
        poses = [(at, pose) for at, pose in enumerate(self.data) for _ in range(len(pose))]
        return {
            "pose": ints(at for at, _ in poses),
            "id": ints(pose.id for _, pose in poses),
            "keypoint": texts(name for pose in self.data for name in _names(pose)),
            "x": Column([x for pose in self.data for x in pose.data[:, 0]], "float32"),
            "y": Column([y for pose in self.data for y in pose.data[:, 1]], "float32"),
            "confidence": Column([score for pose in self.data for score in pose.keypoint_confidences], "float32"),
            "pose_confidence": floats(pose.confidence for _, pose in poses),
        }


def _names(pose: Pose) -> list[str]:
    """Returns a name for each joint: its index where the skeleton has no name for it."""
    return [pose.joints[index] if index < len(pose.joints) else str(index) for index in range(len(pose))]
