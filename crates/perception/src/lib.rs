//! Perception learners: one folder per task, one file per learner.

pub mod face_detection;
pub mod object_detection_2d;
pub mod pose_estimation;
pub mod suppression;

mod picture_network;
