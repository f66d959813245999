//! Semantic segmentation.

mod bisenet;
mod deeplab;
mod imported_segmenter;
mod nearest;
mod segmenters;
mod selfie_segmentation;
mod tiled_segmentation;

#[cfg(feature = "training")]
pub use bisenet::BisenetFitParams;
pub use bisenet::{Bisenet, BisenetParams};
pub use deeplab::{Deeplab, DeeplabParams};
pub use imported_segmenter::{ImportedSegmenter, ImportedSegmenterParams, MapFormat};
pub(crate) use nearest::nearest;
pub use segmenters::SEGMENTERS;
pub use selfie_segmentation::{SelfieSegmentation, SelfieSegmentationParams};
pub use tiled_segmentation::{TiledSegmentation, TiledSegmentationParams, TiledSegmentationState};
