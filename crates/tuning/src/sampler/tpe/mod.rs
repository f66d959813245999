//! The tree-structured Parzen estimator.

mod parzen;

use opendr_engine::{Random, Result};

use crate::records::{StudyRecord, TrialRecord, TrialState, dominates};
use crate::sampler::axis::Axis;
use crate::sampler::{DrawnParameters, Sampler, stream};
use crate::space::Parameter;
use parzen::Mixture;

/// Number of random trials before the model is used.
const STARTUP: usize = 10;
const CANDIDATES: usize = 24;
/// Maximum number of good trials.
const MAX_GOOD: usize = 25;

/// The tree-structured Parzen estimator (Bergstra et al. 2011), multivariate, with the rules of Optuna 5's default.
///
/// The best tenth of the finished trials, at most 25, are good, all others bad. Pruned and paused trials rank after
/// complete ones, by their progress; running ones are bad, so that workers do not all try the same (constant
/// liar). Each set is a mixture of kernels over all parameters that are active together. Of 24 candidates drawn from the
/// good mixture, the one with the highest ratio of good to bad density is taken.
///
/// With several directions, trials are ranked by non-domination, and within a rank by crowding distance
/// (Deb et al. 2002).
#[derive(Debug, Clone, Copy)]
pub struct Tpe {
    seed: u64,
}

impl Tpe {
    /// Creates the sampler.
    pub fn new(seed: u64) -> Self {
        Self { seed }
    }
}

impl Sampler for Tpe {
    fn draw(&self, study: &StudyRecord, number: usize, parameters: &[&Parameter]) -> Result<DrawnParameters> {
        let mut random = stream(self.seed, number, parameters);
        let axes: Vec<Axis> = parameters.iter().map(|parameter| Axis::new(&parameter.distribution)).collect();
        let others = study.trials.iter().filter(|trial| trial.number != number);
        let (finished, running): (Vec<_>, Vec<_>) = others
            .filter(|trial| {
                trial.is_paused() || !matches!(trial.state, TrialState::Failed | TrialState::Waiting)
            })
            .partition(|trial| trial.state != TrialState::Running);
        let numbers = if finished.len() < STARTUP {
            axes.iter().map(|axis| axis.number_from_unit(random.unit())).collect()
        } else {
            let (good, bad) = split(study, finished, running);
            let mixture = |trials: &[&TrialRecord]| Mixture::new(&axes, &numbers_of(trials, parameters));
            best_candidate(&mixture(&good), &mixture(&bad), &mut random)
        };
        Ok(DrawnParameters { numbers, system_attributes: Vec::new() })
    }
}

/// Returns the candidate of the good mixture with the highest ratio of good to bad density.
fn best_candidate(good: &Mixture<'_>, bad: &Mixture<'_>, random: &mut Random) -> Vec<f64> {
    let mut best = (f64::NEG_INFINITY, Vec::new());
    for _ in 0..CANDIDATES {
        let candidate = good.draw(random);
        let gain = good.log_density(&candidate) - bad.log_density(&candidate);
        if gain > best.0 || best.1.is_empty() {
            best = (gain, candidate);
        }
    }
    best.1
}

/// Splits trials into good and bad ones, both ordered by number.
fn split<'a>(
    study: &StudyRecord,
    finished: Vec<&'a TrialRecord>,
    running: Vec<&'a TrialRecord>,
) -> (Vec<&'a TrialRecord>, Vec<&'a TrialRecord>) {
    let count = finished.len().div_ceil(10).min(MAX_GOOD);
    let (mut complete, mut others): (Vec<_>, Vec<_>) =
        finished.into_iter().partition(|trial| trial.state == TrialState::Complete);
    match study.directions.len() {
        1 => complete.sort_by(|a, b| {
            study.losses(a).partial_cmp(&study.losses(b)).unwrap_or(std::cmp::Ordering::Equal)
        }),
        _ => sort_by_rank(study, &mut complete),
    }
    others.sort_by(|a, b| {
        let (a, b) = (progress(study, a), progress(study, b));
        a.0.cmp(&b.0).then(a.1.total_cmp(&b.1))
    });
    complete.append(&mut others);
    let mut bad = complete.split_off(count.min(complete.len()));
    let mut good = complete;
    bad.extend(running);
    good.sort_by_key(|trial| trial.number);
    bad.sort_by_key(|trial| trial.number);
    (good, bad)
}

/// Sort key of a pruned or paused trial: its last step, farthest first, then its value there.
fn progress(study: &StudyRecord, trial: &TrialRecord) -> (i64, f64) {
    trial
        .last_report()
        .map_or((1, 0.0), |(step, value)| (step.saturating_neg(), study.direction().loss(value)))
}

/// Sorts by non-domination rank; within a rank, by crowding distance, largest first.
fn sort_by_rank(study: &StudyRecord, trials: &mut Vec<&TrialRecord>) {
    let mut sorted = Vec::with_capacity(trials.len());
    while !trials.is_empty() {
        let losses: Vec<_> = trials.iter().map(|trial| study.losses(trial)).collect();
        let mut front = Vec::new();
        let mut rest = Vec::new();
        for (trial, own) in trials.iter().zip(&losses) {
            let dominated = losses.iter().any(|other| dominates(other, own));
            if dominated { rest.push(*trial) } else { front.push((*trial, own.clone())) }
        }
        let mut crowded: Vec<_> = front.iter().map(|(trial, own)| (crowding(own, &front), *trial)).collect();
        crowded.sort_by(|a, b| b.0.total_cmp(&a.0));
        sorted.extend(crowded.into_iter().map(|(_, trial)| trial));
        *trials = rest;
    }
    *trials = sorted;
}

/// Returns the crowding distance of Deb et al. (2002): the gap between the neighbours, summed over the objectives.
fn crowding(own: &[f64], front: &[(&TrialRecord, Vec<f64>)]) -> f64 {
    let gap = |axis: usize| {
        let values = || front.iter().filter_map(move |(_, losses)| losses.get(axis).copied());
        let below = values().filter(|value| *value < own[axis]).fold(f64::NEG_INFINITY, f64::max);
        let above = values().filter(|value| *value > own[axis]).fold(f64::INFINITY, f64::min);
        let (least, most) =
            (values().fold(f64::INFINITY, f64::min), values().fold(f64::NEG_INFINITY, f64::max));
        if most > least { (above - below) / (most - least) } else { 0.0 }
    };
    (0..own.len()).map(gap).sum()
}

/// Returns the numbers of the trials that have all `parameters`.
fn numbers_of(trials: &[&TrialRecord], parameters: &[&Parameter]) -> Vec<Vec<f64>> {
    let number = |trial: &TrialRecord, parameter: &Parameter| {
        let suggestion = trial.params.get(&parameter.name)?;
        suggestion.distribution.is_compatible(&parameter.distribution).then_some(suggestion.number)
    };
    trials
        .iter()
        .filter_map(|trial| parameters.iter().map(|parameter| number(trial, parameter)).collect())
        .collect()
}

#[cfg(test)]
mod tests;
