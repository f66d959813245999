//! CTranslate2's `model.bin`.
//!
//! `file` reads the binary format, `whisper` knows what CTranslate2 calls the weights of a Whisper.

mod file;
mod whisper;

pub use whisper::whisper_from_ctranslate2;
