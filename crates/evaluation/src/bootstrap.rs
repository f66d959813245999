//! Confidence intervals by the bootstrap over the samples of a data set.
//!
//! Source: B. Efron, R. Tibshirani, An Introduction to the Bootstrap, 1993, chapters 8 and 13.

use opendr_engine::target::Classes;
use opendr_engine::{Progress, Random, Result, Unit};
use opendr_metrics::{AnyMetric, Report};
use serde::{Deserialize, Serialize};

/// Maximum number of groups that are resampled. With fewer samples, each is a group.
const MAX_GROUPS: usize = 50;
/// Minimum number of samples or sequences for an interval.
const MIN_UNITS: usize = 5;
/// Confidence level.
const LEVEL: f64 = 0.95;
const SEED: u64 = 0;

/// A confidence interval of the headline number of a report.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Interval {
    /// Lower end.
    pub low: f64,
    /// Upper end.
    pub high: f64,
    /// Confidence level: the fraction of the resamples in the interval.
    pub level: f64,
    /// Number of resamples.
    pub resamples: usize,
    /// Number of independent samples, or of sequences, that were resampled.
    pub units: usize,
}

/// A metric over groups of samples, or of whole sequences, for resampling. Units are assigned to groups at random,
/// since data sets are sorted, and groups of every n-th sample would be too similar.
pub(crate) struct Groups {
    groups: Vec<Box<dyn AnyMetric>>,
    units: usize,
}

impl Groups {
    /// Creates groups for a number of independent `units`, of an empty metric.
    pub fn new(metric: Box<dyn AnyMetric>, units: usize) -> Self {
        let count = units.clamp(1, MAX_GROUPS);
        Self { groups: (0..count).map(|_| metric.boxed_clone()).collect(), units }
    }

    /// Sets the class names of the data set.
    pub fn name_classes(&mut self, classes: &Classes) {
        self.groups.iter_mut().for_each(|group| group.name_classes(classes));
    }

    /// Returns the group of a unit.
    pub fn of(&mut self, unit: usize) -> &mut dyn AnyMetric {
        let count = self.groups.len();
        let group = if self.units <= count {
            unit % count
        } else {
            Random::from_key([SEED, unit as u64]).below(count)
        };
        self.groups[group].as_mut()
    }

    /// Returns the report over all groups.
    ///
    /// # Errors
    /// None: all groups have the same metric.
    pub fn report(&self) -> Result<Report> {
        merged(self.groups.iter())
    }

    /// Returns an interval for the headline of `report` from `resamples`; `None` with too few units, or when the user stops it.
    ///
    /// # Errors
    /// As [`Groups::report`].
    pub fn interval(
        &self,
        report: &Report,
        resamples: usize,
        progress: &dyn Progress,
    ) -> Result<Option<Interval>> {
        let is_number = report.statistics.get(&report.headline).is_some_and(f64::is_finite);
        if self.units < MIN_UNITS || resamples == 0 || !is_number {
            return Ok(None);
        }
        progress.begin("resampling", Some(resamples as u64), Unit::Items);
        let mut random = Random::new(SEED);
        let mut values = Vec::with_capacity(resamples);
        for _ in 0..resamples {
            if progress.stopped() {
                break;
            }
            let drawn = (0..self.groups.len()).map(|_| &self.groups[random.below(self.groups.len())]);
            let resampled = merged(drawn)?;
            values.extend(resampled.statistics.get(&report.headline).filter(|value| value.is_finite()));
            progress.advance(1);
        }
        progress.end();
        if values.len() < resamples.div_ceil(2) {
            return Ok(None);
        }
        values.sort_by(f64::total_cmp);
        let [low, high] = [(1.0 - LEVEL) / 2.0, (1.0 + LEVEL) / 2.0].map(|share| quantile(&values, share));
        Ok(Some(Interval { low, high, level: LEVEL, resamples: values.len(), units: self.units }))
    }
}

fn merged<'a>(mut groups: impl Iterator<Item = &'a Box<dyn AnyMetric>>) -> Result<Report> {
    let Some(first) = groups.next() else { return Ok(Report::default()) };
    let mut all = first.boxed_clone();
    groups.try_for_each(|group| all.merge(group.boxed_clone()))?;
    Ok(all.finish())
}

/// Returns the quantile of sorted `values`, interpolated linearly.
fn quantile(values: &[f64], share: f64) -> f64 {
    let place = share * (values.len() - 1) as f64;
    let (low, high) = (place.floor() as usize, place.ceil() as usize);
    values[low] + (values[high] - values[low]) * place.fract()
}

#[cfg(test)]
mod tests {
    use opendr_engine::Silent;
    use opendr_engine::params::ParamMap;
    use opendr_engine::target::Category;
    use opendr_metrics::find;

    use super::*;

    fn groups(right: usize, samples: usize) -> Groups {
        let metric = find("classification").unwrap().make(&ParamMap::new()).unwrap();
        let mut groups = Groups::new(metric, samples);
        for at in 0..samples {
            let (prediction, ground_truth) =
                (Category::new(i64::from(at % samples < right), None), Category::new(1, None));
            groups.of(at).update(at, (&prediction).into(), (&ground_truth).into()).unwrap();
        }
        groups
    }

    #[test]
    fn interval_of_a_share_is_that_of_a_binomial() {
        for samples in [40, 400] {
            let groups = groups(samples * 3 / 4, samples);
            let report = groups.report().unwrap();
            assert_eq!(report.statistics.get("accuracy"), Some(0.75));
            let interval = groups.interval(&report, 2000, &Silent).unwrap().unwrap();
            let half = 1.96 * (0.75_f64 * 0.25 / samples as f64).sqrt();
            // With 50 groups, the estimated spread is accurate to about a tenth.
            let [low, high] = [interval.low - (0.75 - half), interval.high - (0.75 + half)];
            assert!(low.abs() < 0.25 * half && high.abs() < 0.25 * half, "{interval:?} +- {half}");
            assert_eq!((interval.units, interval.resamples), (samples, 2000));
        }
    }

    #[test]
    fn few_samples_have_no_interval() {
        let few = groups(2, 4);
        let report = few.report().unwrap();
        assert_eq!(few.interval(&report, 100, &Silent).unwrap(), None);
        let none = groups(5, 10);
        let report = none.report().unwrap();
        assert_eq!(none.interval(&report, 0, &Silent).unwrap(), None);
    }
}
