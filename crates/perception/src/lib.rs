//! Perception learners: one folder per task, one file per learner.

pub mod activity_recognition;
pub mod ambiguity_measure;
pub mod beats;
pub mod binary_high_resolution;
pub mod compressive_learning;
pub mod face_detection;
pub mod face_recognition;
pub mod facial_expression_recognition;
pub mod facial_landmarks;
pub mod fall_detection;
pub mod gesture_recognition;
pub mod grasp_detection;
pub mod hand_pose_estimation;
pub mod heart_anomaly_detection;
pub mod image_classification;
pub mod instance_segmentation;
pub mod mfcc;
pub mod multimodal_human_centric;
pub mod object_detection_2d;
pub mod object_detection_3d;
pub mod object_tracking_2d;
pub mod object_tracking_3d;
pub mod panoptic_segmentation;
pub mod pillars;
pub mod pose_estimation;
pub mod range_image;
pub mod regions;
pub mod resampler;
pub mod semantic_segmentation;
pub mod skeleton_based_action_recognition;
pub mod speech_recognition;
pub mod speech_transcription;
pub mod stereo_matching;
pub mod suppression;
pub mod tiling;
pub mod tracking;
pub mod voice_activity;
pub mod voice_activity_detection;

mod category_scores;
mod clip_frames;
mod described_input;
mod face_finder;
mod frame_clock;
#[cfg(feature = "training")]
mod frozen_layers;
#[cfg(feature = "training")]
mod labelled;
#[cfg(feature = "training")]
mod labelled_pictures;
#[cfg(feature = "training")]
mod open_sides;
#[cfg(test)]
#[cfg(feature = "training")]
mod overfit;
mod picture_network;
#[cfg(test)]
#[cfg(feature = "training")]
mod promises;
#[cfg(feature = "training")]
mod small_backbone;
#[cfg(feature = "training")]
mod small_classifier;
#[cfg(test)]
mod test_models;
#[cfg(feature = "training")]
mod trainable_weights;
mod turned_square;
