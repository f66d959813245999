//! Every surface, built for tests.

use crate::shell::{Result, command, step};
use crate::test::TEST_LEARNER;

/// Builds the command, the Python module, the C library and every example in `target/debug`, with the test learner.
/// All at once, always the same, and as the tests are: a choice of packages has features of its own, for which cargo
/// compiles anew.
pub fn build() -> Result<()> {
    step(
        "all surfaces and examples",
        command("cargo").args(["build", "--workspace", "--lib", "--bins", "--examples", TEST_LEARNER]),
    )
}
