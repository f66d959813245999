//! Tracking of objects in 3D over time.

mod ab3dmot;
mod vpit;

pub use ab3dmot::{Ab3dmot, Ab3dmotParams, Ab3dmotState};
pub use vpit::{Extrapolation, Vpit, VpitInputs, VpitLayout, VpitParams, VpitState};
#[cfg(feature = "training")]
pub use vpit::{VpitFitParams, VpitObjective};
