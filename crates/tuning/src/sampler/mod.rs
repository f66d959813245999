//! Samplers: the choice of parameters.

mod axis;
mod cma_es;
mod quasi_random;
mod random;
mod symmetric_eigen;
mod tpe;

use opendr_engine::Result;
use serde_json::Value;

use crate::records::StudyRecord;
use crate::space::Parameter;

pub use cma_es::CmaEs;
pub use quasi_random::QuasiRandom;
pub use random::RandomSearch;
pub use tpe::Tpe;

/// Parameters drawn for a trial.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct DrawnParameters {
    /// One number per parameter, in the representation of its distribution.
    pub numbers: Vec<f64>,
    /// System attributes of the trial that the sampler needs later.
    pub system_attributes: Vec<(String, Value)>,
}

/// Chooses parameters of trials.
///
/// A sampler has no state besides the study's record, and its random numbers depend only on its seed and the trial's number.
/// A resumed study therefore continues as an uninterrupted one, in any process.
pub trait Sampler: Send + Sync {
    /// Draws numbers for `parameters`, which are active together, of trial `number`.
    ///
    /// # Errors
    /// When the sampler cannot search such parameters.
    fn draw(&self, study: &StudyRecord, number: usize, parameters: &[&Parameter]) -> Result<DrawnParameters>;
}

/// Returns the random numbers of a sampler for a trial and a group of parameters.
fn stream(seed: u64, number: usize, parameters: &[&Parameter]) -> opendr_engine::Random {
    let group = parameters.first().map_or(0, |parameter| parameter.position);
    opendr_engine::Random::from_key([seed, number as u64, group as u64])
}

#[cfg(test)]
mod tests;
