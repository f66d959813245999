//! ACT: action chunking with transformers (Zhao et al., 2023), for observations of numbers.

mod config;
mod ensemble;
mod network;
mod posterior;

use opendr_engine::learner::Spec;
use opendr_engine::{Random, Result, Task};
use opendr_kernels::{AdamOptions, Compute, WeightDecay};

pub use config::{ActConfig, ActParams};
pub use ensemble::ActMemory;
use network::{Decoder, DecoderTape};
use posterior::{Posterior, PosteriorTape};

use crate::affine::Affine;
use crate::batch::{Batch, Window};
use crate::method::{Acting, ChunkMethod, Optimisation};

/// ACT: a transformer that predicts the next actions from an observation and a latent variable, which stands for the style of a
/// demonstration: a variational encoder gives it in training, and it is zero when the policy acts.
///
/// It follows the paper with three differences: blocks normalise before each part, not after; there is no dropout; and observation and
/// latent variable are the only tokens of the encoder, since there are no images.
#[derive(Debug, Clone)]
pub struct Act {
    config: ActConfig,
    posterior: Option<Posterior>,
    decoder: Decoder,
}

/// Work memory of the training of [`Act`].
#[derive(Debug, Clone, Default)]
pub struct ActTape {
    posterior: PosteriorTape,
    decoder: DecoderTape,
    latents: Vec<f32>,
    dlatents: Vec<f32>,
    doutput: Vec<f32>,
}

#[allow(private_interfaces, reason = "as the trait")]
impl ChunkMethod for Act {
    const SPEC: Spec = Spec::new("act", Task::ReinforcementLearning)
        .class("ActLearner")
        .about("Action chunking with transformers: imitates demonstrations, several actions per prediction.");
    type Config = ActConfig;
    type Params = ActParams;
    type Tape = ActTape;
    type Memory = ActMemory;

    fn new(config: &ActConfig, lengths: [usize; 2]) -> Result<Self> {
        let posterior = config.use_vae.then(|| Posterior::new(config, lengths)).transpose()?;
        Ok(Self { config: config.clone(), posterior, decoder: Decoder::new(config, lengths)? })
    }

    fn parameters(&self) -> usize {
        self.decoder.parameters() + self.posterior.as_ref().map_or(0, Posterior::parameters)
    }

    fn initialise(&self, random: &mut Random, parameters: &mut [f32]) {
        let (decoder, posterior) = parameters.split_at_mut(self.decoder.parameters());
        self.decoder.initialise(random, decoder);
        if let Some(network) = &self.posterior {
            network.initialise(random, posterior);
        }
    }

    fn window(&self) -> Window {
        Window { history: 1, chunk: self.config.chunk_size, past: 0 }
    }

    fn scaling(rows: &[f32], width: usize) -> Affine {
        Affine::standard(rows, width)
    }

    fn optimisation() -> Optimisation {
        let weight_decay = WeightDecay::Decoupled(1e-4);
        Optimisation { adam: AdamOptions { weight_decay, ..AdamOptions::default() }, averages: false }
    }

    fn pass(
        &self,
        compute: &Compute,
        parameters: &[f32],
        batch: &Batch,
        random: &mut Random,
        tape: &mut ActTape,
        gradients: &mut [f32],
    ) -> f32 {
        let (decoder, posterior) = parameters.split_at(self.decoder.parameters());
        let (decoder_gradients, posterior_gradients) = gradients.split_at_mut(decoder.len());
        let ActTape { posterior: posterior_tape, decoder: decoder_tape, latents, dlatents, doutput } = tape;
        latents.clear();
        latents.resize(batch.valid.len() * self.config.latent_dim, 0.0);
        let divergence = self.posterior.as_ref().map_or(0.0, |network| {
            network.forward(compute, posterior, batch, random, posterior_tape, latents)
        });
        let output = self.decoder.forward(compute, decoder, [&batch.observations, latents], decoder_tape);
        let loss = absolute_error(output, batch, self.config.chunk_size, doutput);
        let inputs = [&batch.observations[..], latents];
        let down = self.decoder.backward(compute, decoder, inputs, doutput, decoder_tape, decoder_gradients);
        if let Some(network) = &self.posterior {
            dlatents.clear();
            dlatents.extend_from_slice(down);
            let flow = (&dlatents[..], self.config.kl_weight);
            network.backward(compute, posterior, batch, flow, posterior_tape, posterior_gradients);
        }
        loss + self.config.kl_weight * divergence
    }

    fn act(&self, params: &ActParams, memory: &mut ActMemory, step: Acting<'_>) {
        let decoder = &step.parameters[..self.decoder.parameters()];
        memory.act(&self.decoder, params, step.compute, decoder, step.observation, step.action);
    }

    fn reset(memory: &mut ActMemory) {
        memory.reset();
    }
}

/// Returns the mean absolute error of the actions within the episodes, and computes its gradient.
fn absolute_error(output: &[f32], batch: &Batch, chunk: usize, doutput: &mut Vec<f32>) -> f32 {
    let width = output.len() / (batch.valid.len() * chunk);
    let count = batch.valid.iter().sum::<usize>() * width;
    let scale = 1.0 / count.max(1) as f32;
    doutput.clear();
    doutput.resize(output.len(), 0.0);
    let mut sum = 0.0;
    for (sample, valid) in batch.valid.iter().enumerate() {
        let range = sample * chunk * width..(sample * chunk + valid) * width;
        for ((output, action), down) in
            output[range.clone()].iter().zip(&batch.actions[range.clone()]).zip(&mut doutput[range])
        {
            let error = output - action;
            sum += error.abs();
            *down = if error == 0.0 { 0.0 } else { scale * error.signum() };
        }
    }
    sum * scale
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::transformer::tests::{assert_directions, numbers};

    #[test]
    fn the_loss_has_the_gradient_of_its_parameters() {
        let config = ActConfig {
            chunk_size: 3,
            dim_model: 8,
            n_heads: 2,
            dim_feedforward: 12,
            latent_dim: 2,
            kl_weight: 0.3,
            ..ActConfig::default()
        };
        let network = Act::new(&config, [4, 2]).unwrap();
        let mut parameters = vec![0.0; network.parameters()];
        network.initialise(&mut Random::new(1), &mut parameters);
        let batch = Batch { observations: numbers(12, 2), actions: numbers(18, 3), valid: vec![3, 1, 2] };
        let (compute, mut gradients) = (Compute::with_threads(2), vec![0.0; parameters.len()]);
        let mut tape = ActTape::default();
        network.pass(&compute, &parameters, &batch, &mut Random::new(4), &mut tape, &mut gradients);
        let mut ignored = vec![0.0; parameters.len()];
        assert_directions("parameters", &parameters, &gradients, |p| {
            network.pass(&compute, p, &batch, &mut Random::new(4), &mut tape, &mut ignored).into()
        });
    }
}
