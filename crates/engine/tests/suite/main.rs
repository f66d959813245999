//! The integration tests of this crate, in one program to link only once.

#![allow(clippy::unwrap_used)]

mod json;
mod label_files;
