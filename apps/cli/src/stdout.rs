//! Standard output, with closed pipes distinguished from other errors.

use std::fmt::Display;
use std::io::Write;

use opendr::{Error, Result};
use serde::Serialize;

/// Prints a line.
///
/// # Errors
/// `Io` with the cause as its source, so that [`crate::exit`] can distinguish a closed pipe from a full disk.
pub fn print(line: impl Display) -> Result<()> {
    let written = writeln!(std::io::stdout(), "{line}");
    written.map_err(|error| Error::io("writing to standard output").with_source(error))
}

/// Prints a report as a line of JSON.
///
/// # Errors
/// As [`print`]; `Internal` for a report that serde cannot serialise.
pub fn print_json(report: &impl Serialize) -> Result<()> {
    print(json_or_error(serde_json::to_string(report))?)
}

/// Prints a report as JSON over several lines.
///
/// # Errors
/// As [`print_json`].
pub fn print_pretty_json(report: &impl Serialize) -> Result<()> {
    print(json_or_error(serde_json::to_string_pretty(report))?)
}

fn json_or_error(json: serde_json::Result<String>) -> Result<String> {
    json.map_err(|error| Error::internal("the report cannot be written as JSON").with_source(error))
}
