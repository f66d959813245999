//! The class of every pixel of a picture.

mod deeplab;
mod tiled_segmentation;

pub use deeplab::{Deeplab, DeeplabParams};
pub use tiled_segmentation::{TiledSegmentation, TiledSegmentationParams, TiledSegmentationState};
