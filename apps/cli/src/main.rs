//! The `opendr` command: it knows types, never learners.

mod command;
mod exit;
mod learner_flags;
mod loading;
mod progress_bar;
mod record;
mod timings;
mod writer;

use std::ffi::OsString;
use std::process::ExitCode;

fn main() -> ExitCode {
    let arguments: Vec<OsString> = std::env::args_os().collect();
    let matches = match command::grammar(&arguments).try_get_matches_from(&arguments) {
        Ok(matches) => matches,
        Err(error) => {
            // Printing fails only when nobody reads.
            error.print().ok();
            return ExitCode::from(error.exit_code() as u8);
        }
    };
    exit::code_from(command::run(&matches))
}
