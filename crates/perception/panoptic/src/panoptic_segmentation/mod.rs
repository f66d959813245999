//! Panoptic segmentation: class and instance of every pixel or point.

mod efficient_lps;
mod efficient_ps;

#[cfg(feature = "training")]
pub use efficient_lps::EfficientLpsFitParams;
pub use efficient_lps::{EfficientLps, EfficientLpsParams, EfficientLpsTargets};
pub use efficient_ps::{EfficientPs, EfficientPsParams, EfficientPsTargets};
