//! Depth of every pixel from one image.
//!
//! [`ImportedDepthEstimator`](depth_estimation::ImportedDepthEstimator) runs a network that another tool exported. Depth from two
//! cameras is in `opendr-stereo`.
//!
//! ```
//! use opendr_depth::depth_estimation::{DepthKind, ImportedDepthEstimator, ImportedDepthEstimatorParams};
//! use opendr_engine::Device;
//! use opendr_engine::learner::Handle;
//!
//! let params = ImportedDepthEstimatorParams { kind: DepthKind::Metric, ..Default::default() };
//! let learner = Handle::<ImportedDepthEstimator>::new(params, Device::Cpu)?;
//! // After `load`, `infer` returns the depth of each pixel of an `Image` as a `Heatmap`.
//! assert!(!learner.is_ready());
//! # Ok::<(), opendr_engine::Error>(())
//! ```

pub mod depth_estimation;
