//! Runners of the cases in `tests/cases` on every surface, built with the test learner.

use std::path::Path;
use std::process::Command;

use crate::shell::{Result, command, step, target};
use crate::surfaces;

/// Builds the runner in C and sets the paths of all runners in the environment of `pytest`; the C library is under `prefix`.
pub fn prepare(pytest: &mut Command, prefix: &Path) -> Result<()> {
    let runner = target().join("parity-runner");
    let mut gcc = command("gcc");
    gcc.args(["-std=c11", "-O1", "bindings/c/tests/runner.c", "-o"]).arg(&runner).arg("-I");
    gcc.arg(prefix.join("include")).arg("-L").arg(prefix.join("lib")).arg("-lopendr");
    step("c runner", &mut gcc)?;
    pytest.env("OPENDR_INFER_JSON", surfaces::example("infer_json"));
    pytest.env("OPENDR_INFER_JSON_C", &runner).env("LD_LIBRARY_PATH", prefix.join("lib"));
    Ok(())
}
