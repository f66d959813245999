//! Importance of hyperparameters.

use std::collections::BTreeMap;

use crate::Distribution;
use crate::normal::mass;
use crate::records::{StudyRecord, TrialRecord};

/// Fraction of the trials that count as good.
const GOOD: f64 = 0.1;
/// Maximum number of cells of a grid.
const CELLS: usize = 50;
/// Minimum kernel width in cells; 1.64 times it holds 90 % of a kernel.
const MIN_WIDTH: f64 = 0.5 / 1.64;

/// Returns the importance of each parameter for being among the best tenth, highest first, with sum 1: PED-ANOVA (Watanabe
/// et al. 2023), Optuna 5's default, with its rule for conditional parameters. With several directions the
/// first counts. All are 0 with fewer than two complete trials.
pub fn importance_from_study(study: &StudyRecord) -> Vec<(String, f64)> {
    let finite = |trial: &&TrialRecord| trial.values.iter().all(|value| value.is_finite());
    let all: Vec<&TrialRecord> = study.complete().filter(finite).collect();
    let loss = |trial: &TrialRecord| study.losses(trial).first().copied().unwrap_or(f64::INFINITY);
    let mut losses: Vec<f64> = all.iter().map(|trial| loss(trial)).collect();
    losses.sort_by(f64::total_cmp);
    let cut = losses.get(((GOOD * losses.len() as f64).ceil() as usize).saturating_sub(1)).copied();
    let good = |trial: &TrialRecord| cut.is_some_and(|cut| loss(trial) <= cut);
    let mut shares: BTreeMap<&str, f64> =
        all.iter().flat_map(|trial| trial.params.keys()).map(|name| (name.as_str(), 0.0)).collect();
    let goods = all.iter().filter(|trial| good(trial)).count();
    if all.len() > 1 {
        for (name, share) in &mut shares {
            for (distribution, trials) in regimes(&all, name) {
                let best: Vec<&TrialRecord> = trials.iter().copied().filter(|trial| good(trial)).collect();
                if trials.len() < 2 || best.is_empty() || distribution.is_single() {
                    continue;
                }
                let (of_good, of_all) =
                    (best.len() as f64 / goods as f64, trials.len() as f64 / all.len() as f64);
                let number =
                    |trial: &&TrialRecord| trial.params.get(*name).map(|suggestion| suggestion.number);
                let divergence = divergence(
                    &densities(distribution, &best.iter().filter_map(number).collect::<Vec<_>>()),
                    &densities(distribution, &trials.iter().filter_map(number).collect::<Vec<_>>()),
                );
                *share += of_good * of_good / of_all * divergence;
            }
        }
    }
    let sum: f64 = shares.values().sum();
    let mut shares: Vec<_> = shares
        .into_iter()
        .map(|(name, share)| (name.to_owned(), if sum > 0.0 { share / sum } else { 0.0 }))
        .collect();
    shares.sort_by(|a, b| b.1.total_cmp(&a.1));
    shares
}

/// Groups the trials that have a parameter by its distribution.
fn regimes<'a>(trials: &[&'a TrialRecord], name: &str) -> Vec<(&'a Distribution, Vec<&'a TrialRecord>)> {
    let mut regimes: Vec<(&Distribution, Vec<&TrialRecord>)> = Vec::new();
    for trial in trials {
        let Some(suggestion) = trial.params.get(name) else { continue };
        match regimes.iter_mut().find(|(known, _)| **known == suggestion.distribution) {
            Some((_, members)) => members.push(trial),
            None => regimes.push((&suggestion.distribution, vec![trial])),
        }
    }
    regimes
}

/// Returns Pearson's divergence of two densities on one grid.
fn divergence(good: &[f64], all: &[f64]) -> f64 {
    good.iter().zip(all).map(|(good, all)| all * (good / all - 1.0).powi(2)).sum()
}

