//! The wheel of `bindings/python`.

use std::fs;
use std::path::{Path, PathBuf};

use crate::shell::{Result, command, root, step, target};
use crate::test::TEST_LEARNER;
use crate::tools::Python;

/// What a wheel is built for.
#[derive(Clone, Copy, PartialEq)]
pub enum For {
    /// Tests: out of the same build as everything else that they test, with the test learner.
    Tests,
    /// Users: the profile `dist`, packed as small as it goes.
    Users,
}

impl For {
    /// What maturin is given.
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

/// Builds a wheel with the pip of `python`, as a user does.
pub fn build(python: &Python, purpose: For) -> Result<PathBuf> {
    pip_wheel(python, &purpose.folder(), "bindings/python", &[("MATURIN_PEP517_ARGS", &purpose.arguments())])
}

/// Builds the data package with the weights of our own, `bindings/models`.
pub fn build_models(python: &Python) -> Result<PathBuf> {
    pip_wheel(python, &target().join("wheels-models"), "bindings/models", &[])
}

fn pip_wheel(python: &Python, folder: &Path, package: &str, environment: &[(&str, &str)]) -> Result<PathBuf> {
    // Nothing there is what is wanted.
    fs::remove_dir_all(folder).ok();
    let mut pip = command(python.program());
    pip.args(["-m", "pip", "--quiet", "--disable-pip-version-check", "wheel", "--no-deps", "--wheel-dir"]);
    pip.envs(environment.iter().copied());
    step(&format!("wheel of {package}"), pip.arg(folder).arg(format!("./{package}")))?;
    only_wheel(folder)
}

/// Unpacks a wheel into a folder for `PYTHONPATH`.
pub fn unpack(python: &Python, wheel: &Path, folder: &Path) -> Result<()> {
    // Nothing there is what is wanted.
    fs::remove_dir_all(folder).ok();
    step("wheel's files", command(python.program()).args(["-m", "zipfile", "-e"]).arg(wheel).arg(folder))
}

/// The package as it stands in the working tree, with the test learner, below `folder`, for `PYTHONPATH`.
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
        _ => Err(format!("{}: one wheel is wanted, not {wheels:?}", folder.display())),
    }
}
