//! Files of one JSON value per line.

use std::path::Path;

use opendr_engine::{Error, Result, ResultExt as _};
use serde::de::DeserializeOwned;

/// Reads all values.
///
/// # Errors
/// `NotFound` and `Io`; `Format` for a line that is another value.
pub(crate) fn read_lines<T: DeserializeOwned>(path: &Path) -> Result<Vec<T>> {
    let text = std::fs::read_to_string(path).context(|| path.display().to_string())?;
    let lines = text.lines().enumerate().filter(|(_, line)| !line.trim().is_empty());
    let value = |(at, line): (usize, &str)| {
        serde_json::from_str(line).map_err(|error| {
            Error::format(format!("line {} of {} is damaged", at + 1, path.display())).with_source(error)
        })
    };
    lines.map(value).collect()
}
