//! The cases of `tests/cases` through every surface, all built with the test learner.

use std::path::Path;
use std::process::Command;

use crate::python_package;
use crate::shell::{Result, check, command, step, target};
use crate::tools::Python;

/// Builds the runner of each surface and compares what they print; the C library is installed under `prefix`.
pub fn run(python: &Python, prefix: &Path, environment: impl Fn(&mut Command)) -> Result<()> {
    let folder = target().join("parity");
    python_package::build(&folder)?;
    let runner = folder.join("runner");
    let mut gcc = command("gcc");
    gcc.args(["-std=c11", "-O1", "bindings/c/tests/runner.c", "-o"]).arg(&runner).arg("-I");
    gcc.arg(prefix.join("include")).arg("-L").arg(prefix.join("lib")).arg("-lopendr");
    step("c runner", &mut gcc)?;
    let debug = target().join("debug");
    let mut pytest = command(python.program());
    pytest.args(["-m", "pytest", "-ra", "tests/parity"]).env("PYTHONPATH", &folder);
    pytest
        .env("OPENDR_BIN", debug.join("opendr"))
        .env("OPENDR_INFER_JSON", debug.join("examples/infer_json"));
    pytest.env("OPENDR_INFER_JSON_C", &runner).env("LD_LIBRARY_PATH", prefix.join("lib"));
    environment(&mut pytest);
    check("parity of all surfaces", &mut pytest)
}
