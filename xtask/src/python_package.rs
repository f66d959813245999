//! The Python package as it stands in the working tree, built quickly.

use std::fs;
use std::path::Path;

use crate::shell::{Result, command, root, step, target};
use crate::surfaces;

/// Builds the native half with the test learner, and puts the package below `folder`, for `PYTHONPATH`.
pub fn build(folder: &Path) -> Result<()> {
    surfaces::build()?;
    let failed = |error: std::io::Error| format!("{}: {error}", folder.display());
    // Nothing there is what is wanted.
    fs::remove_dir_all(folder).ok();
    fs::create_dir_all(folder).map_err(failed)?;
    let package = folder.join("opendr");
    let mut copy = command("cp");
    copy.arg("-r").arg(root().join("bindings/python/python/opendr")).arg(&package);
    step("python files", &mut copy)?;
    fs::copy(target().join("debug/lib_opendr.so"), package.join("_opendr.abi3.so")).map_err(failed)?;
    Ok(())
}
