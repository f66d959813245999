//! Integration tests of this crate, in one program to save linking.

#![allow(clippy::unwrap_used)]

#[cfg(target_os = "linux")]
mod processes;
mod reinforcement_learning;
