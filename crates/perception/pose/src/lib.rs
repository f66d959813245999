//! Human pose estimation in images and fall detection.
//!
//! Pose estimators are [`pose_estimation::LightweightOpenPose`] (several persons, trainable),
//! [`pose_estimation::HighResolutionPoseEstimation`] (small persons in large images), [`pose_estimation::Movenet`],
//! [`pose_estimation::Posenet`] and [`pose_estimation::BlazePose`] (33 keypoints of one person).
//! [`pose_estimation::part_affinity`] decodes part affinity fields. [`fall_detection::FallDetector`] detects falls by the poses
//! of a stream. `fit` needs the feature `training`.
//!
//! Poses of hands are in `opendr-hands`, actions by skeletons in `opendr-actions`, the type of poses in `opendr-engine`. Begin
//! with [`pose_estimation::LightweightOpenPose`].
//!
//! ```
//! use opendr_engine::target::{Keypoint, Pose, Skeleton};
//! use opendr_pose::fall_detection::Posture;
//!
//! let mut pose = Pose { skeleton: Skeleton::Opendr18, ..Pose::default() };
//! pose.keypoints = [Keypoint::MISSING; 18].into();
//! for (name, x, y) in [("neck", 10.0, 90.0), ("r_hip", 50.0, 92.0), ("r_knee", 80.0, 91.0)] {
//!     if let Some(joint) = pose.skeleton.joint(name) {
//!         pose.keypoints[joint] = Keypoint { x, y, confidence: 0.9 };
//!     }
//! }
//! assert_eq!(Posture::of(&pose), Posture::Fallen);
//! ```

pub mod fall_detection;
pub mod pose_estimation;

mod frame_clock;
