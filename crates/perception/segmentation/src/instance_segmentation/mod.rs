//! Instance segmentation.

mod bodypix;
mod imported_promptable;
mod owner_map;

pub use bodypix::{BodyPix, BodyPixParams};
pub use imported_promptable::{
    ImportedPromptableSegmenter, ImportedPromptableSegmenterParams, MaskSelection, PromptableInputs,
};
pub use owner_map::OwnerMap;
