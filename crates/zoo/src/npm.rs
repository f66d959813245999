//! Downloads from the npm registry with the installed npm.

use std::path::PathBuf;
use std::process::Command;

use opendr_engine::{Progress, Result};

use crate::client::Call;
use crate::source::Package;
use crate::work_folder::WorkFolder;

/// Downloads the package's archive into the work folder; nothing in it runs.
pub(crate) fn npm_archive(package: &Package, work: &WorkFolder, progress: &dyn Progress) -> Result<PathBuf> {
    let output = work.folder("out")?;
    let what = format!("{}@{}", package.package, package.version);
    let mut command = Command::new(if cfg!(windows) { "npm.cmd" } else { "npm" });
    command.args(["pack", "--ignore-scripts", "--loglevel=error", "--pack-destination"]).arg(&output);
    // By default npm's two retries take over a minute without a network.
    command.args(["--fetch-retries=2", "--fetch-retry-mintimeout=500", "--fetch-retry-maxtimeout=2000"]);
    command.arg("--cache").arg(work.folder("cache")?).arg("--").arg(&what);
    Call { command, what: format!("npm package {what}"), size: Some(package.size), output, work }
        .run(progress)
}
