//! Image classification, and classification of compressive measurements.
//!
//! [`image_classification`] has the learner [`ImageClassifier`](image_classification::ImageClassifier),
//! [`compressive_learning`] has [`MultilinearCompressive`](compressive_learning::MultilinearCompressive), which classifies
//! small linear measurements of images. The feature `training` adds `fit`. Face recognition and expressions are in the crate
//! `opendr-faces`, accuracy and other metrics in `opendr-metrics`.
//!
//! Begin with `ImageClassifier`.
//!
//! ```
//! use opendr_classification::image_classification::{ImageClassifier, ImageClassifierParams};
//! use opendr_engine::Device;
//! use opendr_engine::learner::Handle;
//!
//! let params = ImageClassifierParams { probabilities: false, ..Default::default() };
//! let learner = Handle::<ImageClassifier>::new(params, Device::Cpu)?;
//! // After `load`, `infer` returns the `Category` of an `Image`.
//! assert!(!learner.is_ready());
//! # Ok::<(), opendr_engine::Error>(())
//! ```

pub mod compressive_learning;
pub mod image_classification;

#[cfg(feature = "training")]
mod labelled_pictures;
