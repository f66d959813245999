//! When a trial is not worth going on.

mod asha;
mod hyperband;
mod median;

use crate::records::{StudyRecord, TrialRecord};

pub use asha::Asha;
pub use hyperband::Hyperband;
pub use median::Median;

/// What to do with a trial after a report.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Advice {
    /// Go on.
    Continue,
    /// Keep the state and end here for now: answer [`Outcome::Paused`](crate::Outcome::Paused). Should the trial turn out to
    /// be among the best, it is asked for again, and goes on from that state.
    Pause,
    /// End here: answer [`Outcome::Pruned`](crate::Outcome::Pruned).
    Stop,
}

/// Judges trials by what they report on their way. All that a pruner knows is in the study's record.
pub trait Pruner: Send + Sync {
    /// What to do with `trial`, which has just reported.
    fn advice(&self, study: &StudyRecord, trial: &TrialRecord) -> Advice;

    /// The number of the paused trial that should go on next, if any should.
    fn promotable(&self, _study: &StudyRecord) -> Option<usize> {
        None
    }
}

/// Lets every trial end.
#[derive(Debug, Clone, Copy, Default)]
pub struct NoPruner;

impl Pruner for NoPruner {
    fn advice(&self, _: &StudyRecord, _: &TrialRecord) -> Advice {
        Advice::Continue
    }
}

#[cfg(test)]
mod tests;
