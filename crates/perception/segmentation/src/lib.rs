//! Segmentation of images: semantic, instance and binary.
//!
//! [`semantic_segmentation`] predicts a class per pixel: [`Bisenet`](semantic_segmentation::Bisenet), which trains,
//! [`Deeplab`](semantic_segmentation::Deeplab), [`SelfieSegmentation`](semantic_segmentation::SelfieSegmentation), and
//! [`TiledSegmentation`](semantic_segmentation::TiledSegmentation) for large images. [`instance_segmentation`] has
//! [`BodyPix`](instance_segmentation::BodyPix) for persons, [`binary_high_resolution`] a patch classifier for high-resolution
//! images. The feature `training` adds `fit`. Panoptic segmentation is in the crate `opendr-panoptic`.
//!
//! Begin with `Bisenet` or, for persons, `BodyPix`.
//!
//! ```
//! use opendr_engine::Device;
//! use opendr_engine::learner::Handle;
//! use opendr_segmentation::instance_segmentation::{BodyPix, BodyPixParams};
//!
//! let params = BodyPixParams { max_detections: 5, ..Default::default() };
//! let learner = Handle::<BodyPix>::new(params, Device::Cpu)?;
//! // After `load`, `infer` returns the persons of an `Image` as boxes with masks.
//! assert!(!learner.is_ready());
//! # Ok::<(), opendr_engine::Error>(())
//! ```

pub mod binary_high_resolution;
pub mod instance_segmentation;
pub mod semantic_segmentation;
