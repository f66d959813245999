//! Losses of a minibatch and their gradients.

use opendr_kernels::Compute;

use super::rollout::Rollout;
use crate::policy::{Head, Likelihood, Policy, Sequences, Trunk, TrunkMemory};

/// The steps of a minibatch.
#[derive(Debug, Clone, Default)]
pub(super) struct Minibatch {
    pub observations: Vec<f32>,
    actions: Vec<f32>,
    log_probabilities: Vec<f32>,
    advantages: Vec<f32>,
    values: Vec<f32>,
    returns: Vec<f32>,
    /// Steps in which a shield replaced the action.
    shielded: Vec<bool>,
    /// Recurrent states of policy and critic at the start of the sequences.
    states: [Vec<f32>; 2],
    /// Steps that start an episode, for recurrent policies.
    starts: Vec<bool>,
    rows: Vec<usize>,
}

impl Minibatch {
    /// Copies the sequences with the indices `places`, ordered by step; normalises the advantages to mean 0 and standard deviation 1
    /// if `normalise`.
    pub fn gather(&mut self, rollout: &Rollout, places: &[usize], normalise: bool) {
        let total = rollout.values.len();
        self.rows.clear();
        for step in 0..rollout.length {
            self.rows.extend(places.iter().map(|&place| rollout.row(place, step)));
        }
        self.gather_memory(rollout, places, total);
        let rows = |from: &[f32], to: &mut Vec<f32>| copy_rows(from, from.len() / total, &self.rows, to);
        rows(&rollout.observations, &mut self.observations);
        rows(&rollout.actions, &mut self.actions);
        rows(&rollout.log_probabilities, &mut self.log_probabilities);
        rows(&rollout.advantages, &mut self.advantages);
        rows(&rollout.values, &mut self.values);
        rows(&rollout.returns, &mut self.returns);
        self.shielded.clear();
        self.shielded.extend(self.rows.iter().map(|&row| rollout.shielded[row]));
        if normalise && self.rows.len() > 1 {
            let count = self.rows.len() as f32;
            let mean = self.advantages.iter().sum::<f32>() / count;
            let squares = self.advantages.iter().map(|advantage| (advantage - mean).powi(2)).sum::<f32>();
            let deviation = (squares / (count - 1.0)).sqrt() + 1e-8;
            self.advantages.iter_mut().for_each(|advantage| *advantage = (*advantage - mean) / deviation);
        }
    }

    /// Copies the states at the start of the sequences, and marks the episode starts in them.
    fn gather_memory(&mut self, rollout: &Rollout, places: &[usize], total: usize) {
        let sequences = total / rollout.length;
        for (states, kept) in self.states.iter_mut().zip(&rollout.states) {
            copy_rows(kept, kept.len() / sequences, places, states);
        }
        self.starts.clear();
        // The stored state of a sequence is already reset if an episode ended before it.
        self.starts.resize(places.len(), false);
        let later = self.rows.get(places.len()..).unwrap_or_default();
        self.starts.extend(later.iter().map(|&row| rollout.ends[row - rollout.count]));
    }

    fn sequences(&self, of: usize) -> Sequences<'_> {
        Sequences { states: &self.states[of], starts: &self.starts }
    }
}

fn copy_rows(from: &[f32], width: usize, rows: &[usize], to: &mut Vec<f32>) {
    to.clear();
    for &row in rows {
        to.extend_from_slice(&from[row * width..(row + 1) * width]);
    }
}

/// Weights of the loss terms, and clipping ranges.
#[derive(Debug, Clone, Copy)]
pub(super) struct Weights {
    pub clip_range: f32,
    pub clip_range_vf: Option<f32>,
    pub entropy: f32,
    pub value: f32,
}

/// Statistics of the policy on a minibatch, as means.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct ActorLoss {
    pub policy: f32,
    pub entropy: f32,
    pub approx_kl: f32,
    pub clip_fraction: f32,
}

/// Forward and backward pass of the policy, and reused work memory.
#[derive(Debug, Clone, Default)]
pub(super) struct ActorPass {
    pub trunk: TrunkMemory,
    pub likelihood: Likelihood,
    dlogs: Vec<f32>,
    /// Gradients of all parameters of the policy.
    pub gradients: Vec<f32>,
    /// Gradient of the features, if requested.
    pub dfeatures: Vec<f32>,
    pub loss: ActorLoss,
}

