//! `--then`: learners behind the learner of a command.

use clap::{Arg, ArgAction, ArgMatches};
use opendr::learner::{AnyLearner, Entry};
use opendr::params::ParamMap;
use opendr::{Error, Pipeline, Progress, Result};

use crate::{loading, named_value};

/// The id of the flag.
const THEN: &str = "then";
/// The word before a learner that takes each box found before it.
const EACH: &str = "each";

/// The flag.
pub fn flag() -> Arg {
    Arg::new(THEN)
        .long(THEN)
        .action(ArgAction::Append)
        .value_name("[each] LEARNER[/VARIANT] [NAME=VALUE]...")
        .help("A learner behind it, which takes what those before it predict (after the word each: each box that they found, one by one); again for one more")
}

/// Whether there is a learner behind the first.
pub fn is_given(matches: &ArgMatches) -> bool {
    matches.contains_id(THEN)
}

/// A learner that the flag names.
struct Named<'a> {
    spec: &'a str,
    entry: &'static Entry,
    each: bool,
    params: ParamMap,
}

impl<'a> Named<'a> {
    fn parse(text: &'a str) -> Result<Self> {
        let mut words = text.split_whitespace().peekable();
        let each = words.next_if_eq(&EACH).is_some();
        let spec = words.next().ok_or_else(|| Error::invalid_param("--then names no learner"))?;
        let entry = loading::entry(spec)?;
        let params = words.map(|word| named_value::parse(THEN, word, entry.spec.class, entry.params));
        Ok(Self { spec, entry, each, params: params.collect::<Result<_>>()? })
    }
}

fn named(matches: &ArgMatches) -> Result<Vec<Named<'_>>> {
    matches.get_many::<String>(THEN).into_iter().flatten().map(|text| Named::parse(text)).collect()
}

/// The learner at the end.
///
/// # Errors
/// `NotFound` for a learner that there is not; `InvalidParam` for a wrong parameter.
pub fn last(entry: &'static Entry, matches: &ArgMatches) -> Result<&'static Entry> {
    Ok(named(matches)?.last().map_or(entry, |named| named.entry))
}

/// The names of all learners, as a report has them, and the parameters that were set: those behind the first under their names.
///
/// # Errors
/// As [`last`].
pub fn describe(spec: &str, params: &ParamMap, matches: &ArgMatches) -> Result<(String, ParamMap)> {
    let (mut text, mut all) = (spec.to_owned(), params.clone());
    for Named { spec, entry, each, params } in named(matches)? {
        text += if each { " + each " } else { " + " };
        text += spec;
        all.extend(params.into_iter().map(|(name, value)| (format!("{}.{name}", entry.spec.name), value)));
    }
    Ok((text, all))
}

/// The learner of the command with those of `--then` behind it.
///
/// # Errors
/// As [`last`], for a model that cannot be had or loaded, and as [`Pipeline::then`].
pub fn pipeline(
    entry: &'static Entry,
    first: &dyn AnyLearner,
    matches: &ArgMatches,
    progress: &dyn Progress,
) -> Result<Pipeline> {
    let mut pipeline = Pipeline::default().then(entry, first)?;
    for Named { spec, entry, each, params } in named(matches)? {
        let learner = loading::load_pretrained(spec, &params, matches, progress)?;
        let learner = learner.as_ref();
        pipeline = if each { pipeline.then_each(entry, learner) } else { pipeline.then(entry, learner) }?;
    }
    Ok(pipeline)
}
