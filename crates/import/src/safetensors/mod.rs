//! Hugging Face's safetensors format.
//!
//! `file` reads the format, `whisper` maps the names of Whisper's weights.

mod file;
mod whisper;

pub use file::{FloatTensor, SafetensorsFile};
pub use whisper::whisper_from_safetensors;
