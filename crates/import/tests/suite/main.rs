//! Integration tests of this crate in one program, which is linked once.

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
