//! Data types, the inputs of learners. One file per type.

mod array;
mod audio;
mod calibration;
mod image;
mod image_with_detections;
mod observation;
mod point_cloud_with_calibration;

pub use array::*;
pub use audio::*;
pub use calibration::*;
pub use image::*;
pub use image_with_detections::*;
pub use observation::*;
pub use point_cloud_with_calibration::*;
