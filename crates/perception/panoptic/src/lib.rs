//! Panoptic segmentation of images and of lidar scans.
//!
//! [`EfficientPs`](panoptic_segmentation::EfficientPs) fuses the predictions of a detector, two semantic segmentation networks
//! and an instance segmentation network for images. [`EfficientLps`](panoptic_segmentation::EfficientLps) segments the points
//! of a scan, and trains with the feature `training`. The networks that `EfficientPs` fuses are in the crates
//! `opendr-detection` and `opendr-segmentation`, range images in `opendr-clouds`, panoptic quality (PQ) in `opendr-metrics`.
//!
//! Begin with `EfficientPs` for images or `EfficientLps` for scans.
//!
//! ```
//! use opendr_engine::Device;
//! use opendr_engine::learner::Handle;
//! use opendr_panoptic::panoptic_segmentation::{EfficientLps, EfficientLpsParams};
//!
//! let learner = Handle::<EfficientLps>::new(EfficientLpsParams::default(), Device::Cpu)?;
//! // After `load`, `infer` returns class and instance of every point of a scan.
//! assert!(!learner.is_ready());
//! # Ok::<(), opendr_engine::Error>(())
//! ```

pub mod panoptic_segmentation;
