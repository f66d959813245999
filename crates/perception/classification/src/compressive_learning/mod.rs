//! Classification of compressive measurements.

mod multilinear_compressive;

#[cfg(feature = "training")]
pub use multilinear_compressive::MultilinearCompressiveFitParams;
pub use multilinear_compressive::{
    CompressiveBackbone, MultilinearCompressive, MultilinearCompressiveParams,
};
