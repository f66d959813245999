//! The flags of every command that reads a data set.

use std::path::PathBuf;

use clap::{Arg, ArgAction, ArgMatches, value_parser};
use opendr::Result;
use opendr::dataset::ExternalDataset;
use opendr::datasets::Problems;

use crate::stdout;

/// The id of the argument that names the data set.
pub const DATASET: &str = "dataset";
/// Problems that are printed; the JSON has more.
const MOST_PRINTED: usize = 20;

/// The argument that names the data set.
pub fn dataset() -> Arg {
    Arg::new(DATASET)
        .required(true)
        .value_name("DATASET")
        .value_parser(value_parser!(PathBuf))
        .help("Its folder or file")
}

/// Format, part, and what to do with what is broken.
pub fn flags() -> [Arg; 3] {
    [
        Arg::new("format")
            .long("format")
            .default_value("auto")
            .value_name("FORMAT")
            .help("What it is (\"opendr data formats\" lists them); by default recognised"),
        Arg::new("split")
            .long("split")
            .value_name("NAME")
            .help("The part to read: val2017, train, testing, ..."),
        skip_broken_flag(),
    ]
}

/// What to do with what is broken.
pub fn skip_broken_flag() -> Arg {
    Arg::new("skip-broken")
        .long("skip-broken")
        .action(ArgAction::SetTrue)
        .help("Leave out what is broken, and list it, instead of ending with the first")
}

/// The data set that the user named.
pub fn external(matches: &ArgMatches) -> ExternalDataset {
    let path = matches.get_one::<PathBuf>(DATASET).cloned().unwrap_or_default();
    ExternalDataset::new(path, matches.get_one::<String>("format").cloned().unwrap_or_default())
}

/// The part that the user named.
pub fn split(matches: &ArgMatches) -> Option<String> {
    matches.get_one("split").cloned()
}

/// Whether what is broken is left out.
pub fn skip_broken(matches: &ArgMatches) -> bool {
    matches.get_flag("skip-broken")
}

/// What is to be done with what is broken.
pub fn problems(matches: &ArgMatches) -> Problems {
    if skip_broken(matches) { Problems::skipping() } else { Problems::strict() }
}

/// Prints what was broken.
///
/// # Errors
/// `Io` when standard output cannot be written.
pub fn print_problems(problems: &Problems) -> Result<()> {
    let list = problems.list();
    list.iter().take(MOST_PRINTED).try_for_each(stdout::print)?;
    match problems.count().saturating_sub(MOST_PRINTED as u64) {
        0 => Ok(()),
        more => stdout::print(format_args!("... and {more} more")),
    }
}
