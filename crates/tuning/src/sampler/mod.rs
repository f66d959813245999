//! How the next trial is chosen.

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

/// Parameters of a trial.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Drawn {
    /// One number for each parameter, as its distribution understands it.
    pub numbers: Vec<f64>,
    /// What the sampler needs to know of the trial later: system attributes of it.
    pub notes: Vec<(String, Value)>,
}

/// Chooses parameters.
///
/// All that a sampler knows is in the study's record, and all that is random follows from its seed and the trial's number:
/// so a study that goes on from its file, in whichever process, goes on with what it would have done.
pub trait Sampler: Send + Sync {
    /// Numbers for the parameters `wanted`, which take part together, of trial `number`.
    ///
    /// # Errors
    /// When the sampler cannot search such parameters.
    fn draw(&self, study: &StudyRecord, number: usize, wanted: &[&Parameter]) -> Result<Drawn>;
}

/// Streams of random numbers of a sampler by trial and group of parameters.
fn stream(seed: u64, number: usize, wanted: &[&Parameter]) -> opendr_engine::Random {
    let group = wanted.first().map_or(0, |parameter| parameter.position);
    opendr_engine::Random::at([seed, number as u64, group as u64])
}

#[cfg(test)]
mod tests;
