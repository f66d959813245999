//! Perception learners: one folder per task, one file per learner.

pub mod activity_recognition;
pub mod face_detection;
pub mod heart_anomaly_detection;
pub mod image_classification;
pub mod mfcc;
pub mod object_detection_2d;
pub mod pose_estimation;
pub mod skeleton_based_action_recognition;
pub mod speech_recognition;
pub mod suppression;

mod category_scores;
#[cfg(feature = "training")]
mod frozen_layers;
#[cfg(feature = "training")]
mod labelled;
#[cfg(test)]
#[cfg(feature = "training")]
mod overfit;
mod picture_network;
#[cfg(feature = "training")]
mod trainable_weights;
