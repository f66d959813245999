//! Reinforcement learning: success rate with confidence interval, returns, and the interquartile mean with confidence
//! interval as in `rliable` (Agarwal et al., Deep Reinforcement Learning at the Edge of the Statistical Precipice,
//! NeurIPS 2021).

use std::collections::BTreeMap;

use opendr_engine::params::Params;
use opendr_engine::{Error, Random, Result};
use serde::{Deserialize, Serialize};

use crate::average::{mean, ratio};
use crate::{Report, Table};

/// 97.5 % quantile of the normal distribution, for two-sided 95 % intervals.
const Z: f64 = 1.959_963_984_540_054;

/// Result of an episode.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Episode {
    /// Name of the environment, if there are several.
    #[serde(default)]
    pub task: String,
    /// Seed of the training run of the policy.
    #[serde(default)]
    pub seed: u64,
    /// Sum of the rewards.
    #[serde(rename = "return")]
    pub total_reward: f64,
    /// Whether the goal was reached, if there is one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub success: Option<bool>,
}

/// Parameters of [`Success`].
#[derive(Debug, Clone, Params)]
pub struct SuccessParams {
    /// Number of bootstrap resamples of runs for the interval of the interquartile mean.
    #[param(default = 50_000, range = 100..=1_000_000)]
    pub resamples: usize,
    /// Seed of the resampling.
    pub seed: u64,
}

#[derive(Debug, Clone, Default)]
struct Run {
    returns: Vec<f64>,
    successes: u64,
    trials: u64,
}

/// Collects episodes by task and run: 8 bytes per episode.
#[derive(Debug, Clone, Default)]
pub struct Success {
    params: SuccessParams,
    tasks: BTreeMap<String, BTreeMap<u64, Run>>,
}

impl Success {
    /// Creates an empty accumulator.
    pub fn new(params: &SuccessParams) -> Self {
        Self { params: params.clone(), tasks: BTreeMap::new() }
    }

    /// Adds an episode.
    ///
    /// # Errors
    /// Returns `InvalidInput` for a return that is NaN or infinite.
    pub fn add(&mut self, episode: &Episode) -> Result<()> {
        if !episode.total_reward.is_finite() {
            let Episode { task, seed, total_reward, .. } = episode;
            return Err(Error::invalid_input(format!(
                "return {total_reward} of task {task:?}, seed {seed} is not finite; give finite numbers"
            )));
        }
        let run = self.tasks.entry(episode.task.clone()).or_default().entry(episode.seed).or_default();
        run.returns.push(episode.total_reward);
        run.trials += u64::from(episode.success.is_some());
        run.successes += u64::from(episode.success == Some(true));
        Ok(())
    }

    /// Adds the episodes of `other`.
    pub fn merge(&mut self, other: Self) {
        for (task, runs) in other.tasks {
            let task = self.tasks.entry(task).or_default();
            for (seed, more) in runs {
                let run = task.entry(seed).or_default();
                run.returns.extend(more.returns);
                run.successes += more.successes;
                run.trials += more.trials;
            }
        }
    }

    /// Returns the mean return of every run, by task.
    fn scores(&self) -> Vec<Vec<f64>> {
        let of_run = |run: &Run| {
            // Sorted, so that the result does not depend on the order of episodes.
            let mut returns = run.returns.clone();
            returns.sort_by(f64::total_cmp);
            mean(returns)
        };
        self.tasks.values().map(|runs| runs.values().filter_map(of_run).collect()).collect()
    }