impl ActorPass {
    /// Runs forward and backward from `features`. Computes the gradients of the trunk and of the standard deviations only.
    pub fn run(
        &mut self,
        compute: &Compute,
        policy: &Policy,
        features: &[f32],
        steps: &Minibatch,
        weights: Weights,
        wants_input: bool,
    ) {
        self.gradients.clear();
        self.gradients.resize(policy.parameters.len(), 0.0);
        let from = policy.extractor.parameters();
        let to = from + policy.trunk.parameters();
        let (own, log_std) = (&policy.parameters[from..to], policy.log_std());
        let sequences = steps.sequences(0);
        let outputs = policy.trunk.forward(compute, own, features, sequences, &mut self.trunk);
        self.likelihood.evaluate(compute.isa(), &policy.head, outputs, log_std, &steps.actions);
        let (down, dlog_std) = self.gradients[from..].split_at_mut(to - from);
        self.loss = self.likelihood.clipped_loss(steps, weights.clip_range, &mut self.dlogs);
        let dentropy = -weights.entropy / steps.advantages.len() as f32;
        let head: &Head = &policy.head;
        self.likelihood.backward(
            head,
            outputs,
            log_std,
            &steps.actions,
            [&mut self.dlogs, dlog_std],
            dentropy,
        );
        let (doutputs, starts) = (&self.likelihood.doutputs, sequences.starts);
        let dfeatures =
            policy.trunk.backward(compute, own, doutputs, starts, &mut self.trunk, down, wants_input);
        self.dfeatures.clear();
        self.dfeatures.extend_from_slice(dfeatures);
    }
}

impl Likelihood {
    /// Computes the clipped surrogate loss (Schulman et al., 2017, Eq. 7) and its gradient by the log-probabilities.
    fn clipped_loss(&self, steps: &Minibatch, clip_range: f32, dlogs: &mut Vec<f32>) -> ActorLoss {
        let scale = 1.0 / steps.advantages.len() as f32;
        let mut loss = ActorLoss::default();
        dlogs.clear();
        let rows = self.log_probabilities.iter().zip(&steps.log_probabilities).zip(&steps.advantages);
        for (((now, before), advantage), shielded) in rows.zip(&steps.shielded) {
            if *shielded {
                dlogs.push(0.0);
                continue;
            }
            let difference = now - before;
            let ratio = difference.exp();
            let clipped = ratio.clamp(1.0 - clip_range, 1.0 + clip_range);
            let (free, bound) = (advantage * ratio, advantage * clipped);
            loss.policy -= free.min(bound);
            loss.approx_kl += (ratio - 1.0) - difference;
            loss.clip_fraction += f32::from((ratio - 1.0).abs() > clip_range);
            // Where the clipped term is the smaller one, the gradient is 0.
            dlogs.push(if bound < free { 0.0 } else { -scale * free });
        }
        loss.entropy = self.entropies.iter().sum();
        for sum in [&mut loss.policy, &mut loss.approx_kl, &mut loss.clip_fraction, &mut loss.entropy] {
            *sum *= scale;
        }
        loss
    }
}

/// Forward and backward pass of the value network, and reused work memory.
#[derive(Debug, Clone, Default)]
pub(super) struct CriticPass {
    pub trunk: TrunkMemory,
    dvalues: Vec<f32>,
    pub gradients: Vec<f32>,
    pub dfeatures: Vec<f32>,
    /// Mean squared error.
    pub loss: f32,
}

impl CriticPass {
    /// Runs forward and backward from `features`.
    #[expect(clippy::too_many_arguments, reason = "inputs and outputs of a pass")]
    pub fn run(
        &mut self,
        compute: &Compute,
        trunk: &Trunk,
        parameters: &[f32],
        features: &[f32],
        steps: &Minibatch,
        weights: Weights,
        wants_input: bool,
    ) {
        self.gradients.clear();
        self.gradients.resize(parameters.len(), 0.0);
        let sequences = steps.sequences(1);
        let values = trunk.forward(compute, parameters, features, sequences, &mut self.trunk);
        let scale = 1.0 / values.len() as f32;
        self.loss = 0.0;
        self.dvalues.clear();
        for ((value, before), returned) in values.iter().zip(&steps.values).zip(&steps.returns) {
            let moved = value - before;
            let range = weights.clip_range_vf.unwrap_or(f32::INFINITY);
            let predicted = if moved.abs() > range { before + range.copysign(moved) } else { *value };
            let error = predicted - returned;
            self.loss += error * error;
            let slope = if moved.abs() > range { 0.0 } else { 2.0 * weights.value * scale };
            self.dvalues.push(slope * error);
        }
        self.loss *= scale;
        let (dvalues, starts) = (&self.dvalues, sequences.starts);
        let (memory, gradients) = (&mut self.trunk, &mut self.gradients[..]);
        let dfeatures = trunk.backward(compute, parameters, dvalues, starts, memory, gradients, wants_input);
        self.dfeatures.clear();
        self.dfeatures.extend_from_slice(dfeatures);
    }
}
