//! Depth estimation.

mod imported_depth_estimator;

pub use imported_depth_estimator::{
    DepthKind, ImportedDepthEstimator, ImportedDepthEstimatorParams, MapInterpolation,
};
