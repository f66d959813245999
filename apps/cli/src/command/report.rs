//! `opendr report`: prints the report of an evaluation or a training that was written earlier.

use std::path::{Path, PathBuf};

use clap::{Arg, ArgMatches, Command, value_parser};
use opendr::evaluation::Outcome as Evaluated;
use opendr::{ErrorKind, Fitted, Result};

use crate::exit::Outcome;
use crate::stdout;

const EXAMPLES: &str = "\
Examples:
  opendr report evaluated/                 the table of an evaluation
  opendr report runs/nanodet/report.json   the table of a training";

pub fn grammar() -> Command {
    Command::new("report")
        .about("Print the report of an earlier evaluation or training")
        .arg(
            Arg::new("report")
                .required(true)
                .value_name("PATH")
                .value_parser(value_parser!(PathBuf))
                .help("report.json, or the folder that contains it"),
        )
        .after_help(EXAMPLES)
}

pub fn run(matches: &ArgMatches) -> Result<Outcome> {
    let path = matches.get_one::<PathBuf>("report").cloned().unwrap_or_default();
    let path = if path.is_dir() { path.join("report.json") } else { path };
    stdout::print(text(&path)?.trim_end())?;
    Ok(Outcome::Done)
}

/// Returns the table of a report of either kind. The reports differ in their required keys.
fn text(path: &Path) -> Result<String> {
    match Evaluated::read(path) {
        Ok(evaluated) => Ok(evaluated.to_string()),
        Err(error) if error.kind() == ErrorKind::Format => match Fitted::read(path) {
            Ok(fitted) => Ok(fitted.to_string()),
            Err(_) => Err(error),
        },
        Err(error) => Err(error),
    }
}
