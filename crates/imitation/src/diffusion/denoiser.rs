//! The network that predicts the noise in a chunk of actions.

use opendr_engine::{Error, Random, Result};
use opendr_kernels::{Activation, Compute, Dense, Gelu, LayerNorm};

use super::DiffusionConfig;
use super::modulated::{Modulated, ModulatedTape};
use crate::parts::{split, split_mut};
use crate::transformer::{initialise_dense, initialise_norm};

/// A network of residual blocks on the whole chunk, modulated by observations and noise level.
#[derive(Debug, Clone)]
pub(super) struct Denoiser {
    /// Two layers of the condition.
    condition: [Dense; 2],
    first: Dense,
    blocks: Vec<Modulated>,
    norm: LayerNorm,
    last: Dense,
    embedding: usize,
}

#[derive(Debug, Clone, Default)]
pub(super) struct DenoiserTape {
    /// Observations, and the embedding of the level.
    given: Vec<f32>,
    /// Values of the condition before and after each of its activations, and their gradients.
    before: [Vec<f32>; 2],
    after: [Vec<f32>; 2],
    dbefore: [Vec<f32>; 2],
    x: Vec<f32>,
    normed: Vec<f32>,
    output: Vec<f32>,
    dnormed: Vec<f32>,
    dx: Vec<f32>,
    start: Vec<f32>,
    blocks: Vec<ModulatedTape>,
}

/// Noisy chunks with the observations and noise levels that they belong to.
#[derive(Debug, Clone, Copy)]
pub(super) struct Noisy<'a> {
    /// `[batch, history, observation]`.
    pub observations: &'a [f32],
    /// `[batch]`.
    pub levels: &'a [usize],
    /// `[batch, chunk, action]`.
    pub chunks: &'a [f32],
}

impl Denoiser {
    pub fn new(config: &DiffusionConfig, [observation, action]: [usize; 2]) -> Result<Self> {
        if !config.diffusion_step_embed_dim.is_multiple_of(2) {
            return Err(Error::invalid_param(format!(
                "diffusion_step_embed_dim is {}; give an even number",
                config.diffusion_step_embed_dim
            )));
        }
        let dense = |inputs, outputs| Dense::new(inputs, outputs, Activation::Identity);
        let given =
            config.n_obs_steps.saturating_mul(observation).saturating_add(config.diffusion_step_embed_dim);
        let chunk = config.horizon.saturating_mul(action);
        let (width, size) = (config.width, config.cond_dim);
        Ok(Self {
            condition: [dense(given, size)?, dense(size, size)?],
            first: dense(chunk, width)?,
            blocks: (0..config.n_blocks).map(|_| Modulated::new(width, size)).collect::<Result<_>>()?,
            norm: LayerNorm::new(width, 1e-5)?,
            last: dense(width, chunk)?,
            embedding: config.diffusion_step_embed_dim,
        })
    }

    /// Returns the numbers of parameters of the parts, in order.
    fn counts(&self) -> [usize; 6] {
        let [inner, outer] = self.condition.map(|layer| layer.parameters());
        let blocks = self.blocks.iter().map(Modulated::parameters).sum();
        [inner, outer, self.first.parameters(), blocks, self.norm.parameters(), self.last.parameters()]
    }

    pub fn parameters(&self) -> usize {
        self.counts().iter().sum()
    }

    pub fn initialise(&self, random: &mut Random, parameters: &mut [f32]) {
        let [inner, outer, first, mut blocks, norm, last] = split_mut(parameters, self.counts());
        initialise_dense(&self.condition[0], random, inner);
        initialise_dense(&self.condition[1], random, outer);
        initialise_dense(&self.first, random, first);
        for block in &self.blocks {
            let own;
            (own, blocks) = blocks.split_at_mut(block.parameters());
            block.initialise(random, own);
        }
        initialise_norm(norm);
        // The prediction starts at zero, the mean of the noise.
        last.fill(0.0);
    }

