//! Hand pose estimation in images.

mod hand_pose;

pub use hand_pose::{HandPose, HandPoseParams, HandPoseState};
