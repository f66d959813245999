//! Command line `opendr`: inference, training, evaluation and model management of every learner.
//!
//! Each subcommand is one file of `command`; the other modules hold what subcommands share, such as the flags of data sets and
//! the report of predictions. The command depends on data and target types, never on a learner: flags, ports and outputs come from
//! the registry in the crate `opendr`, where the algorithms are. The crate is a library so that the Python package installs the
//! same command. Begin with [`run`]:
//!
//! ```
//! use std::ffi::OsString;
//!
//! let arguments = ["opendr", "data", "formats"].map(OsString::from);
//! assert_eq!(opendr_cli::run(arguments), 0);
//! ```

mod class_flags;
mod cluster;
mod command;
mod curves;
mod dataset_flags;
mod dump;
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
mod report_file;
mod stdout;
mod then_flag;
mod timings;
mod viewed_environment;
mod viewing;
mod writer;

use std::ffi::OsString;

pub use cluster::set_cluster;
pub use progress_bar::{ProgressBar, interrupted};

/// Runs the command line `arguments`, of which the first is the program's name, and returns the exit code.
pub fn run(arguments: impl IntoIterator<Item = OsString>) -> u8 {
    let arguments: Vec<OsString> = arguments.into_iter().collect();
    let grammar = match command::grammar(&arguments) {
        Ok(grammar) => grammar,
        Err(error) => return exit::code_from(Err(error)),
    };
    match grammar.try_get_matches_from(&arguments) {
        Ok(matches) => exit::code_from(command::run(&matches)),
        Err(error) => {
            // Printing fails only when the output is closed.
            error.print().ok();
            error.exit_code() as u8
        }
    }
}
