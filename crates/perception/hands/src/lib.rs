//! Hand pose estimation and hand gesture recognition.
//!
//! [`hand_pose_estimation::HandPose`] detects 21 joints of each hand and tracks hands,
//! [`gesture_recognition::HandGesture`] classifies the gestures of the hands in an image, and
//! [`gesture_recognition::KeypointGesture`] gestures from the keypoints of one hand; the latter is trainable with the feature
//! `training`.
//!
//! Poses of the whole body are in `opendr-pose`. Begin with [`hand_pose_estimation::HandPose`].
//!
//! ```
//! use opendr_engine::target::{Keypoint, Pose, Skeleton};
//! use opendr_hands::gesture_recognition::features_of_hand;
//!
//! let joint = |at: usize| Keypoint { x: 5.0 + at as f32, y: 9.0, confidence: 1.0 };
//! let keypoints = (0..21).map(joint).collect();
//! let hand = Pose { keypoints, skeleton: Skeleton::LeftHand21, ..Pose::default() };
//! let features = features_of_hand(&hand);
//! assert_eq!(features.map(|features| features[40]), Some(1.0));
//! ```

pub mod gesture_recognition;
pub mod hand_pose_estimation;
