//! Diffusion policy (Chi et al., 2023), for observations of numbers.

mod config;
mod denoiser;
mod horizon;
mod modulated;
mod policy;
mod schedule;

use opendr_engine::learner::Spec;
use opendr_engine::{Error, Random, Result, Task};
use opendr_kernels::{AdamOptions, Compute, WeightDecay};

pub use config::{DiffusionConfig, DiffusionParams};
use denoiser::{Denoiser, DenoiserTape, Noisy};
pub use horizon::DiffusionMemory;
pub use policy::DiffusionPolicy;
use schedule::NoiseSchedule;

use crate::affine::Affine;
use crate::batch::{Batch, Window};
use crate::method::{Acting, ChunkMethod, Optimisation};

/// Work memory of the training of [`DiffusionPolicy`].
#[derive(Debug, Clone, Default)]
pub struct DiffusionTape {
    denoiser: DenoiserTape,
    levels: Vec<usize>,
    noise: Vec<f32>,
    chunks: Vec<f32>,
    doutput: Vec<f32>,
}

#[allow(private_interfaces, reason = "as the trait")]
impl ChunkMethod for DiffusionPolicy {
    const SPEC: Spec = Spec::new("diffusion_policy", Task::ReinforcementLearning)
        .class("DiffusionPolicyLearner")
        .about("Diffusion policy: imitates demonstrations that reach their goal in several ways.");
    type Config = DiffusionConfig;
    type Params = DiffusionParams;
    type Tape = DiffusionTape;
    type Memory = DiffusionMemory;

    fn new(config: &DiffusionConfig, lengths: [usize; 2]) -> Result<Self> {
        if config.n_obs_steps > config.horizon {
            return Err(Error::invalid_param(format!(
                "n_obs_steps is {}, horizon {}; the horizon begins at the oldest observation, so make it longer",
                config.n_obs_steps, config.horizon
            )));
        }
        Ok(Self {
            config: config.clone(),
            schedule: NoiseSchedule::new(config.num_train_timesteps),
            denoiser: Denoiser::new(config, lengths)?,
        })
    }

    fn parameters(&self) -> usize {
        self.denoiser.parameters()
    }

    fn initialise(&self, random: &mut Random, parameters: &mut [f32]) {
        self.denoiser.initialise(random, parameters);
    }

    fn window(&self) -> Window {
        let history = self.config.n_obs_steps;
        Window { history, chunk: self.config.horizon, past: history - 1 }
    }

    fn scaling(rows: &[f32], width: usize) -> Affine {
        Affine::unit_range(rows, width)
    }

    fn optimisation() -> Optimisation {
        let adam = AdamOptions {
            betas: [0.95, 0.999],
            weight_decay: WeightDecay::Decoupled(1e-6),
            ..AdamOptions::default()
        };
        Optimisation { adam, averages: true }
    }

    fn pass(
        &self,
        compute: &Compute,
        parameters: &[f32],
        batch: &Batch,
        random: &mut Random,
        tape: &mut DiffusionTape,
        gradients: &mut [f32],
    ) -> f32 {
        let DiffusionTape { denoiser, levels, noise, chunks, doutput } = tape;
        levels.clear();
        levels.extend(batch.valid.iter().map(|_| random.below(self.schedule.levels())));
        noise.clear();
        noise.extend(batch.actions.iter().map(|_| random.normal() as f32));
        chunks.clear();
        let width = batch.actions.len() / levels.len();
        for (sample, &level) in levels.iter().enumerate() {
            let [signal, spread] = self.schedule.factors(level);
            let range = sample * width..(sample + 1) * width;
            let mixed = batch.actions[range.clone()].iter().zip(&noise[range]);
            chunks.extend(mixed.map(|(action, noise)| signal * action + spread * noise));
        }
        let noisy = Noisy { observations: &batch.observations, levels, chunks };
        let output = self.denoiser.forward(compute, parameters, noisy, denoiser);
        let scale = 1.0 / output.len() as f32;
        doutput.clear();
        let mut sum = 0.0;
        for (output, noise) in output.iter().zip(&*noise) {
            let error = output - noise;
            sum += error * error;
            doutput.push(2.0 * scale * error);
        }
        self.denoiser.backward(compute, parameters, chunks, doutput, denoiser, gradients);
        sum * scale
    }

    fn act(&self, params: &DiffusionParams, memory: &mut DiffusionMemory, step: Acting<'_>) {
        memory.act(self, params, step);
    }

    fn reset(memory: &mut DiffusionMemory) {
        memory.reset();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::transformer::tests::{assert_directions, numbers};

    #[test]
    fn the_loss_has_the_gradient_of_its_parameters() {
        let config = DiffusionConfig {
            horizon: 4,
            diffusion_step_embed_dim: 6,
            cond_dim: 7,
            width: 10,
            n_blocks: 2,
            ..DiffusionConfig::default()
        };
        let network = DiffusionPolicy::new(&config, [3, 2]).unwrap();
        let parameters: Vec<f32> = numbers(network.parameters(), 1).iter().map(|x| 0.4 * x).collect();
        let batch =
            Batch { observations: numbers(3 * 6, 2), actions: numbers(3 * 8, 3), valid: vec![4, 1, 2] };
        let (compute, mut gradients) = (Compute::with_threads(2), vec![0.0; parameters.len()]);
        let mut tape = DiffusionTape::default();
        network.pass(&compute, &parameters, &batch, &mut Random::new(4), &mut tape, &mut gradients);
        let mut ignored = vec![0.0; parameters.len()];
        assert_directions("parameters", &parameters, &gradients, |p| {
            network.pass(&compute, p, &batch, &mut Random::new(4), &mut tape, &mut ignored).into()
        });
    }
}
