//! How a diffusion policy acts: it predicts a horizon of actions, executes some, and predicts again.

use opendr_engine::Random;

use super::config::DiffusionParams;
use super::denoiser::{DenoiserTape, Noisy};
use super::policy::DiffusionPolicy;
use crate::method::Acting;

/// State of a controller: the last observations, and the actions that were predicted.
#[derive(Debug, Clone, Default)]
pub struct DiffusionMemory {
    tape: DenoiserTape,
    /// `[history, observation]`, the current one last; empty before the first.
    observations: Vec<f32>,
    /// `[horizon, action]`, scaled.
    chunk: Vec<f32>,
    noise: Vec<f32>,
    /// Actions of the chunk that were executed.
    executed: usize,
    random: Option<Random>,
}

impl DiffusionMemory {
    pub(super) fn reset(&mut self) {
        self.observations.clear();
        self.executed = 0;
    }

    pub(super) fn act(&mut self, policy: &DiffusionPolicy, params: &DiffusionParams, step: Acting<'_>) {
        let (history, horizon) = (policy.config.n_obs_steps, policy.config.horizon);
        let width = step.observation.len();
        let begins = self.observations.is_empty();
        if begins {
            (0..history).for_each(|_| self.observations.extend_from_slice(step.observation));
        } else {
            self.observations.copy_within(width.., 0);
            self.observations[(history - 1) * width..].copy_from_slice(step.observation);
        }
        let executable = params.n_action_steps.clamp(1, horizon + 1 - history);
        if begins || self.executed >= executable {
            self.predict(policy, params, &step);
            self.executed = 0;
        }
        let Acting { action, .. } = step;
        let at = (history - 1 + self.executed) * action.len();
        action.copy_from_slice(&self.chunk[at..][..action.len()]);
        self.executed += 1;
    }

    /// Removes the noise from a random chunk.
    fn predict(&mut self, policy: &DiffusionPolicy, params: &DiffusionParams, step: &Acting<'_>) {
        let Self { tape, observations, chunk, noise, random, .. } = self;
        let random = random.get_or_insert_with(|| Random::new(params.seed));
        chunk.clear();
        chunk.extend((0..policy.config.horizon * step.action.len()).map(|_| random.normal() as f32));
        let mut levels = policy.schedule.sampled(params.num_inference_steps).peekable();
        while let Some(level) = levels.next() {
            let noisy = Noisy { observations, levels: &[level], chunks: chunk };
            let predicted = policy.denoiser.forward(step.compute, step.parameters, noisy, tape);
            noise.clear();
            noise.extend_from_slice(predicted);
            policy.schedule.step([Some(level), levels.peek().copied()], noise, chunk);
        }
    }
}
