//! Hugging Face's safetensors.
//!
//! `file` reads the format, `whisper` finds the weights of a Whisper in it.

mod file;
mod whisper;

pub use file::{FloatTensor, SafetensorsFile};
pub use whisper::whisper_from_safetensors;
