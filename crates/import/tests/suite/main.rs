//! The integration tests of this crate, one program: each program more is linked once more.

#![allow(clippy::unwrap_used, clippy::panic)]

mod convolution;
mod hostile;
mod hostile_lite;
mod layout;
mod lite;
mod ncnn;
mod tiny;
mod tiny_lite;
mod whisper;
