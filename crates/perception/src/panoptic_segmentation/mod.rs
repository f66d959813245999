//! The class and the object of every pixel.

mod efficient_ps;

pub use efficient_ps::{EfficientPs, EfficientPsParams, EfficientPsTargets};
