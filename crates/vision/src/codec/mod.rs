//! Image files: decoding and encoding of JPEG, PNG, BMP and WebP.
//!
//! Files are untrusted input: the size in the header is checked before memory is allocated, and every error states
//! the path and the detected content.

mod decode;
mod depth;
mod encode;
mod finding;
mod jpeg;
mod orientation;
mod size;
mod size_limit;

pub use decode::{Decoder, decode, open};
pub use depth::{encode_depth_png, save_depth};
pub use encode::{Encoder, encode_png, save};
pub(crate) use size_limit::LIMIT_VARIABLE;
