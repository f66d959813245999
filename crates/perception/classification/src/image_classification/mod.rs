//! The class that a whole picture belongs to.

mod image_classifier;

#[cfg(feature = "training")]
pub use image_classifier::ImageClassifierFitParams;
pub use image_classifier::{ImageClassifier, ImageClassifierParams};
