//! Key points of hands in a picture.

mod hand_pose;

pub use hand_pose::{HandPose, HandPoseParams, HandPoseState};
