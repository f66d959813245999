//! Reports of evaluations in environments as files.

use std::path::{Path, PathBuf};

use opendr::atomic_file::replace_file;
use opendr::{JsonFormat, Result, ResultExt as _};
use serde::Serialize;

/// Writes a report as `report.json` into a folder, which is created if needed, and returns its path.
///
/// # Errors
/// `Io` if it cannot be written; `Internal` for a report that does not serialise as an object.
pub fn write(format: JsonFormat, report: &impl Serialize, folder: &Path) -> Result<PathBuf> {
    let path = folder.join("report.json");
    let text = format.to_pretty_json(report)?;
    std::fs::create_dir_all(folder).context(|| format!("creating {}", folder.display()))?;
    replace_file(&path, text.as_bytes())?;
    Ok(path)
}
