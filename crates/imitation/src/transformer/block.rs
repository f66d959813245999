//! A block of a transformer.

use std::ops::Range;

use opendr_engine::{Random, Result};
use opendr_kernels::{Activation, AttentionTape, Compute, Dense, LayerNorm, MultiHeadAttention, Sequences};

use super::initialise::{initialise_dense, initialise_norm};

/// A block with normalisation before each part (Xiong et al., 2020): self-attention, in a decoder attention to a memory, and two dense
/// layers, each added to its input.
#[derive(Debug, Clone)]
pub(crate) struct Block {
    norm: LayerNorm,
    attention: MultiHeadAttention,
    /// Whether it attends to a memory.
    decodes: bool,
    feed: [Dense; 2],
}

/// Values of a forward pass for the backward pass; the memory is reused.
#[derive(Debug, Clone, Default)]
pub(crate) struct BlockTape {
    own: AttentionTape,
    cross: AttentionTape,
    /// Input of each part, and the same after normalisation.
    inputs: [Vec<f32>; 3],
    normed: [Vec<f32>; 3],
    hidden: Vec<f32>,
    /// Output of a part; in the backward pass its gradient.
    branch: Vec<f32>,
    dhidden: Vec<f32>,
    dnormed: Vec<f32>,
    dinput: Vec<f32>,
}

/// The sequence that a decoder attends to.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Memory<'a> {
    /// `[batch, tokens, size]`.
    pub values: &'a [f32],
    /// Tokens per sequence.
    pub tokens: usize,
}

/// Places of the three parts of a block.
const OWN: usize = 0;
const CROSS: usize = 1;
const FEED: usize = 2;
/// Adaptation of the standard deviation; PyTorch's default.
pub(super) const EPSILON: f32 = 1e-5;

impl Block {
    pub fn new(size: usize, heads: usize, hidden: usize, decodes: bool) -> Result<Self> {
        Ok(Self {
            norm: LayerNorm::new(size, EPSILON)?,
            attention: MultiHeadAttention::new(size, heads)?,
            decodes,
            feed: [
                Dense::new(size, hidden, Activation::Relu)?,
                Dense::new(hidden, size, Activation::Identity)?,
            ],
        })
    }

    pub fn parameters(&self) -> usize {
        self.range(FEED).end
    }

    /// Returns the parameters of a part, its normalisation included.
    fn range(&self, part: usize) -> Range<usize> {
        let attention = self.norm.parameters() + self.attention.parameters();
        let cross = if self.decodes { 2 * attention } else { attention };
        match part {
            OWN => 0..attention,
            CROSS => attention..cross,
            _ => {
                let feed: usize = self.feed.iter().map(Dense::parameters).sum();
                cross..cross + self.norm.parameters() + feed
            }
        }
    }

    /// Returns the parts of which the block consists.
    fn parts(&self) -> &'static [usize] {
        if self.decodes { &[OWN, CROSS, FEED] } else { &[OWN, FEED] }
    }

    pub fn initialise(&self, random: &mut Random, parameters: &mut [f32]) {
        for &part in self.parts() {
            let (norm, mut rest) = parameters[self.range(part)].split_at_mut(self.norm.parameters());
            initialise_norm(norm);
            let dense = if part == FEED { self.feed.to_vec() } else { self.attention.projections().to_vec() };
            for layer in dense {
                let own;
                (own, rest) = rest.split_at_mut(layer.parameters());
                initialise_dense(&layer, random, own);
            }
        }
    }

    /// Computes the block in place of `x`, `[batch, tokens, size]`. Of each sequence, `lengths` tokens count.
    pub fn forward(
        &self,
        compute: &Compute,
        parameters: &[f32],
        x: &mut [f32],
        own: Sequences<'_>,
        memory: Option<Memory<'_>>,
        tape: &mut BlockTape,
    ) {
        tape.branch.resize(x.len(), 0.0);
        for &part in self.parts() {
            let BlockTape { inputs, normed, branch, hidden, .. } = tape;
            let (of_norm, of_part) = parameters[self.range(part)].split_at(self.norm.parameters());
            inputs[part].resize(x.len(), 0.0);
            inputs[part].copy_from_slice(x);
            normed[part].resize(x.len(), 0.0);
            self.norm.forward(of_norm, x, &mut normed[part]);
            let from = &normed[part];
            match (part, memory) {
                (OWN, _) => {
                    self.attention.forward(compute, of_part, [from, from], own, &mut tape.own, branch);
                }
                (CROSS, Some(memory)) => {
                    let sequences = Sequences { queries: own.queries, keys: memory.tokens, lengths: None };
                    let both = [from, memory.values];
                    self.attention.forward(compute, of_part, both, sequences, &mut tape.cross, branch);
                }
                _ => {
                    let (first, second) = of_part.split_at(self.feed[0].parameters());
                    hidden.resize(from.len() / self.feed[0].inputs() * self.feed[0].outputs(), 0.0);
                    self.feed[0].forward(compute, first, from, hidden);
                    self.feed[1].forward(compute, second, hidden, branch);
                }
            }
            add(x, branch);
        }
    }

    /// Computes the backward pass: `dx`, the gradient of the output, becomes that of the input. Adds to `gradients`, and to `dmemory`
    /// in a decoder.
    pub fn backward(
        &self,
        compute: &Compute,
        parameters: &[f32],
        dx: &mut [f32],
        memory: Option<(Memory<'_>, &mut [f32])>,
        tape: &mut BlockTape,
        gradients: &mut [f32],
    ) {
        let mut memory = memory;
        tape.dinput.resize(dx.len(), 0.0);
        for &part in self.parts().iter().rev() {
            let BlockTape { inputs, normed, hidden, branch, dhidden, dnormed, dinput, .. } = tape;
            let (of_norm, of_part) = parameters[self.range(part)].split_at(self.norm.parameters());
            let (norm_gradients, own) = gradients[self.range(part)].split_at_mut(self.norm.parameters());
            branch.copy_from_slice(dx);
            let from = &normed[part];
            dnormed.resize(dx.len(), 0.0);
            match (part, &mut memory) {
                (OWN, _) => {
                    let both = [&from[..], from];
                    let [dquery, dtokens] =
                        self.attention.backward(compute, of_part, both, branch, &mut tape.own, own);
                    dnormed.copy_from_slice(dquery);
                    add(dnormed, dtokens);
                }
                (CROSS, Some((memory, dmemory))) => {
                    let both = [&from[..], memory.values];
                    let [dquery, dtokens] =
                        self.attention.backward(compute, of_part, both, branch, &mut tape.cross, own);
                    dnormed.copy_from_slice(dquery);
                    add(dmemory, dtokens);
                }
                _ => {
                    let (first, second) = of_part.split_at(self.feed[0].parameters());
                    let (first_gradients, second_gradients) = own.split_at_mut(first.len());
                    dhidden.resize(hidden.len(), 0.0);
                    self.feed[1].backward(
                        compute,
                        second,
                        [hidden, &inputs[part]],
                        branch,
                        Some(second_gradients),
                        Some(dhidden),
                    );
                    let ends = [&from[..], hidden];
                    self.feed[0].backward(
                        compute,
                        first,
                        ends,
                        dhidden,
                        Some(first_gradients),
                        Some(dnormed),
                    );
                }
            }
            self.norm.backward(of_norm, &inputs[part], dnormed, Some(norm_gradients), Some(dinput));
            add(dx, dinput);
        }
    }
}

/// Adds the numbers of `other` to those of `to`.
pub(crate) fn add(to: &mut [f32], other: &[f32]) {
    to.iter_mut().zip(other).for_each(|(to, other)| *to += other);
}
