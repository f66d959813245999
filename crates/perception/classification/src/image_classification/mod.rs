//! Image classification.

mod image_classifier;
mod imported_classifier;

#[cfg(feature = "training")]
pub use image_classifier::ImageClassifierFitParams;
pub use image_classifier::{ImageClassifier, ImageClassifierParams};
pub use imported_classifier::{ClassScoreFormat, ImportedClassifier, ImportedClassifierParams};