    /// Returns the result. The interquartile mean is over the mean returns of the runs; it has no interval if every task has
    /// only one run.
    pub fn finish(&self) -> Report {
        let runs = || self.tasks.values().flat_map(BTreeMap::values);
        let trials = runs().map(|run| run.trials).sum();
        let mut report = Report::new(if trials > 0 { "success_rate" } else { "return_iqm" });
        let mut set = |key: &str, value: f64| report.statistics.set(key, value);
        let mut returns: Vec<f64> = runs().flat_map(|run| &run.returns).copied().collect();
        returns.sort_by(f64::total_cmp);
        set("episodes", returns.len() as f64);
        set("runs", runs().count() as f64);
        if let Some(interval) = wilson_interval(runs().map(|run| run.successes).sum(), trials) {
            set("success_rate", interval.value);
            set("success_rate_low", interval.low);
            set("success_rate_high", interval.high);
        }
        if let Some(average) = mean(returns.iter().copied()) {
            let squares = returns.iter().map(|value| (value - average).powi(2));
            set("return_mean", average);
            set("return_std", mean(squares).unwrap_or(0.0).sqrt());
            set("return_median", percentile(&returns, 50.0));
        }
        let scores = self.scores();
        if let Some(value) = interquartile_mean(&mut scores.concat()) {
            set("return_iqm", value);
        }
        if let Some(interval) = bootstrap_interval(&scores, self.params.resamples, self.params.seed) {
            set("return_iqm_low", interval.low);
            set("return_iqm_high", interval.high);
        }
        report.tables.push(self.table());
        report
    }

    fn table(&self) -> Table {
        let row = |(task, runs): (&String, &BTreeMap<u64, Run>)| {
            let successes = runs.values().map(|run| run.successes).sum();
            let interval = wilson_interval(successes, runs.values().map(|run| run.trials).sum());
            let mut returns: Vec<f64> = runs.values().flat_map(|run| &run.returns).copied().collect();
            returns.sort_by(f64::total_cmp);
            let (count, rate) = (returns.len() as f64, interval.map(|interval| interval.value));
            (task.clone(), vec![Some(runs.len() as f64), Some(count), rate, mean(returns)])
        };
        Table {
            name: "task".to_owned(),
            columns: ["runs", "episodes", "success_rate", "return_mean"].map(str::to_owned).into(),
            rows: self.tasks.iter().map(row).collect(),
        }
    }
}

/// A number with its 95 % confidence interval.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Interval {
    /// Value.
    pub value: f64,
    /// Lower end.
    pub low: f64,
    /// Upper end.
    pub high: f64,
}

/// Returns the fraction of successes with its 95 % interval (Wilson, 1927); `None` without trials.
pub fn wilson_interval(successes: u64, trials: u64) -> Option<Interval> {
    let (value, count) = (ratio(successes, trials)?, trials as f64);
    let scale = 1.0 + Z * Z / count;
    let centre = (value + Z * Z / (2.0 * count)) / scale;
    let half = Z / scale * (value * (1.0 - value) / count + Z * Z / (4.0 * count * count)).sqrt();
    // Exactly 0 and 1 at the ends, which rounding would miss.
    let low = if successes == 0 { 0.0 } else { centre - half };
    let high = if successes == trials { 1.0 } else { centre + half };
    Some(Interval { value, low, high })
}

/// Returns the mean without the lowest and the highest quarter, each rounded down (`scipy.stats.trim_mean(scores, 0.25)`);
/// `None` without scores. It reorders `scores`, which are not NaN.
pub fn interquartile_mean(scores: &mut [f64]) -> Option<f64> {
    let cut = scores.len() / 4;
    let mut kept = scores;
    if cut > 0 {
        kept = kept.select_nth_unstable_by(cut - 1, f64::total_cmp).2;
        kept = kept.select_nth_unstable_by(kept.len() - cut, f64::total_cmp).0;
    }
    mean(kept.iter().copied())
}

/// Returns the interquartile mean of `scores[task][run]` with its 95 % interval: the 2.5 and 97.5 percentiles over
/// `resamples` bootstrap samples of runs, stratified by task. Equal seeds give equal intervals. `None` if no task has two
/// runs.
pub fn bootstrap_interval(scores: &[Vec<f64>], resamples: usize, seed: u64) -> Option<Interval> {
    if scores.iter().all(|runs| runs.len() < 2) {
        return None;
    }
    let value = interquartile_mean(&mut scores.concat())?;
    let mut random = Random::new(seed);
    let mut drawn = Vec::new();
    let mut means = Vec::with_capacity(resamples);
    for _ in 0..resamples {
        drawn.clear();
        for runs in scores {
            drawn.extend(runs.iter().map(|_| runs[random.below(runs.len())]));
        }
        means.extend(interquartile_mean(&mut drawn));
    }
    means.sort_unstable_by(f64::total_cmp);
    Some(Interval { value, low: percentile(&means, 2.5), high: percentile(&means, 97.5) })
}

