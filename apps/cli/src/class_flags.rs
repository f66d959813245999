//! The flags of how classes are matched.

use std::collections::BTreeMap;

use clap::{Arg, ArgAction, ArgMatches};
use opendr::{Error, Result};

/// Pairs of classes, and whether numbers are compared.
pub fn flags() -> [Arg; 2] {
    [
        Arg::new("classes")
            .long("classes")
            .value_delimiter(',')
            .value_name("LEARNER=DATASET,...")
            .help("Which class of the learner is which of the data set, where their names do not match"),
        Arg::new("by-number")
            .long("by-number")
            .action(ArgAction::SetTrue)
            .help("Compare the numbers of classes, whatever their names are"),
    ]
}

/// The pairs that the user gave with the flag `flag`.
///
/// # Errors
/// `InvalidParam` for what is no pair, and for a class that is given twice.
pub fn pairs(flag: &str, matches: &ArgMatches) -> Result<BTreeMap<String, String>> {
    let mut pairs = BTreeMap::new();
    for text in matches.get_many::<String>(flag).into_iter().flatten() {
        let pair = text.split_once('=').map(|(one, other)| (one.trim(), other.trim()));
        let (one, other) =
            pair.filter(|(one, other)| !one.is_empty() && !other.is_empty()).ok_or_else(|| {
                Error::invalid_param(format!(
                    "--{flag} {text:?} is no pair of classes; write LEARNER=DATASET"
                ))
            })?;
        if pairs.insert(one.to_owned(), other.to_owned()).is_some() {
            return Err(Error::invalid_param(format!("--{flag} has {one:?} twice; give it once")));
        }
    }
    Ok(pairs)
}
