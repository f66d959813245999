//! Picture files: JPEG, PNG, BMP and WebP, read and written.
//!
//! Files are hostile input: the size a header claims is checked before memory is taken, and every error names
//! the path and what was found there.

mod decode;
mod depth;
mod encode;
mod finding;
mod jpeg;
mod orientation;
mod size;

pub(crate) use decode::LIMIT_VARIABLE;
pub use decode::{Decoder, decode, open};
pub use depth::{encode_depth_png, save_depth};
pub use encode::{Encoder, encode_png, save};
