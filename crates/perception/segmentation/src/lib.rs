//! Segmentation of pictures: a class for each pixel, persons and their parts, heat maps of small things.
//!
//! Begin with [`semantic_segmentation::Bisenet`] or, for persons, [`instance_segmentation::BodyPix`].

pub mod binary_high_resolution;
pub mod instance_segmentation;
pub mod semantic_segmentation;
