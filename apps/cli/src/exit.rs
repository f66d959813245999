//! How the command ends.

use std::process::ExitCode;

use opendr::{Error, ErrorKind, Result};

use crate::progress_bar;

/// What a command that ran to its end has to say.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Outcome {
    /// All went well: exit code 0.
    Done,
    /// Some inputs failed, and were reported; the rest is done: exit code 1.
    SomeFailed,
}

/// Exit code of a command stopped by Ctrl-C, as shells have it.
const INTERRUPTED: u8 = 130;
/// Errors exit with this plus the number of their kind: 11 `InvalidInput`, 12 `InvalidParam`, ...
const ERRORS: u8 = 10;

/// Prints the error, once, and picks the exit code. Usage errors exit with 2 before that.
pub fn code_from(result: Result<Outcome>) -> ExitCode {
    if progress_bar::interrupted() {
        return ExitCode::from(INTERRUPTED);
    }
    match result {
        Ok(Outcome::Done) => ExitCode::SUCCESS,
        Ok(Outcome::SomeFailed) => ExitCode::FAILURE,
        Err(error) if is_closed_pipe(&error) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::from(ERRORS + error.kind() as u8)
        }
    }
}

/// Whoever read the output has read enough (`| head`).
fn is_closed_pipe(error: &Error) -> bool {
    use std::io;
    let source = std::error::Error::source(error).and_then(|source| source.downcast_ref::<io::Error>());
    error.kind() == ErrorKind::Io && source.is_some_and(|source| source.kind() == io::ErrorKind::BrokenPipe)
}
