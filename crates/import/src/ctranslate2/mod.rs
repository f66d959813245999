//! Import from CTranslate2's `model.bin`.
//!
//! `file` reads the binary format, `whisper` maps the names of Whisper's weights.

mod file;
mod whisper;

pub use whisper::whisper_from_ctranslate2;
