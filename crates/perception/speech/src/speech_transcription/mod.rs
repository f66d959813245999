//! What was said.

mod whisper;

pub use whisper::{Whisper, WhisperParams, WhisperStream};
