//! Flags for the matching of classes.

use std::collections::BTreeMap;

use clap::{Arg, ArgAction, ArgMatches};
use opendr::{Error, Result};

/// Returns the flags of class pairs and of matching by index.
pub fn flags() -> [Arg; 2] {
    [
        Arg::new("classes")
            .long("classes")
            .value_delimiter(',')
            .value_name("LEARNER=DATASET,...")
            .help("Map classes of the learner to classes of the data set, where their names differ"),
        Arg::new("by-number")
            .long("by-number")
            .action(ArgAction::SetTrue)
            .help("Match classes by index and ignore their names"),
    ]
}

/// Returns the pairs that the user set with the flag `flag`.
///
/// # Errors
/// `InvalidParam` for a malformed pair or a class that occurs twice.
pub fn pairs(flag: &str, matches: &ArgMatches) -> Result<BTreeMap<String, String>> {
    let mut pairs = BTreeMap::new();
    for text in matches.get_many::<String>(flag).into_iter().flatten() {
        let pair = text.split_once('=').map(|(one, other)| (one.trim(), other.trim()));
        let (one, other) =
            pair.filter(|(one, other)| !one.is_empty() && !other.is_empty()).ok_or_else(|| {
                Error::invalid_param(format!(
                    "--{flag} {text:?} is not a pair of classes; write LEARNER=DATASET"
                ))
            })?;
        if pairs.insert(one.to_owned(), other.to_owned()).is_some() {
            return Err(Error::invalid_param(format!("--{flag} has {one:?} twice; give it once")));
        }
    }
    Ok(pairs)
}
