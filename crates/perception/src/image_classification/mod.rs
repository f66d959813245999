//! The class that a whole picture belongs to.

mod image_classifier;

pub use image_classifier::{ImageClassifier, ImageClassifierParams};
