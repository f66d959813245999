//! Transformers (Vaswani et al., 2017) on the kernels of `opendr-kernels`.

mod block;
mod initialise;
#[cfg(test)]
pub(crate) mod tests;

use opendr_engine::{Random, Result};
use opendr_kernels::{Compute, LayerNorm, Sequences};

use block::{Block, BlockTape, EPSILON};
pub(crate) use block::{Memory, add};
pub(crate) use initialise::{initialise_dense, initialise_norm, initialise_vectors};

/// Blocks and a last normalisation.
#[derive(Debug, Clone)]
pub(crate) struct Transformer {
    blocks: Vec<Block>,
    norm: LayerNorm,
}

/// Sizes of a [`Transformer`].
#[derive(Debug, Clone, Copy)]
pub(crate) struct TransformerSizes {
    pub size: usize,
    pub heads: usize,
    pub hidden: usize,
    pub layers: usize,
}

/// Values of a forward pass for the backward pass; the memory is reused.
#[derive(Debug, Clone, Default)]
pub(crate) struct TransformerTape {
    blocks: Vec<BlockTape>,
    /// Input of the last normalisation; in the backward pass its gradient goes to `flow`.
    last: Vec<f32>,
    flow: Vec<f32>,
}

impl Transformer {
    /// Creates an encoder, or a decoder, which attends to a memory.
    ///
    /// # Errors
    /// When a size is zero or too large, or the heads do not divide the size.
    pub fn new(sizes: TransformerSizes, decodes: bool) -> Result<Self> {
        let TransformerSizes { size, heads, hidden, layers } = sizes;
        let block = |_| Block::new(size, heads, hidden, decodes);
        Ok(Self {
            blocks: (0..layers).map(block).collect::<Result<_>>()?,
            norm: LayerNorm::new(size, EPSILON)?,
        })
    }

    pub fn parameters(&self) -> usize {
        self.blocks.iter().map(Block::parameters).sum::<usize>() + self.norm.parameters()
    }

    pub fn initialise(&self, random: &mut Random, parameters: &mut [f32]) {
        let mut rest = parameters;
        for block in &self.blocks {
            let own;
            (own, rest) = rest.split_at_mut(block.parameters());
            block.initialise(random, own);
        }
        initialise_norm(rest);
    }

    /// Computes the output in place of `x`, `[batch, tokens, size]`; of each sequence, `lengths` tokens count, all where none are given.
    pub fn forward(
        &self,
        compute: &Compute,
        parameters: &[f32],
        x: &mut [f32],
        sequences: Sequences<'_>,
        memory: Option<Memory<'_>>,
        tape: &mut TransformerTape,
    ) {
        tape.blocks.resize_with(self.blocks.len(), BlockTape::default);
        let mut rest = parameters;
        for (block, tape) in self.blocks.iter().zip(&mut tape.blocks) {
            let own;
            (own, rest) = rest.split_at(block.parameters());
            block.forward(compute, own, x, sequences, memory, tape);
        }
        tape.last.resize(x.len(), 0.0);
        tape.last.copy_from_slice(x);
        self.norm.forward(rest, &tape.last, x);
    }

    /// Computes the backward pass: `dx`, the gradient of the output, becomes that of the input. Adds to `gradients`, and to the gradient
    /// of the memory.
    pub fn backward(
        &self,
        compute: &Compute,
        parameters: &[f32],
        dx: &mut [f32],
        mut memory: Option<(Memory<'_>, &mut [f32])>,
        tape: &mut TransformerTape,
        gradients: &mut [f32],
    ) {
        let mut end = parameters.len() - self.norm.parameters();
        tape.flow.resize(dx.len(), 0.0);
        let own = Some(&mut gradients[end..]);
        self.norm.backward(&parameters[end..], &tape.last, dx, own, Some(&mut tape.flow));
        dx.copy_from_slice(&tape.flow);
        for (block, tape) in self.blocks.iter().zip(&mut tape.blocks).rev() {
            let range = end - block.parameters()..end;
            let memory = memory.as_mut().map(|(memory, flow)| (*memory, &mut **flow));
            block.backward(
                compute,
                &parameters[range.clone()],
                dx,
                memory,
                tape,
                &mut gradients[range.clone()],
            );
            end = range.start;
        }
    }
}
