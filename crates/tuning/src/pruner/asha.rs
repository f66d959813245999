//! Asynchronous successive halving.

use opendr_engine::{Error, Result};

use crate::pruner::{Advice, Pruner};
use crate::records::{StudyRecord, TrialRecord, TrialState};

/// Asynchronous successive halving (Li et al. 2020, "A system for massively parallel hyperparameter tuning").
///
/// Rungs are at `first`, `first * factor`, `first * factor^2`, ... steps. A trial that reaches a rung is paused unless it is
/// among the best 1 / `factor` of all that have reached it. As more trials reach the rung, paused ones may become part of the best; they
/// are then resumed, from the highest rung first, before any new trial starts. A trial completes at its last step, whatever the
/// advice.
#[derive(Debug, Clone, Copy)]
pub struct Asha {
    first: i64,
    factor: i64,
}

impl Asha {
    /// Creates a pruner with rungs at `first * factor^k` steps.
    ///
    /// # Errors
    /// `InvalidParam` when `first` is below 1 or `factor` below 2.
    pub fn new(first: i64, factor: i64) -> Result<Self> {
        if first < 1 || factor < 2 {
            return Err(Error::invalid_param(format!(
                "rungs at {first} * {factor}^k steps; give a first rung of 1 or more and a factor of 2 or more"
            )));
        }
        Ok(Self { first, factor })
    }

    /// Returns the same pruner without the first `rungs`.
    pub(crate) fn without_rungs(self, rungs: u32) -> Self {
        Self { first: self.rung(rungs), factor: self.factor }
    }

    /// Returns the step of a rung.
    fn rung(&self, number: u32) -> i64 {
        self.first.saturating_mul(self.factor.saturating_pow(number))
    }

    /// Returns the highest rung at or below `step`; `None` before the first.
    fn rung_at(&self, step: i64) -> Option<u32> {
        (0..63).take_while(|rung| self.rung(*rung) <= step && self.rung(*rung) < i64::MAX).last()
    }

    /// Returns the numbers of the trials that are among the best at a rung, of all that have reached it.
    pub(crate) fn best_at(
        &self,
        rung: u32,
        study: &StudyRecord,
        among: &dyn Fn(&TrialRecord) -> bool,
    ) -> Vec<usize> {
        let steps = self.rung(rung);
        let loss = |trial: &TrialRecord| {
            let (_, value) = trial.reports.range(steps..).next()?;
            Some((study.direction().loss(*value), trial.number))
        };
        let trials = study.trials.iter().filter(|trial| trial.state != TrialState::Failed && among(trial));
        let mut reached: Vec<_> = trials.filter_map(loss).collect();
        // Of equals the first, which has waited longest.
        reached.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        reached.truncate(reached.len() / self.factor as usize);
        reached.into_iter().map(|(_, number)| number).collect()
    }

    pub(crate) fn advice_among(
        &self,
        study: &StudyRecord,
        trial: &TrialRecord,
        among: &dyn Fn(&TrialRecord) -> bool,
    ) -> Advice {
        let mut steps = trial.reports.keys().rev().copied();
        let rung = steps.next().and_then(|step| self.rung_at(step));
        let before = steps.next().and_then(|step| self.rung_at(step));
        match rung {
            // Only the first report at or beyond a rung counts.
            Some(rung)
                if Some(rung) != before && !self.best_at(rung, study, among).contains(&trial.number) =>
            {
                Advice::Pause
            }
            _ => Advice::Continue,
        }
    }

    /// Returns the paused trial at the highest rung that is now among the best there.
    pub(crate) fn promotable_among(
        &self,
        study: &StudyRecord,
        among: &dyn Fn(&TrialRecord) -> bool,
    ) -> Option<(u32, usize)> {
        let stand = |trial: &TrialRecord| self.rung_at(trial.last_report()?.0);
        let paused = || study.trials.iter().filter(|trial| trial.is_paused() && among(trial));
        let highest = paused().filter_map(stand).max()?;
        (0..=highest).rev().find_map(|rung| {
            let best = self.best_at(rung, study, among);
            let here =
                |number: &usize| paused().any(|trial| trial.number == *number && stand(trial) == Some(rung));
            best.into_iter().find(here).map(|number| (rung, number))
        })
    }
}

impl Pruner for Asha {
    fn advice(&self, study: &StudyRecord, trial: &TrialRecord) -> Advice {
        self.advice_among(study, trial, &|_| true)
    }

    fn promotable(&self, study: &StudyRecord) -> Option<usize> {
        self.promotable_among(study, &|_| true).map(|(_, number)| number)
    }
}