/// Returns the probability of each cell of a distribution's grid given these numbers; never 0.
fn densities(distribution: &Distribution, numbers: &[f64]) -> Vec<f64> {
    let (cells, places): (usize, Vec<usize>) = match distribution {
        Distribution::Categorical { choices } => {
            (choices.len(), numbers.iter().map(|number| *number as usize).collect())
        }
        Distribution::Float { low, high, log, step } => {
            let steps = step.map_or(CELLS, |step| (((high - low) / step).round() as usize + 1).min(CELLS));
            on_grid(*low, *high, *log, steps, numbers)
        }
        Distribution::Int { low, high, log, step } => {
            let (low, high) = (*low as f64, *high as f64);
            let steps = match log {
                true => (high - low + 1.0).log2().ceil() as usize + 1,
                false => ((high - low) / *step as f64).round() as usize + 1,
            };
            on_grid(low, high, *log, steps.min(CELLS), numbers)
        }
    };
    let mut counts = vec![0.0; cells];
    for place in places {
        if let Some(count) = counts.get_mut(place) {
            *count += 1.0;
        }
    }
    let kernels: Vec<(usize, f64)> =
        counts.iter().copied().enumerate().filter(|(_, count)| *count > 0.0).collect();
    let total = 1.0 + kernels.iter().map(|(_, count)| count).sum::<f64>();
    let kernel = match distribution {
        Distribution::Categorical { .. } => choice_kernels(cells, &kernels),
        _ => normal_kernels(cells, &kernels),
    };
    let weighted = |cell: usize| {
        let own: f64 = kernels.iter().enumerate().map(|(at, (_, count))| count * kernel(at, cell)).sum();
        (own + kernel(kernels.len(), cell)) / total + 1e-12
    };
    (0..cells).map(weighted).collect()
}

/// Returns the number of cells from `low` to `high`, and the cells of the numbers.
fn on_grid(low: f64, high: f64, log: bool, cells: usize, numbers: &[f64]) -> (usize, Vec<usize>) {
    let scaled = |number: f64| if log { number.ln() } else { number };
    let width = (scaled(high) - scaled(low)) / (cells.max(2) - 1) as f64;
    let cell = |number: &f64| {
        let place = ((scaled(*number) - scaled(low)) / width - 0.5).ceil();
        place.clamp(0.0, cells as f64 - 1.0) as usize
    };
    (cells, numbers.iter().map(cell).collect())
}

/// Returns kernels of choices as probabilities; the last kernel is uniform.
fn choice_kernels(cells: usize, kernels: &[(usize, f64)]) -> Box<dyn Fn(usize, usize) -> f64> {
    let chosen: Vec<usize> = kernels.iter().map(|(cell, _)| *cell).collect();
    let rest = 1.0 / (chosen.len() + 1) as f64;
    let sum = 1.0 + rest * cells as f64;
    Box::new(move |kernel, cell| match chosen.get(kernel) {
        Some(own) => (rest + if *own == cell { 1.0 } else { 0.0 }) / sum,
        None => 1.0 / cells as f64,
    })
}

/// Returns normal kernels with Scott's bandwidth, integrated over bins; the last is as wide as the grid.
fn normal_kernels(cells: usize, kernels: &[(usize, f64)]) -> Box<dyn Fn(usize, usize) -> f64> {
    let (end, total) = (cells as f64, kernels.iter().map(|(_, count)| count).sum::<f64>());
    let mean = kernels.iter().map(|(cell, count)| *cell as f64 * count).sum::<f64>() / total;
    let square = kernels.iter().map(|(cell, count)| (*cell as f64 - mean).powi(2) * count).sum::<f64>();
    let deviation = (square / (total - 1.0).max(1.0)).sqrt();
    let below: Vec<f64> = kernels
        .iter()
        .scan(0.0, |sum, (_, count)| {
            *sum += count;
            Some(*sum)
        })
        .collect();
    let quarter = below.partition_point(|sum| *sum < (total / 4.0).floor());
    let three =
        below.partition_point(|sum| *sum <= (total * 3.0 / 4.0).floor()).min(kernels.len().saturating_sub(1));
    let cell_at = |at: usize| kernels.get(at).map_or(0.0, |(cell, _)| *cell as f64);
    let between = cell_at(three) - cell_at(quarter);
    let width = (1.059 * (between / 1.34).min(deviation) * total.powf(-0.2)).max(MIN_WIDTH);
    let centres: Vec<f64> = kernels.iter().map(|(cell, _)| *cell as f64).collect();
    Box::new(move |kernel, cell| {
        let (centre, width) = centres.get(kernel).map_or(((end - 1.0) / 2.0, end), |centre| (*centre, width));
        let part = |from: f64, to: f64| mass((from - centre) / width, (to - centre) / width);
        part(cell as f64 - 0.5, cell as f64 + 0.5) / part(-0.5, end - 0.5)
    })
}
