//! Voice activity detection.

mod silero_vad;

pub use silero_vad::{SileroVad, SileroVadParams, SileroVadStream};
