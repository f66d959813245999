//! Image classification.

mod cropped_input;
mod image_classifier;
mod imported_classifier;
mod imported_zero_shot;

#[cfg(feature = "training")]
pub use image_classifier::ImageClassifierFitParams;
pub use image_classifier::{ImageClassifier, ImageClassifierParams};
pub use imported_classifier::{ClassScoreFormat, ImportedClassifier, ImportedClassifierParams};
pub use imported_zero_shot::{ImportedZeroShotClassifier, ImportedZeroShotClassifierParams};