/// Returns a percentile of `sorted` by linear interpolation, as `numpy.percentile`; NaN without numbers.
fn percentile(sorted: &[f64], percent: f64) -> f64 {
    let Some(last) = sorted.len().checked_sub(1) else { return f64::NAN };
    let position = last as f64 * percent / 100.0;
    let (below, above) = (sorted[position as usize], sorted[last.min(position as usize + 1)]);
    below + (above - below) * position.fract()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn episode(task: &str, seed: u64, total_reward: f64, success: Option<bool>) -> Episode {
        Episode { task: task.to_owned(), seed, total_reward, success }
    }

    #[test]
    fn wilson_of_the_books() {
        // 15 of 50 at 95 %: 0.191 to 0.438 (Brown, Cai and DasGupta, 2001).
        let interval = wilson_interval(15, 50).unwrap();
        assert!(
            (interval.low - 0.1910).abs() < 1e-4 && (interval.high - 0.4375).abs() < 1e-4,
            "{interval:?}"
        );
        assert_eq!(wilson_interval(0, 10).unwrap().low, 0.0);
        assert_eq!(wilson_interval(10, 10).unwrap().high, 1.0);
        assert_eq!(wilson_interval(0, 0), None);
    }

    #[test]
    fn quarters_are_removed() {
        assert_eq!(interquartile_mean(&mut [100.0, 1.0, 2.0, -50.0]), Some(1.5));
        assert_eq!(interquartile_mean(&mut [5.0, 1.0, 3.0]), Some(3.0));
        assert_eq!(interquartile_mean(&mut []), None);
        assert_eq!(percentile(&[1.0, 2.0, 4.0], 75.0), 3.0);
    }

    #[test]
    fn interval_contains_the_mean_and_follows_the_seed() {
        let scores = [vec![1.03, 2.17, 3.31, 4.73, 10.9, 7.11], vec![0.57, 0.29, 1.71, 5.3]];
        let interval = bootstrap_interval(&scores, 500, 7).unwrap();
        assert!(interval.low < interval.value && interval.value < interval.high);
        assert_eq!(bootstrap_interval(&scores, 500, 7), Some(interval));
        assert_ne!(bootstrap_interval(&scores, 500, 8), Some(interval));
        assert_eq!(bootstrap_interval(&[vec![1.0], vec![2.0]], 100, 0), None);
        let constant = bootstrap_interval(&[vec![2.0; 4]], 100, 0).unwrap();
        assert_eq!((constant.low, constant.high), (2.0, 2.0));
    }

    #[test]
    fn episodes_of_runs() {
        let episodes = [
            episode("reach", 0, 1.0, Some(true)),
            episode("reach", 0, 3.0, Some(false)),
            episode("reach", 1, 4.0, Some(true)),
            episode("push", 0, 0.0, None),
        ];
        let mut whole = Success::new(&SuccessParams { resamples: 200, seed: 1 });
        let mut reversed = whole.clone();
        for episode in &episodes {
            whole.add(episode).unwrap();
        }
        for episode in episodes.iter().rev() {
            let mut part = Success::default();
            part.add(episode).unwrap();
            reversed.merge(part);
        }
        let report = whole.finish();
        assert_eq!(report, reversed.finish());
        let number = |key| report.statistics.get(key);
        assert_eq!(number("success_rate"), Some(2.0 / 3.0));
        assert_eq!((number("return_mean"), number("return_median")), (Some(2.0), Some(2.0)));
        assert_eq!(number("return_std"), Some(2.5_f64.sqrt()));
        assert_eq!((number("return_iqm"), number("runs")), (Some(2.0), Some(3.0)));
        assert_eq!(
            report.tables[0].rows[1],
            ("reach".to_owned(), vec![Some(2.0), Some(3.0), Some(2.0 / 3.0), Some(8.0 / 3.0)])
        );
    }

    #[test]
    fn no_episodes_and_nan() {
        let mut success = Success::default();
        assert!(success.add(&episode("", 0, f64::NAN, None)).is_err());
        let report = success.finish();
        assert_eq!(report.statistics.scalars.len(), 2, "{report:?}");
        assert_eq!(report.headline, "return_iqm");
    }
}
