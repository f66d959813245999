//! Standard output, whose reader may have gone.

use std::fmt::Display;
use std::io::Write;

use opendr::{Error, Result};
use serde::Serialize;

/// Prints a line.
///
/// # Errors
/// `Io` with the cause as its source, so that [`crate::exit`] can tell a closed pipe from a full disk.
pub fn print(line: impl Display) -> Result<()> {
    let written = writeln!(std::io::stdout(), "{line}");
    written.map_err(|error| Error::io("writing to standard output").with_source(error))
}

/// Prints a report as a line of JSON.
///
/// # Errors
/// As [`print`]; `Internal` for one that has no such form.
pub fn print_json(report: &impl Serialize) -> Result<()> {
    print(json_or_told(serde_json::to_string(report))?)
}

/// Prints a report as JSON over several lines.
///
/// # Errors
/// As [`print_json`].
pub fn print_pretty_json(report: &impl Serialize) -> Result<()> {
    print(json_or_told(serde_json::to_string_pretty(report))?)
}

fn json_or_told(json: serde_json::Result<String>) -> Result<String> {
    json.map_err(|error| Error::internal("the report has no JSON form").with_source(error))
}
