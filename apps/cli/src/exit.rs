//! How the command ends.

use std::io;

use opendr::{Error, ErrorKind, Result};

use crate::progress_bar::interrupted;

/// What a command that ran to its end has to say.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Outcome {
    /// All went well: exit code 0.
    Done,
    /// Some inputs failed, and were reported; the rest is done: exit code 1.
    SomeFailed,
    /// The flags are none, which was told: exit code 2.
    #[cfg_attr(not(feature = "ros"), allow(dead_code))]
    WrongUsage,
}

/// The exit codes, for `--help`. Usage errors exit with 2 before anything is run.
pub const CODES: &str = "\
Exit codes: 0 done; 1 some inputs failed, the rest is done; 2 wrong usage; 11 InvalidInput, 12 InvalidParam,
13 NotFound, 14 Io, 15 Network, 16 Integrity, 17 Format, 18 Unsupported, 19 Device, 20 Internal; 130 Ctrl-C.";

const DONE: u8 = 0;
const SOME_FAILED: u8 = 1;
const WRONG_USAGE: u8 = 2;
/// Exit code of a command stopped by Ctrl-C, as shells have it.
const INTERRUPTED: u8 = 130;
/// Errors exit with this plus the number of their kind.
const ERRORS: u8 = 10;

/// Prints the error, once, and picks the exit code.
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

/// Whoever read the output has read enough (`| head`).
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
