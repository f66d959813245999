//! Image classification.

mod image_classifier;

#[cfg(feature = "training")]
pub use image_classifier::ImageClassifierFitParams;
pub use image_classifier::{ImageClassifier, ImageClassifierParams};
