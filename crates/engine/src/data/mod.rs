//! Data types, the inputs of learners: images, point clouds, audio, series. One file per type.
//!
//! `{}` writes a datum as OpenDR's text; `{:#}` writes a line with its size.

use std::fmt;

use crate::Datum;

/// A data type, an input of learners (OpenDR's `Data`).
pub trait Data: Datum + fmt::Debug + fmt::Display {}

mod array;
mod audio;
mod calibration;
mod image;
mod image_view;
mod image_with_detections;
mod observation;
mod pixel_format;
mod point_cloud;
mod point_cloud_with_calibration;
mod skeleton_sequence;
mod timeseries;
mod vector;
mod video;

pub use array::Array;
pub use audio::Audio;
pub use calibration::Calibration;
pub use image::{Image, Layout, Pixels};
pub use image_view::{ImageView, Samples};
pub use image_with_detections::ImageWithDetections;
pub use observation::Observation;
pub use pixel_format::PixelFormat;
pub use point_cloud::PointCloud;
pub use point_cloud_with_calibration::PointCloudWithCalibration;
pub use skeleton_sequence::SkeletonSequence;
pub use timeseries::Timeseries;
pub use vector::Vector;
pub use video::Video;

/// Writes the readable line of a datum that is one array.
fn write_shape(name: &str, shape: &[usize], f: &mut fmt::Formatter<'_>) -> fmt::Result {
    let shape: Vec<_> = shape.iter().map(usize::to_string).collect();
    writeln!(f, "{name} of shape {}", shape.join("x"))
}
