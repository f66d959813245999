//! The variational encoder of ACT: from demonstrated actions to the latent variable.

use opendr_engine::{Random, Result};
use opendr_kernels::{Activation, Compute, Dense, Embedding, Sequences};

use super::ActConfig;
use crate::batch::Batch;
use crate::parts::{split, split_mut};
use crate::transformer::{Transformer, TransformerTape, initialise_dense, initialise_vectors};

/// Tokens before those of the actions: the one that is read, and the observation.
const BEFORE: usize = 2;

/// Encoder of `[class, observation, actions]`; mean and log-variance of the latent variable are read from the first token.
#[derive(Debug, Clone)]
pub(super) struct Posterior {
    positions: Embedding,
    observation: Dense,
    action: Dense,
    encoder: Transformer,
    latent: Dense,
    chunk: usize,
}

#[derive(Debug, Clone, Default)]
pub(super) struct PosteriorTape {
    tokens: Vec<f32>,
    dtokens: Vec<f32>,
    rows: Vec<f32>,
    drows: Vec<f32>,
    first: Vec<f32>,
    dfirst: Vec<f32>,
    lengths: Vec<usize>,
    /// Mean, then log-variance, of each sample; and their gradient.
    moments: Vec<f32>,
    dmoments: Vec<f32>,
    encoder: TransformerTape,
    noise: Vec<f32>,
}

impl Posterior {
    pub fn new(config: &ActConfig, [observation, action]: [usize; 2]) -> Result<Self> {
        let size = config.dim_model;
        let dense = |inputs, outputs| Dense::new(inputs, outputs, Activation::Identity);
        Ok(Self {
            positions: Embedding::new(BEFORE + config.chunk_size, size)?,
            observation: dense(observation, size)?,
            action: dense(action, size)?,
            encoder: Transformer::new(config.sizes(config.n_vae_encoder_layers), false)?,
            latent: dense(size, 2 * config.latent_dim)?,
            chunk: config.chunk_size,
        })
    }

    /// Returns the numbers of parameters of the parts, in order.
    fn counts(&self) -> [usize; 5] {
        let Self { positions, observation, action, encoder, latent, .. } = self;
        [
            positions.parameters(),
            observation.parameters(),
            action.parameters(),
            encoder.parameters(),
            latent.parameters(),
        ]
    }

    pub fn parameters(&self) -> usize {
        self.counts().iter().sum()
    }

    pub fn initialise(&self, random: &mut Random, parameters: &mut [f32]) {
        let [positions, observation, action, encoder, latent] = split_mut(parameters, self.counts());
        initialise_vectors(1.0, random, positions);
        initialise_dense(&self.observation, random, observation);
        initialise_dense(&self.action, random, action);
        self.encoder.initialise(random, encoder);
        initialise_dense(&self.latent, random, latent);
    }

    /// Draws the latent variables of a batch, `[batch, latent]`, and returns the mean divergence from the normal distribution, in nats.
    pub fn forward(
        &self,
        compute: &Compute,
        parameters: &[f32],
        batch: &Batch,
        random: &mut Random,
        tape: &mut PosteriorTape,
        latents: &mut Vec<f32>,
    ) -> f32 {
        let [positions, observation, action, encoder, latent] = split(parameters, self.counts());
        let (size, tokens) = (self.positions.size(), BEFORE + self.chunk);
        let count = batch.valid.len();
        let PosteriorTape { tokens: x, rows, first, lengths, moments, noise, .. } = tape;
        x.clear();
        x.resize(count * tokens * size, 0.0);
        rows.resize(count * self.chunk * size, 0.0);
        self.action.forward(compute, action, &batch.actions, rows);
        for (x, rows) in x.chunks_exact_mut(tokens * size).zip(rows.chunks_exact(self.chunk * size)) {
            x[BEFORE * size..].copy_from_slice(rows);
        }
        first.resize(count * size, 0.0);
        self.observation.forward(compute, observation, &batch.observations, first);
        for (x, row) in x.chunks_exact_mut(tokens * size).zip(first.chunks_exact(size)) {
            x[size..2 * size].copy_from_slice(row);
        }
        self.positions.add_forward(positions, places(tokens, count), x);
        lengths.clear();
        lengths.extend(batch.valid.iter().map(|valid| BEFORE + valid));
        let sequences = Sequences { queries: tokens, keys: tokens, lengths: Some(lengths) };
        self.encoder.forward(compute, encoder, x, sequences, None, &mut tape.encoder);
        for (x, first) in x.chunks_exact(tokens * size).zip(first.chunks_exact_mut(size)) {
            first.copy_from_slice(&x[..size]);
        }
        moments.resize(count * self.latent.outputs(), 0.0);
        self.latent.forward(compute, latent, first, moments);
        noise.clear();
        latents.clear();
        let mut divergence = 0.0;
        for row in moments.chunks_exact(self.latent.outputs()) {
            let (means, logs) = row.split_at(row.len() / 2);
            for (mean, log) in means.iter().zip(logs) {
                let drawn = random.normal() as f32;
                noise.push(drawn);
                latents.push(mean + (0.5 * log).exp() * drawn);
                divergence += 0.5 * (mean * mean + log.exp() - 1.0 - log);
            }
        }
        divergence / count as f32
    }

