"""OpenDR's engine."""

from __future__ import annotations

from opendr._upstream.rows import Absent, Home

_DATA = "Data Image ImageWithDetections PointCloud PointCloudWithCalibration SkeletonSequence Timeseries Vector Video"
_TARGETS = (
    "BaseTarget BaseTranscription BoundingBox BoundingBox3D BoundingBox3DList BoundingBoxList Category CocoBoundingBox"
    " Heatmap Keypoint Pose Target TrackingAnnotation TrackingAnnotation3D TrackingAnnotation3DList"
    " TrackingAnnotationList VoskTranscription WhisperTranscription"
)
_DATASETS = "Dataset DatasetIterator ExternalDataset MappedDatasetIterator PointCloudsDatasetIterator"
_LEARNERS = "BaseLearner Learner LearnerActive LearnerRL"


def _of(module: str, names: str) -> dict[str, Home]:
    return dict.fromkeys(names.split(), f"opendr.engine.{module}")


MODULES: dict[str, dict[str, Home]] = {
    "constants": _of("constants", "OPENDR_SERVER_URL"),
    "data": _of("data", _DATA),
    "datasets": _of("datasets", _DATASETS),
    "example_learner": {"ExampleLearner": Absent("docs/python.md has an example of a learner in Python")},
    "helper.io": _of("helper.io", "bump_version"),
    "learners": _of("learners", _LEARNERS),
    "target": _of("target", _TARGETS),
}
