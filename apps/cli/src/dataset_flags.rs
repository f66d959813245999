//! Flags of the commands that read a data set.

use std::path::PathBuf;

use clap::{Arg, ArgAction, ArgMatches, value_parser};
use opendr::Result;
use opendr::dataset::ExternalDataset;
use opendr::datasets::Problems;
use serde_json::{Value as Json, json};

use crate::stdout;

/// Id of the argument that names the data set.
pub const DATASET: &str = "dataset";
/// Maximum number of problems in the text output; JSON contains more.
const MOST_PRINTED: usize = 20;

/// Returns the argument that names the data set.
pub fn dataset() -> Arg {
    Arg::new(DATASET)
        .required(true)
        .value_name("DATASET")
        .value_parser(value_parser!(PathBuf))
        .help("Folder or file of the data set")
}

/// Returns the flags of format, split and broken samples.
pub fn flags() -> [Arg; 3] {
    [
        Arg::new("format")
            .long("format")
            .default_value("auto")
            .value_name("FORMAT")
            .help("Format of the data set (see \"opendr data formats\"); by default detected"),
        Arg::new("split")
            .long("split")
            .value_name("NAME")
            .help("Split to read: val2017, train, testing, ..."),
        skip_broken_flag(),
    ]
}

/// Returns the flag that skips broken samples.
pub fn skip_broken_flag() -> Arg {
    Arg::new("skip-broken")
        .long("skip-broken")
        .action(ArgAction::SetTrue)
        .help("Skip and list broken samples instead of ending with the first")
}

/// Returns the data set that the user named.
pub fn external(matches: &ArgMatches) -> ExternalDataset {
    let path = matches.get_one::<PathBuf>(DATASET).cloned().unwrap_or_default();
    ExternalDataset::new(path, matches.get_one::<String>("format").cloned().unwrap_or_default())
}

/// Returns the description of the data set for a cluster: its absolute path and its format.
pub fn described(matches: &ArgMatches) -> Json {
    let external = external(matches);
    let path = std::path::absolute(external.path()).unwrap_or_else(|_| external.path().to_owned());
    json!({ "path": path, "format": external.dataset_type() })
}

/// Returns the split that the user named.
pub fn split(matches: &ArgMatches) -> Option<String> {
    matches.get_one("split").cloned()
}

/// Returns whether broken samples are skipped.
pub fn skip_broken(matches: &ArgMatches) -> bool {
    matches.get_flag("skip-broken")
}

/// Returns the problem list of the command, which skips broken samples or fails at the first.
pub fn problems(matches: &ArgMatches) -> Problems {
    Problems::new(skip_broken(matches))
}

/// Prints the problems.
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
