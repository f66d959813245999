//! The network of ACT that acts: from observation and latent variable to a chunk of actions.

use opendr_engine::{Random, Result};
use opendr_kernels::{Activation, Compute, Dense, Embedding, Sequences};

use super::ActConfig;
use super::posterior::places;
use crate::parts::{split, split_mut};
use crate::transformer::{Memory, Transformer, TransformerTape, initialise_dense, initialise_vectors};

/// Tokens of the encoder: latent variable and observation.
const TOKENS: usize = 2;

/// Encoder of `[latent, observation]`, and decoder of one learned query per action.
#[derive(Debug, Clone)]
pub(super) struct Decoder {
    latent: Dense,
    observation: Dense,
    positions: Embedding,
    encoder: Transformer,
    queries: Embedding,
    decoder: Transformer,
    action: Dense,
}

#[derive(Debug, Clone, Default)]
pub(super) struct DecoderTape {
    memory: Vec<f32>,
    dmemory: Vec<f32>,
    /// Rows of a token, before they are placed among the others; and of the latent variable.
    rows: [Vec<f32>; 2],
    drows: [Vec<f32>; 2],
    tokens: Vec<f32>,
    dtokens: Vec<f32>,
    output: Vec<f32>,
    dlatent: Vec<f32>,
    encoder: TransformerTape,
    decoder: TransformerTape,
}

impl Decoder {
    pub fn new(config: &ActConfig, [observation, action]: [usize; 2]) -> Result<Self> {
        let size = config.dim_model;
        let dense = |inputs, outputs| Dense::new(inputs, outputs, Activation::Identity);
        Ok(Self {
            latent: dense(config.latent_dim, size)?,
            observation: dense(observation, size)?,
            positions: Embedding::new(TOKENS, size)?,
            encoder: Transformer::new(config.sizes(config.n_encoder_layers), false)?,
            queries: Embedding::new(config.chunk_size, size)?,
            decoder: Transformer::new(config.sizes(config.n_decoder_layers), true)?,
            action: dense(size, action)?,
        })
    }

    /// Returns the numbers of parameters of the parts, in order.
    fn counts(&self) -> [usize; 7] {
        [
            self.latent.parameters(),
            self.observation.parameters(),
            self.positions.parameters(),
            self.encoder.parameters(),
            self.queries.parameters(),
            self.decoder.parameters(),
            self.action.parameters(),
        ]
    }

    pub fn parameters(&self) -> usize {
        self.counts().iter().sum()
    }

    /// Returns the number of actions of a chunk.
    pub fn chunk(&self) -> usize {
        self.queries.count()
    }

    /// Returns the numbers of a latent variable.
    pub fn latent_len(&self) -> usize {
        self.latent.inputs()
    }

    pub fn initialise(&self, random: &mut Random, parameters: &mut [f32]) {
        let [latent, observation, positions, encoder, queries, decoder, action] =
            split_mut(parameters, self.counts());
        initialise_dense(&self.latent, random, latent);
        initialise_dense(&self.observation, random, observation);
        initialise_vectors(1.0, random, positions);
        self.encoder.initialise(random, encoder);
        initialise_vectors(1.0, random, queries);
        self.decoder.initialise(random, decoder);
        initialise_dense(&self.action, random, action);
    }

    /// Predicts the chunks of actions, `[batch, chunk, action]`, of observations and latent variables.
    pub fn forward<'t>(
        &self,
        compute: &Compute,
        parameters: &[f32],
        [observations, latents]: [&[f32]; 2],
        tape: &'t mut DecoderTape,
    ) -> &'t [f32] {
        let [latent, observation, positions, encoder, queries, decoder, action] =
            split(parameters, self.counts());
        let size = self.positions.size();
        let count = observations.len() / self.observation.inputs();
        let DecoderTape { memory, rows: [first, second], tokens, output, .. } = tape;
        first.resize(count * size, 0.0);
        second.resize(count * size, 0.0);
        self.latent.forward(compute, latent, latents, first);
        self.observation.forward(compute, observation, observations, second);
        memory.clear();
        for (first, second) in first.chunks_exact(size).zip(second.chunks_exact(size)) {
            memory.extend_from_slice(first);
            memory.extend_from_slice(second);
        }
        self.positions.add_forward(positions, places(TOKENS, count), memory);
        let own = Sequences { queries: TOKENS, keys: TOKENS, lengths: None };
        self.encoder.forward(compute, encoder, memory, own, None, &mut tape.encoder);
        tokens.clear();
        tokens.resize(count * self.chunk() * size, 0.0);
        self.queries.add_forward(queries, places(self.chunk(), count), tokens);
        let own = Sequences { queries: self.chunk(), keys: self.chunk(), lengths: None };
        let memory = Some(Memory { values: memory, tokens: TOKENS });
        self.decoder.forward(compute, decoder, tokens, own, memory, &mut tape.decoder);
        output.resize(count * self.chunk() * self.action.outputs(), 0.0);
        self.action.forward(compute, action, tokens, output);
        output
    }

    /// Adds the gradients of the parameters, and returns that of the latent variables. `doutput` is overwritten.
    pub fn backward<'t>(
        &self,
        compute: &Compute,
        parameters: &[f32],
        [observations, latents]: [&[f32]; 2],
        doutput: &mut [f32],
        tape: &'t mut DecoderTape,
        gradients: &mut [f32],
    ) -> &'t [f32] {
        let [latent, observation, _, encoder, _, decoder, action] = split(parameters, self.counts());
        let [dlatent, dobservation, dpositions, dencoder, dqueries, ddecoder, daction] =
            split_mut(gradients, self.counts());
        let size = self.positions.size();
        let DecoderTape { memory, dmemory, rows, drows: [first, second], tokens, dtokens, output, .. } = tape;
        dtokens.resize(tokens.len(), 0.0);
        self.action.backward(compute, action, [tokens, output], doutput, Some(daction), Some(dtokens));
        dmemory.clear();
        dmemory.resize(memory.len(), 0.0);
        let seen = Some((Memory { values: memory, tokens: TOKENS }, &mut dmemory[..]));
        self.decoder.backward(compute, decoder, dtokens, seen, &mut tape.decoder, ddecoder);
        let count = memory.len() / (TOKENS * size);
        self.queries.backward(places(self.chunk(), count), dtokens, dqueries);
        self.encoder.backward(compute, encoder, dmemory, None, &mut tape.encoder, dencoder);
        self.positions.backward(places(TOKENS, count), dmemory, dpositions);
        first.clear();
        second.clear();
        for pair in dmemory.chunks_exact(TOKENS * size) {
            first.extend_from_slice(&pair[..size]);
            second.extend_from_slice(&pair[size..]);
        }
        let ends = [observations, &rows[1]];
        self.observation.backward(compute, observation, ends, second, Some(dobservation), None);
        tape.dlatent.resize(latents.len(), 0.0);
        let ends = [latents, &rows[0]];
        self.latent.backward(compute, latent, ends, first, Some(dlatent), Some(&mut tape.dlatent));
        &tape.dlatent
    }
}
