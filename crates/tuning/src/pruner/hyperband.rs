//! Hyperband.

use opendr_engine::{Error, Random, Result};

use crate::pruner::{Advice, Asha, Pruner};
use crate::records::{StudyRecord, TrialRecord};

/// Successive halving with several first rungs in parallel, for configurations whose quality shows late
/// (Li et al. 2018, "Hyperband"). The number of a trial determines its bracket, and it is compared within that bracket
/// only; brackets with early rungs have more trials, so that all cost about the same.
#[derive(Debug, Clone)]
pub struct Hyperband {
    brackets: Vec<Asha>,
    /// Number of trials of each bracket in one cycle.
    shares: Vec<usize>,
}

impl Hyperband {
    /// Creates brackets with first rungs at `first`, `first * factor`, ... steps, up to `last`, the steps of a whole trial.
    ///
    /// # Errors
    /// `InvalidParam` when `first` is below 1, `factor` below 2 or `last` below `first`.
    pub fn new(first: i64, last: i64, factor: i64) -> Result<Self> {
        let asha = Asha::new(first, factor)?;
        if last < first {
            return Err(Error::invalid_param(format!(
                "the last step {last} is before the first rung {first}; give a larger one"
            )));
        }
        let count = std::iter::successors(Some(first), |steps| steps.checked_mul(factor))
            .take_while(|steps| *steps <= last)
            .count() as u32;
        let share = |bracket: u32| {
            let later = count - 1 - bracket;
            (u64::from(count) * (factor as u64).saturating_pow(later)).div_ceil(u64::from(later) + 1) as usize
        };
        let brackets = (0..count).map(|bracket| asha.without_rungs(bracket)).collect();
        Ok(Self { brackets, shares: (0..count).map(share).collect() })
    }

    /// Returns the bracket of a trial.
    pub fn bracket(&self, number: usize) -> usize {
        let mut at = Random::from_key([number as u64]).below(self.shares.iter().sum());
        let bracket = self.shares.iter().position(|share| {
            let here = at < *share;
            at = at.saturating_sub(*share);
            here
        });
        bracket.unwrap_or(0)
    }
}

impl Pruner for Hyperband {
    fn advice(&self, study: &StudyRecord, trial: &TrialRecord) -> Advice {
        let bracket = self.bracket(trial.number);
        let among = |other: &TrialRecord| self.bracket(other.number) == bracket;
        self.brackets[bracket].advice_among(study, trial, &among)
    }

    fn promotable(&self, study: &StudyRecord) -> Option<usize> {
        let promotable = |(bracket, asha): (usize, &Asha)| {
            let among = |trial: &TrialRecord| self.bracket(trial.number) == bracket;
            // Rungs of later brackets are at more steps.
            asha.promotable_among(study, &among).map(|(rung, number)| (rung as usize + bracket, number))
        };
        self.brackets
            .iter()
            .enumerate()
            .filter_map(promotable)
            .max_by_key(|(rung, _)| *rung)
            .map(|(_, number)| number)
    }
}
