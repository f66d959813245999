"""Poses, falls and faces."""

from __future__ import annotations

import math
import os
from typing import Any, Optional

from opendr._native_learner import NativeLearner
from opendr._upstream.arguments import by_name
from opendr._upstream.rows import arguments as arguments_of
from opendr.engine.data import Image
from opendr.engine.datasets import DatasetIterator, ExternalDataset
from opendr.engine.learners import BaseLearner
from opendr.engine.target import Category, Pose, PoseList

#: Angles from the vertical, in degrees, beyond which a part of the body counts as lying; those of OpenDR's rule.
_TORSO, _THIGHS, _CALVES = 45.0, 60.0, 70.0
_FALLEN, _STANDING, _UNKNOWN = (1, "fallen"), (-1, "standing"), (0, "unknown")


class HighResolutionPoses(NativeLearner):
    """Poses in large images, in two passes."""

    def infer_adaptive(self, img: Any, upsample_ratio: int = 4, stride: int = 8) -> Any:
        """Predicts with the method ``adaptive``."""
        return self.infer(image=img, upsample_ratio=upsample_ratio, stride=stride, method="adaptive")

    def eval_adaptive(
        self,
        dataset: Any,
        silent: bool = False,
        verbose: bool = False,
        use_subset: bool = False,
        subset_size: Optional[int] = None,
        upsample_ratio: Optional[int] = None,
        images_folder_name: Optional[str] = None,
        annotations_filename: Optional[str] = None,
        **options: Any,
    ) -> dict[str, Any]:
        """Evaluates the method ``adaptive``, as ``eval``."""
        given = {"upsample_ratio": upsample_ratio, "images_folder_name": images_folder_name}
        given["annotations_filename"] = annotations_filename
        subset = {"use_subset": use_subset, "subset_size": subset_size}
        arguments = {name: value for name, value in {**subset, **given}.items() if value is not None}
        evaluate: Any = self.eval
        with self._temporarily({"method": "adaptive"}):
            numbers: dict[str, Any] = evaluate(dataset, silent=silent, verbose=verbose, **arguments, **options)
        return numbers


