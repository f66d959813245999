//! The `opendr` command: it knows types, never learners.

mod command;
mod exit;
mod learner_flags;
mod loading;
mod peak_memory;
mod port_file;
mod progress_bar;
mod progress_lines;
mod report;
mod stdout;
mod timings;
mod writer;

use std::ffi::OsString;
use std::process::ExitCode;

fn main() -> ExitCode {
    let arguments: Vec<OsString> = std::env::args_os().collect();
    let grammar = match command::grammar(&arguments) {
        Ok(grammar) => grammar,
        Err(error) => return exit::code_from(Err(error)),
    };
    match grammar.try_get_matches_from(&arguments) {
        Ok(matches) => exit::code_from(command::run(&matches)),
        Err(error) => {
            // Printing fails only when nobody reads.
            error.print().ok();
            ExitCode::from(error.exit_code() as u8)
        }
    }
}
