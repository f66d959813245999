//! Median pruning.

use crate::pruner::{Advice, Pruner};
use crate::records::{StudyRecord, TrialRecord};

/// Stops a trial whose best report is worse than the median of the complete trials' reports at the same step (Golovin et al.
/// 2017, "Google Vizier").
#[derive(Debug, Clone, Copy)]
pub struct Median {
    /// Number of complete trials before any trial is stopped.
    pub startup_trials: usize,
    /// Number of steps before a trial is stopped.
    pub warmup_steps: i64,
}

impl Default for Median {
    fn default() -> Self {
        Self { startup_trials: 5, warmup_steps: 0 }
    }
}

impl Pruner for Median {
    fn advice(&self, study: &StudyRecord, trial: &TrialRecord) -> Advice {
        let Some((step, _)) = trial.last_report() else { return Advice::Continue };
        if step < self.warmup_steps || study.complete().count() < self.startup_trials {
            return Advice::Continue;
        }
        let loss = |value: &f64| study.direction().loss(*value);
        let best = trial.reports.values().map(loss).fold(f64::INFINITY, f64::min);
        let mut others: Vec<f64> =
            study.complete().filter_map(|other| other.reports.get(&step)).map(loss).collect();
        others.retain(|loss| loss.is_finite());
        others.sort_by(f64::total_cmp);
        let Some(last) = others.len().checked_sub(1) else { return Advice::Continue };
        let median = (others[last / 2] + others[last.div_ceil(2)]) / 2.0;
        if best > median { Advice::Stop } else { Advice::Continue }
    }
}
