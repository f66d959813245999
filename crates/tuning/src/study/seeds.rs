//! Several seeds for one configuration.

use opendr_engine::{Error, Random, Result};
use serde_json::{Value, json};

use crate::pruner::Advice;
use crate::records::TrialRecord;
use crate::study::{Outcome, Study, Trial};

/// The user attribute with what each seed came to.
const VALUES: &str = "seed_values";
/// The user attribute of a study with what its best came to on fresh seeds.
const REEVALUATION: &str = "reevaluation";

/// So many seeds, the same for every trial: differences between trials are then less of luck.
pub fn training_seeds(seed: u64, count: usize) -> Vec<u64> {
    seeds(seed, 0, count)
}

/// So many seeds, none of which a trial has seen.
pub fn fresh_seeds(seed: u64, count: usize) -> Vec<u64> {
    seeds(seed, 1, count)
}

/// 31 bits, which every library takes.
fn seeds(seed: u64, family: u64, count: usize) -> Vec<u64> {
    (0..count).map(|at| Random::at([seed, family, at as u64]).bits() >> 33).collect()
}

/// What the best trial comes to on seeds that it was not chosen by.
#[derive(Debug, Clone, PartialEq)]
pub struct Reevaluation {
    /// The number of the trial.
    pub number: usize,
    /// The value by which it was chosen: as the best of many, better than it will be again.
    pub chosen_by: f64,
    /// Its values on fresh seeds.
    pub values: Vec<f64>,
}

impl Reevaluation {
    /// Mean of the fresh values.
    pub fn mean(&self) -> f64 {
        mean(&self.values)
    }

    /// Standard deviation of the fresh values; 0 for one.
    pub fn deviation(&self) -> f64 {
        let mean = self.mean();
        let square: f64 = self.values.iter().map(|value| (value - mean).powi(2)).sum();
        (square / (self.values.len().max(2) - 1) as f64).sqrt()
    }
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len().max(1) as f64
}

impl Trial<'_> {
    /// Measures this configuration with each seed; the mean is its value. The mean so far is reported with the number of
    /// seeds as the step, so that a pruner can end the trial before the last, and a rung is a number of seeds. A trial that
    /// goes on does not measure again what it has.
    ///
    /// # Errors
    /// That of `measure`; as [`Study::report`].
    pub fn over_seeds(&self, seeds: &[u64], mut measure: impl FnMut(u64) -> Result<f64>) -> Result<Outcome> {
        let record = self.record()?;
        let known = record.user_attributes.get(VALUES).and_then(Value::as_array);
        let mut values: Vec<f64> =
            known.into_iter().flatten().filter_map(Value::as_f64).take(seeds.len()).collect();
        for seed in seeds.iter().skip(values.len()) {
            let value = measure(*seed)?;
            if !value.is_finite() {
                return Ok(Outcome::Failed(format!("seed {seed} came to {value}")));
            }
            values.push(value);
            self.note(VALUES, json!(values))?;
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
    /// Measures the best trial again, with seeds by which it was not chosen, and notes what came of it beside the study;
    /// nothing once `measure` says none, as after Ctrl-C.
    ///
    /// # Errors
    /// `InvalidParam` when no trial is complete, or there are no seeds; that of `measure`; `Io` and `Format` of the storage.
    pub fn reevaluate_best(
        &self,
        seeds: &[u64],
        measure: impl FnMut(&TrialRecord, u64) -> Result<Option<f64>>,
    ) -> Result<Option<Reevaluation>> {
        let best = self.best().and_then(|best| best.value().map(|value| (best, value)));
        let (Some((best, chosen_by)), false) = (best, seeds.is_empty()) else {
            return Err(Error::invalid_param(
                "to measure the best trial again takes a complete trial and a seed",
            ));
        };
        let mut measure = measure;
        let values = seeds.iter().map(|seed| measure(&best, *seed)).collect::<Result<Option<Vec<_>>>>()?;
        let Some(values) = values else { return Ok(None) };
        let told = Reevaluation { number: best.number, chosen_by, values };
        self.note_of_study(
            REEVALUATION,
            json!({"trial": told.number, "chosen_by": chosen_by, "seeds": seeds, "values": told.values, "mean": told.mean()}),
        )?;
        Ok(Some(told))
    }
}
