//! Standard output, with closed pipes distinguished from other errors.

use std::fmt::Display;
use std::io::Write;

use opendr::{Error, JsonFormat, Result};
use serde::Serialize;

/// Prints a line.
///
/// # Errors
/// `Io` with the cause as its source, so that [`crate::exit`] can distinguish a closed pipe from a full disk.
pub fn print(line: impl Display) -> Result<()> {
    let written = writeln!(std::io::stdout(), "{line}");
    written.map_err(|error| Error::io("writing to standard output").with_source(error))
}

/// Prints a report with the version of its format as a line of JSON.
///
/// # Errors
/// As [`print`]; `Internal` for a report that does not serialise as an object.
pub fn print_json(format: JsonFormat, report: &impl Serialize) -> Result<()> {
    print(format.to_json(report)?)
}

/// Prints a report as JSON over several lines.
///
/// # Errors
/// As [`print_json`].
pub fn print_pretty_json(format: JsonFormat, report: &impl Serialize) -> Result<()> {
    print(format.to_pretty_json(report)?.trim_end())
}
