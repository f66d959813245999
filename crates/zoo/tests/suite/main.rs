//! The integration tests of this crate, one program: each program more is linked once more.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod cards;
mod http;
mod models_package;
#[cfg(unix)]
mod onnx_runtime;
mod parts;
mod place;
mod processes;
mod registries;
mod repository;
mod server;
