//! `--then`: learners one behind the other, each on a thread of its own.

use clap::ArgMatches;
use opendr::{Error, Pipeline, Result};

use super::{Answer, Job, Stream, of_item};
use crate::item::Next;
use crate::timings::Timings;

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
