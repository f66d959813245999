//! Objects that keep their number from moment to moment, in space.

mod ab3dmot;

pub use ab3dmot::{Ab3dmot, Ab3dmotParams, Ab3dmotState};
