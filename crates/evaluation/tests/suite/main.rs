//! The integration tests of this crate, one program: each program more is linked once more.

#![allow(clippy::unwrap_used)]

mod evaluation;
mod permutations;
