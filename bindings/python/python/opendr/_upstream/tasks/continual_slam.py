"""OpenDR's perception.continual_slam."""

from __future__ import annotations

from opendr._upstream.rows import Absent, Home

MODULES: dict[str, dict[str, Home]] = {
    "continual_slam_learner": {
        "ContinualSLAMLearner": Absent("use VisualOdometryLearner of visual_odometry for the trajectory")
    },
    "datasets": {"KittiDataset": Absent('use ExternalDataset(path, "kitti_tracking")')},
    "datasets.kitti": {"KittiDataset": Absent('use ExternalDataset(path, "kitti_tracking")')},
}
