//! The integration tests of this crate, one program: each program more is linked once more.

#![allow(clippy::unwrap_used, clippy::panic)]

mod allocation;
mod drives;
mod learner;
