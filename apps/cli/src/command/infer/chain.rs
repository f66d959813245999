//! `--then`: learners one behind the other, each on a thread of its own.

use clap::ArgMatches;
use opendr::learner::{AnyLearner, Entry};
use opendr::params::ParamMap;
use opendr::{Error, Pipeline, Progress, Result};

use super::{Answer, Job, Stream, of_item};
use crate::inputs::Next;
use crate::timings::Timings;
use crate::{loading, named_value};

/// Refuses flags that belong to a single learner.
///
/// # Errors
/// `InvalidParam` where one is given.
pub fn check(matches: &ArgMatches, recorded: bool) -> Result<()> {
    if recorded {
        return Err(Error::invalid_param(
            "answers of learners behind each other are not recorded; write them by --json=FILE",
        ));
    }
    if matches.get_flag("show-timings") {
        return Err(Error::invalid_param(
            "--show-timings measures one learner: with --then, they work at the same time; leave one of both out",
        ));
    }
    Ok(())
}

/// The word before a learner that looks at each box found before it.
const EACH: &str = "each";

/// The learner of the command with those of `--then` behind it.
///
/// # Errors
/// As for the first learner, and as [`Pipeline::then`].
pub fn pipeline(
    entry: &'static Entry,
    first: Box<dyn AnyLearner>,
    matches: &ArgMatches,
    progress: &dyn Progress,
) -> Result<Pipeline> {
    let mut pipeline = Pipeline::default().then(entry, first)?;
    for text in matches.get_many::<String>("then").into_iter().flatten() {
        let mut words = text.split_whitespace().peekable();
        let each = words.next_if_eq(&EACH).is_some();
        let spec = words.next().ok_or_else(|| Error::invalid_param("--then names no learner"))?;
        let entry = loading::entry(spec)?;
        let params = words.map(|word| named_value::parse("then", word, entry.spec.class, entry.params));
        let params = params.collect::<Result<ParamMap>>()?;
        let learner = loading::load_pretrained(spec, &params, matches, progress)?;
        pipeline = if each { pipeline.then_each(entry, learner) } else { pipeline.then(entry, learner) }?;
    }
    Ok(pipeline)
}

/// Answers items in their order.
pub fn run(
    job: &Job,
    pipeline: &mut Pipeline,
    stream: &mut Stream,
    items: impl Iterator<Item = Next>,
    mut tell: impl FnMut(Answer) -> Result<()>,
) -> Result<()> {
    // The job goes along, so that what an item's ports borrow from it lives as long as the item.
    let items = items.map(|item| item.map(|item| (job, job.follow(stream, &item), item)));
    pipeline.run(
        items,
        |item| matches!(item, Ok((_, true, _))),
        |item| match item {
            Ok((job, begins, item)) => job.ports(item, *begins),
            // It is told as what it is below.
            Err(_) => Err(Error::invalid_input("unreadable")),
        },
        |item, outputs| {
            tell(match (item, outputs) {
                (Err(failure), _) => Err(failure),
                (Ok((_, _, item)), Ok(outputs)) => Ok((item, vec![outputs], Timings::default())),
                (Ok((_, _, item)), Err(error)) => Err(of_item(&item, error)),
            })
        },
    )
}
