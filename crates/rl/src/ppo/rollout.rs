//! The rollout: the steps collected for an update.

use super::advantage::{Trajectory, generalised_advantages};

/// Steps of all environments since the last update, ordered by step; its memory is reused.
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
    /// Recurrent states of policy and critic at the start of each sequence.
    pub states: [Vec<f32>; 2],
    /// Order of the sequences in an epoch.
    pub order: Vec<usize>,
    /// Steps per sequence.
    pub length: usize,
    /// Number of environments.
    pub count: usize,
}

impl Rollout {
    /// Allocates `steps` of each of `count` environments, in sequences of `length`; the second array holds the numbers per observation,
    /// action and state.
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

    /// Stores the recurrent states before a step that starts a sequence.
    pub fn store_states(&mut self, step: usize, states: [&[f32]; 2]) {
        if step.is_multiple_of(self.length) {
            for (kept, states) in self.states.iter_mut().zip(states) {
                let from = step / self.length * states.len();
                kept[from..from + states.len()].copy_from_slice(states);
            }
        }
    }

    /// Returns the row of a step of a sequence. Sequences that start at the same step are ordered by environment.
    pub fn row(&self, sequence: usize, step: usize) -> usize {
        (sequence / self.count * self.length + step) * self.count + sequence % self.count
    }

    /// Computes advantages and returns; `last_values` are the values after the last step.
    pub fn finish(&mut self, last_values: &[f32], gamma: f32, lambda: f32) {
        let (rewards, values, ends) = (&self.rewards[..], &self.values[..], &self.ends[..]);
        let trajectory = Trajectory { rewards, values, ends, last_values };
        generalised_advantages(trajectory, gamma, lambda, &mut self.advantages);
        for (returned, (advantage, value)) in
            self.returns.iter_mut().zip(self.advantages.iter().zip(&self.values))
        {
            *returned = advantage + value;
        }
        // Every update starts from the same order, so that a restored generator shuffles it the same way.
        self.order.iter_mut().enumerate().for_each(|(place, at)| *at = place);
    }

    /// Returns the fraction of the variance of returns that the values explain; NaN if the returns do not vary.
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
