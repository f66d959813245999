//! Speech transcription.

mod whisper;

pub use whisper::{Whisper, WhisperParams, WhisperStream};
