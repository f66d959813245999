//! Visual odometry, loop closure by a pose graph, and errors of trajectories.
//!
//! - [`VisualOdometry`] follows corners by optical flow, finds the camera's pose by PnP in RANSAC, refines key frames in a sliding window,
//!   recognises places and closes loops.
//! - [`VisualOdometryLearner`] is the same as a learner, with an [`Odometry`](opendr_engine::target::Odometry) for each image.
//! - [`Trajectory`] reads and writes the files of TUM and KITTI; [`absolute_errors`], [`relative_errors`] and [`kitti_drift`] compare two.
//! - [`PoseGraph`] is the optimiser of poses that loop closure uses.
//!
//! Camera frames have x to the right, y down and z ahead. The world is the frame of the first camera.

mod geometry;
mod image;
mod learner;
mod loops;
mod odometry;
mod trajectory;

pub use geometry::{PinholeCamera, Pose, Rotation, Similarity3};
pub use learner::{VisualOdometryInputs, VisualOdometryLearner, VisualOdometryParams};
pub use loops::{Edge, GraphReport, PoseGraph};
pub use odometry::{
    CameraFrame, CameraKind, LoopReport, LossReason, OdometryParams, Tracking, VisualOdometry,
};
pub use trajectory::{
    Alignment, DriftErrors, KITTI_LENGTHS, RelativeErrors, Stamped, Statistics, Trajectory, absolute_errors,
    kitti_drift, relative_errors,
};
