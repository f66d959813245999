//! The integration tests of this crate, one program: each program more is linked once more.

#![allow(clippy::unwrap_used, clippy::panic)]

mod cmyk_jpeg;
mod files;
mod pictures;
mod place;
#[cfg(feature = "ros")]
mod recordings;
mod reports;
#[cfg(feature = "ros")]
mod topics;
mod training;
mod usage;
mod videos;
