//! Hyperband.

use opendr_engine::{Error, Random, Result};

use crate::pruner::{Advice, Asha, Pruner};
use crate::records::{StudyRecord, TrialRecord};

/// Successive halving with several first rungs side by side, against configurations that only show late how good they are
/// (Li et al. 2018, "Hyperband"). Each trial belongs to one bracket by its number, and is compared with those of its own
/// only; brackets with early rungs have more trials, so that each costs about the same.
#[derive(Debug, Clone)]
pub struct Hyperband {
    brackets: Vec<Asha>,
    /// How many of so many trials belong to each.
    shares: Vec<usize>,
}

impl Hyperband {
    /// First rungs at `first`, `first * factor`, ... steps, as far as `last`, the steps of a whole trial.
    ///
    /// # Errors
    /// `InvalidParam` when `first` is below 1, `factor` below 2 or `last` below `first`.
    pub fn new(first: i64, last: i64, factor: i64) -> Result<Self> {
        let asha = Asha::new(first, factor)?;
        if last < first {
            return Err(Error::invalid_param(format!(
                "the last step {last} lies before the first rung {first}"
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

    /// The bracket of a trial.
    pub fn bracket(&self, number: usize) -> usize {
        let mut at = Random::at([number as u64]).below(self.shares.iter().sum());
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
            // Rungs of later brackets stand higher.
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
