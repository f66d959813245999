//! `--then`: further learners of a pipeline.

use clap::{Arg, ArgAction, ArgMatches};
use opendr::learner::{AnyLearner, Entry};
use opendr::params::ParamMap;
use opendr::{Error, Pipeline, Progress, Result};

use crate::{loading, named_value};

/// Id of the flag.
const THEN: &str = "then";
/// Word before a learner that runs on each detected box.
const EACH: &str = "each";

/// Returns the flag.
pub fn flag() -> Arg {
    Arg::new(THEN)
        .long(THEN)
        .action(ArgAction::Append)
        .value_name("[each] LEARNER[/VARIANT] [NAME=VALUE]...")
        .help("Append a learner to the pipeline, whose inputs are the predictions of those before it (after the word each: every detected box, one by one); may be repeated")
}

/// Returns whether the command has a pipeline.
pub fn is_given(matches: &ArgMatches) -> bool {
    matches.contains_id(THEN)
}

/// A learner named by the flag.
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
        let spec = words
            .next()
            .ok_or_else(|| Error::invalid_param("--then names no learner; write --then LEARNER"))?;
        let entry = loading::entry(spec)?;
        let params = words.map(|word| named_value::parse(THEN, word, entry.spec.class, entry.params));
        Ok(Self { spec, entry, each, params: params.collect::<Result<_>>()? })
    }
}

fn named(matches: &ArgMatches) -> Result<Vec<Named<'_>>> {
    matches.get_many::<String>(THEN).into_iter().flatten().map(|text| Named::parse(text)).collect()
}

/// Returns the last learner of the pipeline.
///
/// # Errors
/// `NotFound` for an unknown learner; `InvalidParam` for a wrong parameter.
pub fn last(entry: &'static Entry, matches: &ArgMatches) -> Result<&'static Entry> {
    Ok(named(matches)?.last().map_or(entry, |named| named.entry))
}

/// Returns the names of all learners for a report, and the set parameters; those of further learners have the learner's name as
/// prefix.
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

/// Builds the pipeline of the command's learner and those of `--then`.
///
/// # Errors
/// As [`last`] and [`Pipeline::then`], and the error of a model that cannot be downloaded or loaded.
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