    /// Predicts the noise, of the shape of the chunks.
    pub fn forward<'t>(
        &self,
        compute: &Compute,
        parameters: &[f32],
        noisy: Noisy<'_>,
        tape: &'t mut DenoiserTape,
    ) -> &'t [f32] {
        let [inner, outer, first, mut blocks, norm, last] = split(parameters, self.counts());
        let batch = noisy.levels.len();
        self.give(noisy, &mut tape.given);
        let DenoiserTape { given, before, after, x, normed, output, .. } = tape;
        for values in before.iter_mut().chain(&mut *after) {
            values.resize(batch * self.condition[0].outputs(), 0.0);
        }
        self.condition[0].forward(compute, inner, given, &mut before[0]);
        Gelu.forward(compute, &before[0], &mut after[0]);
        self.condition[1].forward(compute, outer, &after[0], &mut before[1]);
        Gelu.forward(compute, &before[1], &mut after[1]);
        x.resize(batch * self.first.outputs(), 0.0);
        self.first.forward(compute, first, noisy.chunks, x);
        tape.start.resize(x.len(), 0.0);
        tape.start.copy_from_slice(x);
        tape.blocks.resize_with(self.blocks.len(), ModulatedTape::default);
        for (block, tape) in self.blocks.iter().zip(&mut tape.blocks) {
            let own;
            (own, blocks) = blocks.split_at(block.parameters());
            block.forward(compute, own, &after[1], x, tape);
        }
        normed.resize(x.len(), 0.0);
        self.norm.forward(norm, x, normed);
        output.resize(noisy.chunks.len(), 0.0);
        self.last.forward(compute, last, normed, output);
        output
    }

    /// Adds the gradients of the parameters, from that of the last [`Self::forward`]; `doutput` is overwritten.
    pub fn backward(
        &self,
        compute: &Compute,
        parameters: &[f32],
        chunks: &[f32],
        doutput: &mut [f32],
        tape: &mut DenoiserTape,
        gradients: &mut [f32],
    ) {
        let [inner, outer, first, blocks, norm, last] = split(parameters, self.counts());
        let [dinner, douter, dfirst, dblocks, dnorm, dlast] = split_mut(gradients, self.counts());
        let DenoiserTape { given, before, after, dbefore, x, normed, output, dnormed, dx, start, .. } = tape;
        let [down_inner, down_outer] = dbefore;
        dnormed.resize(normed.len(), 0.0);
        dx.resize(x.len(), 0.0);
        self.last.backward(compute, last, [normed, output], doutput, Some(dlast), Some(dnormed));
        self.norm.backward(norm, x, dnormed, Some(dnorm), Some(dx));
        down_outer.clear();
        down_outer.resize(after[1].len(), 0.0);
        let mut end = blocks.len();
        for (block, tape) in self.blocks.iter().zip(&mut tape.blocks).rev() {
            let range = end - block.parameters()..end;
            end = range.start;
            let own = &mut dblocks[range.clone()];
            block.backward(compute, &blocks[range], (&after[1], down_outer), dx, tape, own);
        }
        self.first.backward(compute, first, [chunks, start], dx, Some(dfirst), None);
        Gelu.backward(compute.isa(), &before[1], down_outer);
        down_inner.resize(after[0].len(), 0.0);
        let ends = [&after[0][..], &before[1]];
        self.condition[1].backward(compute, outer, ends, down_outer, Some(douter), Some(down_inner));
        Gelu.backward(compute.isa(), &before[0], down_inner);
        self.condition[0].backward(compute, inner, [given, &before[0]], down_inner, Some(dinner), None);
    }

    /// Writes observations and the sinusoidal embedding of the level, of each sample.
    fn give(&self, noisy: Noisy<'_>, given: &mut Vec<f32>) {
        let width = self.condition[0].inputs() - self.embedding;
        let half = self.embedding / 2;
        given.clear();
        for (observations, &level) in noisy.observations.chunks_exact(width).zip(noisy.levels) {
            given.extend_from_slice(observations);
            let angle = |at: usize| level as f32 * (-(10_000f32.ln()) * at as f32 / half as f32).exp();
            given.extend((0..half).map(|at| angle(at).sin()));
            given.extend((0..half).map(|at| angle(at).cos()));
        }
    }
}
