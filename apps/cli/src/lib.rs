//! The `opendr` command: it knows types, never learners. A library, so that the Python package has the command too.

mod class_flags;
mod command;
mod dataset_flags;
mod environment_flags;
mod exit;
mod inputs;
mod item;
mod learner_flags;
mod loading;
mod named_value;
mod peak_memory;
mod port_file;
mod progress_bar;
mod progress_lines;
mod recorded_set;
#[cfg_attr(not(feature = "ros"), path = "recordings_absent.rs")]
mod recordings;
mod report;
mod stdout;
mod then_flag;
mod timings;
mod writer;

use std::ffi::OsString;

pub use progress_bar::Bar;

/// Runs the command that `arguments` are, the program's name first; its exit code.
pub fn run(arguments: impl IntoIterator<Item = OsString>) -> u8 {
    let arguments: Vec<OsString> = arguments.into_iter().collect();
    let grammar = match command::grammar(&arguments) {
        Ok(grammar) => grammar,
        Err(error) => return exit::code_from(Err(error)),
    };
    match grammar.try_get_matches_from(&arguments) {
        Ok(matches) => exit::code_from(command::run(&matches)),
        Err(error) => {
            // Printing fails only when nobody reads.
            error.print().ok();
            error.exit_code() as u8
        }
    }
}
