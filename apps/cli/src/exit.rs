//! Exit codes.

use std::io;

use opendr::{Error, ErrorKind, Result};

use crate::progress_bar::interrupted;

/// Outcome of a command that ran to its end.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Outcome {
    /// Success: exit code 0.
    Done,
    /// Some inputs failed and were reported, the rest succeeded: exit code 1.
    SomeFailed,
    /// Wrong usage, already reported: exit code 2.
    #[cfg_attr(not(feature = "ros"), allow(dead_code))]
    WrongUsage,
}

/// Exit codes, as text for `--help`. Usage errors exit with 2 before anything runs.
pub const CODES: &str = "\
Exit codes: 0 success; 1 some inputs failed, the rest succeeded; 2 wrong usage; 11 InvalidInput, 12 InvalidParam,
13 NotFound, 14 Io, 15 Network, 16 Integrity, 17 Format, 18 Unsupported, 19 Device, 20 Internal; 130 Ctrl-C.";

const DONE: u8 = 0;
const SOME_FAILED: u8 = 1;
const WRONG_USAGE: u8 = 2;
/// Exit code of a command stopped by Ctrl-C, as in shells.
const INTERRUPTED: u8 = 130;
/// Exit code of an error, less the number of its kind.
const ERRORS: u8 = 10;

/// Prints the error, if there is one, and returns the exit code.
pub fn code_from(result: Result<Outcome>) -> u8 {
    match result {
        Err(error) if is_closed_pipe(&error) => DONE,
        _ if interrupted() => INTERRUPTED,
        Ok(Outcome::Done) => DONE,
        Ok(Outcome::SomeFailed) => SOME_FAILED,
        Ok(Outcome::WrongUsage) => WRONG_USAGE,
        Err(error) => {
            eprintln!("error: {error}");
            ERRORS + error.kind() as u8
        }
    }
}

/// Returns whether the reader closed the pipe (`| head`).
fn is_closed_pipe(error: &Error) -> bool {
    let source = std::error::Error::source(error).and_then(|source| source.downcast_ref::<io::Error>());
    error.kind() == ErrorKind::Io && source.is_some_and(|source| source.kind() == io::ErrorKind::BrokenPipe)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn help_lists_the_code_of_every_kind() {
        for kind in [
            ErrorKind::InvalidInput,
            ErrorKind::InvalidParam,
            ErrorKind::NotFound,
            ErrorKind::Io,
            ErrorKind::Network,
            ErrorKind::Integrity,
            ErrorKind::Format,
            ErrorKind::Unsupported,
            ErrorKind::Device,
            ErrorKind::Internal,
        ] {
            let listed = format!("{} {kind}", ERRORS + kind as u8);
            assert!(CODES.contains(&listed), "{listed}");
        }
    }
}
