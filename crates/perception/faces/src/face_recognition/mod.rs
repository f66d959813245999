//! Recognition of persons by their faces.

mod recognition;

pub use recognition::{FaceRecognition, FaceRecognitionParams};
#[cfg(feature = "training")]
pub use recognition::{FaceRecognitionFitParams, FaceRecognitionMode};
