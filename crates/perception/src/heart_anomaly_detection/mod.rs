//! Whether a heart signal is normal.

mod gated_recurrent_unit;

#[cfg(feature = "training")]
pub use gated_recurrent_unit::GatedRecurrentUnitFitParams;
pub use gated_recurrent_unit::{GatedRecurrentUnit, GatedRecurrentUnitParams};
