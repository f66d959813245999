//! Integration tests of this crate, in one program to save linking.

#![allow(clippy::unwrap_used)]

mod evaluation;
mod opening;
mod permutations;
