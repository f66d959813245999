//! What hands say.

mod hand_features;
mod keypoint_gesture;
mod point_classifier;

pub use hand_features::{features_of_hand, features_of_path};
#[cfg(feature = "training")]
pub use keypoint_gesture::KeypointGestureFitParams;
pub use keypoint_gesture::{KeypointGesture, KeypointGestureParams};
