//! Recognition of hand gestures.

mod hand_features;
mod hand_gesture;
mod keypoint_gesture;
mod point_classifier;

pub use hand_features::{features_of_hand, features_of_path};
pub use hand_gesture::{HandGesture, HandGestureParams, HandGestureState};
#[cfg(feature = "training")]
pub use keypoint_gesture::KeypointGestureFitParams;
pub use keypoint_gesture::{KeypointGesture, KeypointGestureParams};
