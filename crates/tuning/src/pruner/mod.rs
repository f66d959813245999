//! Pruners: early stopping of unpromising trials.

mod asha;
mod hyperband;
mod median;

use crate::records::{StudyRecord, TrialRecord};

pub use asha::Asha;
pub use hyperband::Hyperband;
pub use median::Median;

/// A pruner's decision after a report.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Advice {
    /// Continue the trial.
    Continue,
    /// Save the state and return [`Outcome::Paused`](crate::Outcome::Paused). If the trial later turns out to
    /// be among the best, it is resumed from that state.
    Pause,
    /// End the trial: return [`Outcome::Pruned`](crate::Outcome::Pruned).
    Stop,
}

/// Decides about trials from their intermediate reports. A pruner has no state besides the study's record.
pub trait Pruner: Send + Sync {
    /// Returns the decision about `trial`, which has just reported.
    fn advice(&self, study: &StudyRecord, trial: &TrialRecord) -> Advice;

    /// Returns the number of the paused trial to resume next, if any.
    fn promotable(&self, _study: &StudyRecord) -> Option<usize> {
        None
    }
}

/// Stops no trial.
#[derive(Debug, Clone, Copy, Default)]
pub struct NoPruner;

impl Pruner for NoPruner {
    fn advice(&self, _: &StudyRecord, _: &TrialRecord) -> Advice {
        Advice::Continue
    }
}

#[cfg(test)]
mod tests;
