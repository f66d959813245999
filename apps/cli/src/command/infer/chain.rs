//! `--then`: a pipeline of learners, each on its own thread.

use clap::ArgMatches;
use opendr::{Error, Pipeline, Result};

use super::job::{InferenceResult, Job, Stream, of_item};
use crate::item::Next;
use crate::timings::Timings;

/// Refuses flags that apply to a single learner only.
///
/// # Errors
/// `InvalidParam` for such a flag.
pub fn check(matches: &ArgMatches, recorded: bool) -> Result<()> {
    if recorded {
        return Err(Error::invalid_param(
            "predictions of a pipeline cannot be recorded; write them with --json=FILE",
        ));
    }
    if matches.contains_id("dump") {
        return Err(Error::invalid_param(
            "--dump writes the tensors of a single learner and cannot be combined with --then; dump each learner on its own",
        ));
    }
    if matches.get_flag("show-timings") {
        return Err(Error::invalid_param(
            "--show-timings measures a single learner and cannot be combined with --then, whose learners run in parallel; omit one of them",
        ));
    }
    Ok(())
}

/// Runs the pipeline over the items and reports the results in order.
pub fn run(
    job: &Job,
    pipeline: &mut Pipeline,
    stream: &mut Stream,
    items: impl Iterator<Item = Next>,
    mut report: impl FnMut(InferenceResult) -> Result<()>,
) -> Result<()> {
    // Each item contains a reference to the job, from which its ports borrow.
    let items = items.map(|item| item.map(|item| (job, job.follow(stream, &item), item)));
    pipeline.run(
        items,
        |item| matches!(item, Ok((_, true, _))),
        |item| match item {
            Ok((job, begins, item)) => job.ports(item, *begins),
            // The closure below reports the item's own error.
            Err(_) => Err(Error::invalid_input("unreadable")),
        },
        |item, outputs| {
            report(match (item, outputs) {
                (Err(failure), _) => Err(failure),
                (Ok((_, _, item)), Ok(outputs)) => Ok((item, vec![outputs], Timings::default())),
                (Ok((_, _, item)), Err(error)) => Err(of_item(&item, error)),
            })
        },
    )
}
