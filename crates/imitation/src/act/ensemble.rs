//! How ACT acts: a temporal ensemble of its predictions, or one chunk after the other.

use opendr_kernels::Compute;

use super::ActParams;
use super::network::{Decoder, DecoderTape};

/// State of a controller: the chunks that were predicted in this episode.
#[derive(Debug, Clone, Default)]
pub struct ActMemory {
    tape: DecoderTape,
    /// The latent variable, zero.
    latent: Vec<f32>,
    /// The last chunks, `[chunk, chunk, action]`; that of step t is in place t modulo chunk.
    chunks: Vec<f32>,
    /// Steps so far, and the step of the last prediction.
    steps: usize,
    predicted: usize,
}

impl ActMemory {
    pub(super) fn reset(&mut self) {
        self.steps = 0;
        self.predicted = 0;
    }

    /// Writes the next action for an observation.
    pub(super) fn act(
        &mut self,
        decoder: &Decoder,
        params: &ActParams,
        compute: &Compute,
        parameters: &[f32],
        observation: &[f32],
        action: &mut [f32],
    ) {
        let (step, chunk) = (self.steps, decoder.chunk());
        let row = chunk * action.len();
        let executed = params.n_action_steps.clamp(1, chunk);
        if step == 0 || params.temporal_ensemble || step - self.predicted >= executed {
            self.latent.resize(decoder.latent_len(), 0.0);
            self.chunks.resize(chunk * row, 0.0);
            let inputs = [observation, &self.latent];
            let output = decoder.forward(compute, parameters, inputs, &mut self.tape);
            self.chunks[step % chunk * row..][..row].copy_from_slice(output);
            self.predicted = step;
        }
        match params.temporal_ensemble {
            true => self.average(chunk, params.temporal_ensemble_coeff, action),
            false => {
                let at = self.predicted % chunk * row + (step - self.predicted) * action.len();
                action.copy_from_slice(&self.chunks[at..][..action.len()]);
            }
        }
        self.steps += 1;
    }

    /// Writes the weighted mean of all predictions for this step, as the paper's algorithm 2.
    fn average(&self, chunk: usize, coefficient: f32, action: &mut [f32]) {
        let oldest = (self.steps + 1).saturating_sub(chunk);
        let width = action.len();
        let mut sum = 0.0;
        action.fill(0.0);
        for (age, step) in (oldest..=self.steps).enumerate() {
            let weight = (-coefficient * age as f32).exp();
            let at = (step % chunk * chunk + self.steps - step) * width;
            sum += weight;
            action.iter_mut().zip(&self.chunks[at..]).for_each(|(action, own)| *action += weight * own);
        }
        action.iter_mut().for_each(|action| *action /= sum);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn older_predictions_weigh_more() {
        // Chunks of two actions of one number: step 0 predicted 1 and 2, step 1 predicted 4 and 5.
        let memory = ActMemory { chunks: vec![1.0, 2.0, 4.0, 5.0], steps: 1, ..ActMemory::default() };
        let mut action = [0.0];
        memory.average(2, 1.0, &mut action);
        let weight = (-1.0f32).exp();
        assert!((action[0] - (2.0 + 4.0 * weight) / (1.0 + weight)).abs() < 1e-6, "{action:?}");
        let memory = ActMemory { steps: 2, ..memory };
        memory.average(2, 0.0, &mut action);
        assert_eq!(action, [0.5 * (5.0 + 1.0)]);
    }
}
