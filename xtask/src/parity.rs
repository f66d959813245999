//! The cases of `tests/cases` through every surface, all built with the test learner.

use std::path::Path;
use std::process::Command;

use crate::shell::{Result, command, step, target};
use crate::surfaces;

/// Builds the runner in C and names the runner of each surface to `pytest`; the C library is installed under `prefix`.
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
