//! Hands: their key points in pictures, and their gestures.
//!
//! Begin with [`hand_pose_estimation::HandPose`]; [`gesture_recognition::HandGesture`] recognises gestures by its key points.

pub mod gesture_recognition;
pub mod hand_pose_estimation;
