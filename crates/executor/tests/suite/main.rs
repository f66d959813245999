//! Tests of the graph executor on small graphs and real files.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "tests fail by panicking")]

mod conformance;
mod conv_transpose;
mod hostile;
mod operators;
mod threads;
