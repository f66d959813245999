//! Classes of whole pictures.
//!
//! Begin with [`image_classification::ImageClassifier`]; [`compressive_learning::MultilinearCompressive`] learns from compressed
//! measurements.

pub mod compressive_learning;
pub mod image_classification;

#[cfg(feature = "training")]
mod labelled_pictures;
