//! What many environments answer.

use opendr_engine::environment::{EnvironmentSpec, Info, Step};
use opendr_engine::{Error, Result};

/// Memory for the answers of many environments, used again from step to step; environment after environment.
#[derive(Debug, Clone, PartialEq)]
pub struct Batch {
    /// The observations to act on next.
    pub observations: Vec<f32>,
    /// The rewards.
    pub rewards: Vec<f64>,
    /// Where the task itself ended.
    pub terminated: Vec<bool>,
    /// Where the episode was cut from outside.
    pub truncated: Vec<bool>,
    /// What else is known; of the first observation where an episode began.
    pub infos: Vec<Info>,
    /// The last observations of episodes that ended in this step; with
    /// [`Autoreset::SameStep`](super::Autoreset::SameStep), and valid where `terminated` or `truncated`.
    pub final_observations: Vec<f32>,
    /// What else is known of those.
    pub final_infos: Vec<Info>,
}

impl Batch {
    /// Memory for `count` environments.
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

    /// For how many environments there is memory.
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
            "this batch is not made for {count} of {}; make it with Batch::new",
            spec.id
        )))
    }

    pub(super) fn write(&mut self, index: usize, step: Step) {
        self.rewards[index] = step.reward;
        self.terminated[index] = step.terminated;
        self.truncated[index] = step.truncated;
        self.infos[index] = step.info;
    }

    /// Copies the answers of environments `from`, `from` + 1, ...
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
