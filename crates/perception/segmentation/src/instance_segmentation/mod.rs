//! Instance segmentation.

mod bodypix;
mod owner_map;

pub use bodypix::{BodyPix, BodyPixParams};
pub use owner_map::OwnerMap;
