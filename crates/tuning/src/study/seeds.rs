//! Several seeds per configuration.

use opendr_engine::{Error, Random, Result};
use serde_json::{Value, json};

use crate::pruner::Advice;
use crate::records::TrialRecord;
use crate::study::{Outcome, Study, Trial};

/// User attribute with the value of each seed.
const VALUES: &str = "seed_values";
/// User attribute of a study with the values of its best trial on fresh seeds.
const REEVALUATION: &str = "reevaluation";

/// Returns `count` seeds, the same for every trial, which reduces random differences between trials.
pub fn training_seeds(seed: u64, count: usize) -> Vec<u64> {
    seeds(seed, 0, count)
}

/// Returns `count` seeds that no trial uses.
pub fn fresh_seeds(seed: u64, count: usize) -> Vec<u64> {
    seeds(seed, 1, count)
}

/// Seeds of 31 bits, which every library accepts.
fn seeds(seed: u64, family: u64, count: usize) -> Vec<u64> {
    (0..count).map(|at| Random::from_key([seed, family, at as u64]).bits() >> 33).collect()
}

/// Result of the best trial on seeds that did not select it.
#[derive(Debug, Clone, PartialEq)]
pub struct Reevaluation {
    /// Number of the trial.
    pub number: usize,
    /// The value that selected it. As the best of many, it is biased.
    pub chosen_by: f64,
    /// Values on fresh seeds.
    pub values: Vec<f64>,
}

impl Reevaluation {
    /// Returns the mean of the fresh values.
    pub fn mean(&self) -> f64 {
        mean(&self.values)
    }

    /// Returns the standard deviation of the fresh values; 0 for one value.
    pub fn std(&self) -> f64 {
        let mean = self.mean();
        let square: f64 = self.values.iter().map(|value| (value - mean).powi(2)).sum();
        (square / (self.values.len().max(2) - 1) as f64).sqrt()
    }
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len().max(1) as f64
}

impl Trial<'_> {
    /// Evaluates this configuration with each seed; the mean is its value. After each seed, the running mean is reported with the number of
    /// seeds as the step, so that a pruner can stop the trial early, and a rung is a number of seeds. A resumed
    /// trial does not repeat seeds.
    ///
    /// # Errors
    /// The error of `measure`; as [`Study::report`].
    pub fn over_seeds(&self, seeds: &[u64], mut measure: impl FnMut(u64) -> Result<f64>) -> Result<Outcome> {
        let record = self.record()?;
        let known = record.user_attributes.get(VALUES).and_then(Value::as_array);
        let mut values: Vec<f64> =
            known.into_iter().flatten().filter_map(Value::as_f64).take(seeds.len()).collect();
        for seed in seeds.iter().skip(values.len()) {
            let value = measure(*seed)?;
            if !value.is_finite() {
                return Ok(Outcome::Failed(format!("the value of seed {seed} is {value}")));
            }
            values.push(value);
            self.set_user_attribute(VALUES, json!(values))?;
            match self.report(values.len() as i64, mean(&values))? {
                Advice::Continue => {}
                _ if values.len() == seeds.len() => {}
                Advice::Pause => return Ok(Outcome::Paused(Value::Null)),
                Advice::Stop => return Ok(Outcome::Pruned),
            }
        }
        Ok(Outcome::from(mean(&values)))
    }
}

impl Study {
    /// Evaluates the best trial again with seeds that did not select it, and stores the result in the study. Returns
    /// none once `measure` returns none, as after Ctrl-C.
    ///
    /// # Errors
    /// `InvalidParam` without a complete trial or without seeds; the error of `measure`; `Io` and `Format` of the storage.
    pub fn reevaluate_best(
        &self,
        seeds: &[u64],
        measure: impl FnMut(&TrialRecord, u64) -> Result<Option<f64>>,
    ) -> Result<Option<Reevaluation>> {
        let best = self.best().and_then(|best| best.value().map(|value| (best, value)));
        let (Some((best, chosen_by)), false) = (best, seeds.is_empty()) else {
            return Err(Error::invalid_param(
                "the reevaluation needs a complete trial and at least one seed",
            ));
        };
        let mut measure = measure;
        let values = seeds.iter().map(|seed| measure(&best, *seed)).collect::<Result<Option<Vec<_>>>>()?;
        let Some(values) = values else { return Ok(None) };
        let reevaluation = Reevaluation { number: best.number, chosen_by, values };
        self.set_study_attribute(
            REEVALUATION,
            json!({"trial": reevaluation.number, "chosen_by": chosen_by, "seeds": seeds, "values": reevaluation.values, "mean": reevaluation.mean()}),
        )?;
        Ok(Some(reevaluation))
    }
}
