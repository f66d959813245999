//! Tests of the graph executor on small graphs and real files.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "tests fail by panicking")]

mod conformance;
mod control_flow;
mod conv_transpose;
mod convolutions;
mod data_shapes;
mod einsum;
mod graphs;
mod hostile;
mod integers;
mod layouts;
mod operators;
mod threads;

/// Returns the root of the repository, at run time: a build folder that checkouts share keeps this program.
fn root() -> std::path::PathBuf {
    let own = std::env::var_os("CARGO_MANIFEST_DIR").unwrap_or_default();
    std::path::Path::new(&own).join("../..")
}
