//! Every surface, built for tests.

use crate::shell::{Result, command, step};
use crate::test::TEST_LEARNER;

/// Builds the command, the Python module, the C library and the Rust runner in `target/debug`, with the test learner.
/// All at once and always the same: a choice of packages has features of its own, for which cargo compiles anew.
pub fn build() -> Result<()> {
    let packages = ["opendr", "opendr-cli", "opendr-python", "opendr-c"];
    let mut build = command("cargo");
    build.args(["build", "--lib", "--bins", "--example", "infer_json", TEST_LEARNER]);
    build.args(packages.iter().flat_map(|package| ["--package", package]));
    step("all surfaces", &mut build)
}
