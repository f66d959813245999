//! The wheels of `bindings/python` and `bindings/models`.

use std::fs;
use std::path::{Path, PathBuf};

use crate::shell::{Result, command, root, step, target};
use crate::surfaces::TEST_LEARNER;
use crate::tools::Python;

/// Purpose of a wheel.
#[derive(Clone, Copy, PartialEq)]
pub enum For {
    /// Tests: from the same build as the other test programs, with the test learner.
    Tests,
    /// Users: in the profile `dist`, with the highest compression.
    Users,
}

impl For {
    /// Returns the arguments of maturin.
    fn arguments(self) -> String {
        match self {
            Self::Tests => format!("--profile dev --compression-level 1 {TEST_LEARNER}"),
            Self::Users => "--compression-level 9".to_owned(),
        }
    }

    fn folder(self) -> PathBuf {
        target().join(if self == Self::Tests { "wheels" } else { "wheels-release" })
    }
}

/// Builds a wheel with the pip of `python`, as a user does; one for users is compressed again, more tightly than pip can.
pub fn build(python: &Python, purpose: For) -> Result<PathBuf> {
    let wheel = pip_wheel(
        python,
        &purpose.folder(),
        "bindings/python",
        &[("MATURIN_PEP517_ARGS", &purpose.arguments())],
    )?;
    if purpose == For::Users {
        step(
            "compression of the wheel",
            command("advzip").args(["--recompress", "--shrink-extra", "--quiet"]).arg(&wheel),
        )?;
    }
    Ok(wheel)
}

/// Builds the data package `bindings/models` with our own weights.
pub fn build_models(python: &Python) -> Result<PathBuf> {
    pip_wheel(python, &target().join("wheels-models"), "bindings/models", &[])
}

fn pip_wheel(python: &Python, folder: &Path, package: &str, environment: &[(&str, &str)]) -> Result<PathBuf> {
    // A missing folder is no error.
    fs::remove_dir_all(folder).ok();
    let mut pip = command(python.program());
    pip.args(["-m", "pip", "--quiet", "--disable-pip-version-check", "wheel", "--no-deps", "--wheel-dir"]);
    pip.envs(environment.iter().copied());
    step(&format!("wheel of {package}"), pip.arg(folder).arg(format!("./{package}")))?;
    only_wheel(folder)
}

/// Unpacks a wheel into a folder for `PYTHONPATH`.
pub fn unpack(python: &Python, wheel: &Path, folder: &Path) -> Result<()> {
    // A missing folder is no error.
    fs::remove_dir_all(folder).ok();
    step("wheel's files", command(python.program()).args(["-m", "zipfile", "-e"]).arg(wheel).arg(folder))
}

/// Builds the package of the working tree with the test learner into `folder`, for `PYTHONPATH`.
pub fn package(folder: &Path) -> Result<()> {
    let python = Python::install(&crate::tools::PACKAGE)?;
    unpack(&python, &build(&python, For::Tests)?, folder)
}

/// Returns the wheel of a folder that has one.
fn only_wheel(folder: &Path) -> Result<PathBuf> {
    let wheels = fs::read_dir(folder).map_err(|error| format!("{}: {error}", folder.display()))?;
    let wheels: Vec<_> = wheels.flatten().map(|entry| root().join(entry.path())).collect();
    match &wheels[..] {
        [wheel] => Ok(wheel.clone()),
        _ => Err(format!("{}: expected one wheel, not {wheels:?}", folder.display())),
    }
}
