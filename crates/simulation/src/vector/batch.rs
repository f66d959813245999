//! Results of a step of several environments.

use opendr_engine::environment::{EnvironmentSpec, Info, Step};
use opendr_engine::{Error, Result};

/// Buffers for the results of several environments, reused from step to step and ordered by environment.
#[derive(Debug, Clone, PartialEq)]
pub struct Batch {
    /// Current observations.
    pub observations: Vec<f32>,
    /// Rewards.
    pub rewards: Vec<f64>,
    /// Whether the episode terminated.
    pub terminated: Vec<bool>,
    /// Whether the episode was truncated.
    pub truncated: Vec<bool>,
    /// Infos; those of the reset where an episode began.
    pub infos: Vec<Info>,
    /// Last observations of the episodes that ended in this step, under
    /// [`Autoreset::SameStep`](super::Autoreset::SameStep); valid where `terminated` or `truncated`.
    pub final_observations: Vec<f32>,
    /// Infos of those last steps.
    pub final_infos: Vec<Info>,
}

impl Batch {
    /// Allocates buffers for `count` environments.
    pub fn new(spec: &EnvironmentSpec, count: usize) -> Self {
        let numbers = spec.observation.len() * count;
        Self {
            observations: vec![0.0; numbers],
            rewards: vec![0.0; count],
            terminated: vec![false; count],
            truncated: vec![false; count],
            infos: vec![Info::default(); count],
            final_observations: vec![0.0; numbers],
            final_infos: vec![Info::default(); count],
        }
    }

    /// Returns the number of environments.
    pub fn count(&self) -> usize {
        self.rewards.len()
    }

    pub(super) fn check(&self, spec: &EnvironmentSpec, count: usize) -> Result<()> {
        let numbers = spec.observation.len() * count;
        let lengths = [self.observations.len(), self.final_observations.len()];
        let counts = [self.rewards.len(), self.terminated.len(), self.truncated.len()];
        let infos = [self.infos.len(), self.final_infos.len()];
        if lengths == [numbers; 2] && counts == [count; 3] && infos == [count; 2] {
            return Ok(());
        }
        Err(Error::invalid_input(format!(
            "the batch does not fit {count} environments of {}; create it with Batch::new",
            spec.id
        )))
    }

    pub(super) fn write(&mut self, index: usize, step: Step) {
        self.rewards[index] = step.reward;
        self.terminated[index] = step.terminated;
        self.truncated[index] = step.truncated;
        self.infos[index] = step.info;
    }

    /// Copies the results of a part into the rows from `from` on.
    pub(super) fn copy_from(&mut self, part: &Self, from: usize) {
        let (to, size) = (from + part.count(), self.observations.len() / self.count().max(1));
        self.observations[from * size..to * size].copy_from_slice(&part.observations);
        self.final_observations[from * size..to * size].copy_from_slice(&part.final_observations);
        self.rewards[from..to].copy_from_slice(&part.rewards);
        self.terminated[from..to].copy_from_slice(&part.terminated);
        self.truncated[from..to].copy_from_slice(&part.truncated);
        self.infos[from..to].clone_from_slice(&part.infos);
        self.final_infos[from..to].clone_from_slice(&part.final_infos);
    }
}
