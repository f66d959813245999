//! Random search.

use opendr_engine::Result;

use crate::records::StudyRecord;
use crate::sampler::axis::Axis;
use crate::sampler::{DrawnParameters, Sampler, stream};
use crate::space::Parameter;

/// Samples uniformly (Bergstra and Bengio 2012).
#[derive(Debug, Clone, Copy)]
pub struct RandomSearch {
    seed: u64,
}

impl RandomSearch {
    /// Creates the sampler.
    pub fn new(seed: u64) -> Self {
        Self { seed }
    }
}

impl Sampler for RandomSearch {
    fn draw(&self, _: &StudyRecord, number: usize, parameters: &[&Parameter]) -> Result<DrawnParameters> {
        let mut random = stream(self.seed, number, parameters);
        let numbers =
            parameters.iter().map(|it| Axis::new(&it.distribution).number_from_unit(random.unit())).collect();
        Ok(DrawnParameters { numbers, system_attributes: Vec::new() })
    }
}