    /// Adds the gradients of the parameters, from those of the latent variables and of the mean divergence.
    pub fn backward(
        &self,
        compute: &Compute,
        parameters: &[f32],
        batch: &Batch,
        (dlatents, weight): (&[f32], f32),
        tape: &mut PosteriorTape,
        gradients: &mut [f32],
    ) {
        let [_, observation, action, encoder, latent] = split(parameters, self.counts());
        let [dpositions, dobservation, daction, dencoder, dlatent] = split_mut(gradients, self.counts());
        let (size, tokens, count) = (self.positions.size(), BEFORE + self.chunk, batch.valid.len());
        let PosteriorTape {
            tokens: x, dtokens, rows, drows, first, dfirst, moments, dmoments, noise, ..
        } = tape;
        dmoments.resize(moments.len(), 0.0);
        let weight = weight / count as f32;
        let width = self.latent.outputs();
        let rows_of = moments.chunks_exact(width).zip(dmoments.chunks_exact_mut(width));
        let half = width / 2;
        for ((row, down), (noise, dlatent)) in
            rows_of.zip(noise.chunks_exact(half).zip(dlatents.chunks_exact(half)))
        {
            for at in 0..half {
                let (mean, log) = (row[at], row[half + at]);
                down[at] = dlatent[at] + weight * mean;
                down[half + at] =
                    0.5 * dlatent[at] * noise[at] * (0.5 * log).exp() + 0.5 * weight * (log.exp() - 1.0);
            }
        }
        dfirst.resize(first.len(), 0.0);
        self.latent.backward(compute, latent, [first, moments], dmoments, Some(dlatent), Some(dfirst));
        dtokens.clear();
        dtokens.resize(x.len(), 0.0);
        for (down, dfirst) in dtokens.chunks_exact_mut(tokens * size).zip(dfirst.chunks_exact(size)) {
            down[..size].copy_from_slice(dfirst);
        }
        self.encoder.backward(compute, encoder, dtokens, None, &mut tape.encoder, dencoder);
        self.positions.backward(places(tokens, count), dtokens, dpositions);
        drows.clear();
        for (down, dfirst) in dtokens.chunks_exact(tokens * size).zip(dfirst.chunks_exact_mut(size)) {
            dfirst.copy_from_slice(&down[size..2 * size]);
            drows.extend_from_slice(&down[BEFORE * size..]);
        }
        let ends = [&batch.observations[..], first];
        self.observation.backward(compute, observation, ends, dfirst, Some(dobservation), None);
        self.action.backward(compute, action, [&batch.actions, rows], drows, Some(daction), None);
    }
}

/// Returns the positions of the tokens of `count` sequences.
pub(super) fn places(tokens: usize, count: usize) -> impl ExactSizeIterator<Item = usize> {
    (0..tokens * count).map(move |token| token % tokens)
}
