//! Object detection in pictures: boxes with classes.
//!
//! Begin with [`object_detection_2d::Nanodet`]; [`object_detection_2d::TiledDetection`] finds what is small in large pictures.

pub mod object_detection_2d;
