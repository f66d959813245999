//! Standard output, whose reader may have gone.

use std::fmt::Display;
use std::io::Write;

use opendr::{Error, Result};

/// Prints a line.
///
/// # Errors
/// `Io` with the cause as its source, so that [`crate::exit`] can tell a closed pipe from a full disk.
pub fn print(line: impl Display) -> Result<()> {
    let written = writeln!(std::io::stdout(), "{line}");
    written.map_err(|error| Error::io("writing to standard output").with_source(error))
}
