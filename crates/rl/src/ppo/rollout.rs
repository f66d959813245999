//! Steps that an update learns from.

use super::advantage::{Trajectory, generalised_advantages};

/// Steps of all environments since the last update, step after step; memory that is used again.
#[derive(Debug, Clone, Default)]
pub(super) struct Rollout {
    pub observations: Vec<f32>,
    pub actions: Vec<f32>,
    pub log_probabilities: Vec<f32>,
    pub values: Vec<f32>,
    pub rewards: Vec<f32>,
    pub ends: Vec<bool>,
    /// Where a shield replaced the action: the policy did not choose it, and its gradient leaves these steps out.
    pub shielded: Vec<bool>,
    pub advantages: Vec<f32>,
    pub returns: Vec<f32>,
    /// What policy and values remembered where each sequence begins.
    pub states: [Vec<f32>; 2],
    /// The order in which an epoch takes sequences.
    pub order: Vec<usize>,
    /// Steps of a sequence.
    pub length: usize,
    /// Environments.
    pub count: usize,
}

impl Rollout {
    /// Room for `steps` of each of `count` environments, with so many numbers of observations, actions and states; they are
    /// learnt from in sequences of `length`.
    pub fn new([steps, count, length]: [usize; 3], [observation, action, state]: [usize; 3]) -> Self {
        let steps = steps * count;
        let zeros = |width: usize| vec![0.0; steps * width];
        Self {
            observations: zeros(observation),
            actions: zeros(action),
            log_probabilities: zeros(1),
            values: zeros(1),
            rewards: zeros(1),
            ends: vec![false; steps],
            shielded: vec![false; steps],
            advantages: zeros(1),
            returns: zeros(1),
            states: [(); 2].map(|()| vec![0.0; steps / length * state]),
            order: (0..steps / length).collect(),
            length,
            count,
        }
    }

    /// Keeps what is remembered before a step, where a sequence begins.
    pub fn remember(&mut self, step: usize, states: [&[f32]; 2]) {
        if step.is_multiple_of(self.length) {
            for (kept, states) in self.states.iter_mut().zip(states) {
                let from = step / self.length * states.len();
                kept[from..from + states.len()].copy_from_slice(states);
            }
        }
    }

    /// The row of a step of a sequence. Those that begin together follow each other, environment after environment.
    pub fn row(&self, sequence: usize, step: usize) -> usize {
        (sequence / self.count * self.length + step) * self.count + sequence % self.count
    }

    /// Computes advantages and returns; `last_values` are those behind the last step.
    pub fn finish(&mut self, last_values: &[f32], gamma: f32, lambda: f32) {
        let (rewards, values, ends) = (&self.rewards[..], &self.values[..], &self.ends[..]);
        let trajectory = Trajectory { rewards, values, ends, last_values };
        generalised_advantages(trajectory, gamma, lambda, &mut self.advantages);
        for (returned, (advantage, value)) in
            self.returns.iter_mut().zip(self.advantages.iter().zip(&self.values))
        {
            *returned = advantage + value;
        }
        // Every update begins with the same order, so that a restored generator shuffles alike.
        self.order.iter_mut().enumerate().for_each(|(place, at)| *at = place);
    }

    /// The share of the variance of returns that values explain; NaN where returns do not vary.
    pub fn explained_variance(&self) -> f64 {
        let errors = self.returns.iter().zip(&self.values).map(|(a, b)| f64::from(a - b));
        1.0 - variance(errors) / variance(self.returns.iter().map(|&returned| returned.into()))
    }
}

fn variance(numbers: impl ExactSizeIterator<Item = f64> + Clone) -> f64 {
    let count = numbers.len() as f64;
    let mean = numbers.clone().sum::<f64>() / count;
    numbers.map(|number| (number - mean).powi(2)).sum::<f64>() / count
}