class FallDetector(NativeLearner):
    """Detection of falls, with its own detection of persons or with the poses of a pose estimator.

    ``infer`` of ``FallDetectorLearner(pose_estimator)`` returns a list of pairs, as in OpenDR: a category (1 fallen, -1
    standing, 0 unknown) and the pose. So does ``infer`` of poses.
    """

    def __init__(self, *given: Any, **named: Any) -> None:
        found = by_name(type(self).__name__, self._positional, given, named, stacklevel=3)
        pose_estimator = found.pop("pose_estimator", None)
        super().__init__(**found)
        #: The pose estimator; None where the model detects persons itself.
        self.pose_estimator: Optional[BaseLearner] = None
        if pose_estimator is not None:
            self.initialize(pose_estimator)

    def initialize(self, pose_estimator: BaseLearner) -> None:
        """Sets the pose estimator.

        Raises:
            TypeError: The argument is not a learner.
        """
        if not isinstance(pose_estimator, BaseLearner):
            raise TypeError(f"pose_estimator should be a pose estimation learner, not {pose_estimator!r:.100}")
        self.pose_estimator = pose_estimator

    def infer(self, image: Any, **arguments: Any) -> Any:
        """Predicts falls from an image, or from poses.

        Returns:
            Boxes and poses; pairs of category and pose with a pose estimator, or for poses.
        """
        poses = isinstance(image, (list, tuple)) and image and all(isinstance(item, Pose) for item in image)
        if isinstance(image, PoseList) or poses:
            return [(_posture(pose), pose) for pose in image]
        if self.pose_estimator is None:
            return super().infer(image, **arguments)
        if arguments:
            raise TypeError(f"{', '.join(arguments)}: set it on the pose estimator")
        if isinstance(image, (list, tuple)):
            return [self.infer(item) for item in image]
        return [(_posture(pose), pose) for pose in self.pose_estimator.infer(image)]

    def eval(self, dataset: Any, **options: Any) -> dict[str, Any]:
        """Evaluates the detection of falls; with a pose estimator on OpenDR's data sets: an ``ExternalDataset`` of the
        type ``ur_fall_dataset`` or ``test``, or any pairs of image and category.

        Returns:
            With a pose estimator ``accuracy``, ``sensitivity``, ``specificity``, ``detection_accuracy`` (NaN without
            samples) and ``no_detections``; else the scalars of the metric.
        """
        if self.pose_estimator is None:
            return super().eval(dataset, **options)
        from opendr._upstream.pose_datasets import falls_of

        samples = falls_of(dataset) if isinstance(dataset, ExternalDataset) else dataset
        if not isinstance(samples, DatasetIterator):
            raise TypeError(f"dataset should be an ExternalDataset or a DatasetIterator, not {type(dataset).__name__}")
        counts = {(truth, found): 0 for truth in (1, -1) for found in (1, -1, 0)}
        missed = 0
        for image, category in samples:
            if category.data not in (1, -1):
                continue
            self.pose_estimator.reset()
            falls = self.infer(image if isinstance(image, Image) else Image.open(image))
            if falls:
                counts[category.data, falls[0][0].data] += 1
            else:
                missed += 1
        correct = {truth: counts[truth, truth] for truth in (1, -1)}
        decided = {truth: counts[truth, 1] + counts[truth, -1] for truth in (1, -1)}
        total = sum(counts.values()) + missed
        return {
            "accuracy": _share(sum(correct.values()), sum(decided.values())),
            "sensitivity": _share(correct[1], decided[1]),
            "specificity": _share(correct[-1], decided[-1]),
            "detection_accuracy": _share(sum(decided.values()), total),
            "no_detections": missed,
        }


def _share(part: int, whole: int) -> float:
    return part / whole if whole else math.nan


def _posture(pose: Pose) -> Category:
    """Returns the posture of a person, by the same rule as the native learner."""
    joints = {name: point for name, point in zip(pose.joints, pose.data.tolist()) if min(point) >= 0}

    def middle(*names: str) -> Optional[tuple[float, float]]:
        points = [joints[name] for name in names if name in joints]
        if not points:
            return None
        return sum(x for x, _ in points) / len(points), sum(y for _, y in points) / len(points)

    hips, knees = middle("r_hip", "l_hip"), middle("r_knee", "l_knee")
    torso = _lies(middle("neck") or middle("r_sho", "l_sho"), hips, _TORSO)
    parts = [torso, _lies(hips, knees, _THIGHS), _lies(knees, middle("r_ank", "l_ank"), _CALVES)]
    visible = [part for part in parts if part is not None]
    if not visible:
        return Category(*_UNKNOWN)
    return Category(*(_FALLEN if torso is not False and 2 * sum(visible) > len(visible) else _STANDING))


def _lies(upper: Optional[tuple[float, float]], lower: Optional[tuple[float, float]], limit: float) -> Optional[bool]:
    if upper is None or lower is None or upper == lower:
        return None
    across, down = abs(lower[0] - upper[0]), lower[1] - upper[1]
    return math.degrees(math.atan2(across, down)) > limit


class FacialEmotion(NativeLearner):
    """Recognition of emotions of faces."""

    _LOAD = arguments_of(
        "ensemble_size!model path_to_saved_network>path file_name_base_network!whole file_name_conv_branch!whole"
        " fix_backbone!training"
    )

    def load(self, *given: Any, **named: Any) -> bool:
        """Loads a model from its path, as every learner, or with OpenDR's arguments: ``ensemble_size``, then
        ``path_to_saved_network``."""
        if given and isinstance(given[0], (str, os.PathLike)):
            return super().load(*given, **named)
        return super().load(**by_name(f"{type(self).__name__}.load", self._LOAD, given, named, stacklevel=3))
