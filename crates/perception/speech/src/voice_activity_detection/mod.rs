//! Whether somebody speaks.

mod silero_vad;

pub use silero_vad::{SileroVad, SileroVadParams, SileroVadStream};
