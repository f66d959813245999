//! Perception learners: one folder per task, one file per learner.

pub mod face_detection;
<<<<<<< HEAD
pub mod heart_anomaly_detection;
pub mod mfcc;
=======
pub mod image_classification;
>>>>>>> 332d51e (wip)
pub mod object_detection_2d;
pub mod pose_estimation;
pub mod speech_recognition;
pub mod suppression;

mod category_scores;
#[cfg(feature = "training")]
mod labelled;
#[cfg(all(test, feature = "training"))]
mod overfit;
mod picture_network;
<<<<<<< HEAD
#[cfg(feature = "training")]
mod trainable_weights;
=======
mod softmax;
>>>>>>> 332d51e (wip)
