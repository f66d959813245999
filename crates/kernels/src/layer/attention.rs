use opendr_engine::{Error, Result};

use super::checked_size;
use crate::elementary::exp_in_place;
use crate::pool::Pieces;
use crate::{Activation, Compute, Dense, Isa, Matrix, MatrixMut, Product};

/// Multi-head attention (Vaswani et al., 2017): `y = concat(softmax(Q K' / sqrt(d)) V) Wo + bo`, where the queries Q come from one
/// sequence of tokens, keys K and values V from another one, or from the same (self-attention); d is the size of a head.
///
/// Parameters: of the [`Dense`] layers of Q `[size, size]`, of K and V together `[size, 2 size]`, and of the output `[size, size]`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct MultiHeadAttention {
    size: usize,
    heads: usize,
    query: Dense,
    memory: Dense,
    output: Dense,
}

/// Lengths of the sequences of a batch.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Sequences<'a> {
    /// Tokens per sequence that make queries.
    pub queries: usize,
    /// Tokens per sequence that make keys and values.
    pub keys: usize,
    /// For each sequence how many of its keys count, from the first; the others are padding. None where all count.
    pub lengths: Option<&'a [usize]>,
}

/// Values of a forward pass for the backward pass; the memory is reused, so that only the first passes allocate.
#[derive(Debug, Clone, Default)]
pub struct AttentionTape {
    /// Tokens of each sequence that make queries, and keys.
    tokens: [usize; 2],
    /// Keys that count, of each sequence.
    lengths: Vec<usize>,
    queries: Vec<f32>,
    /// Keys, then values, of each token.
    memory: Vec<f32>,
    /// `[batch, heads, queries, keys]`; zero for padding.
    probabilities: Vec<f32>,
    context: Vec<f32>,
    /// Gradients of the four above.
    dqueries: Vec<f32>,
    dmemory: Vec<f32>,
    dprobabilities: Vec<f32>,
    dcontext: Vec<f32>,
    /// Gradients of the tokens.
    dinputs: [Vec<f32>; 2],
}

impl MultiHeadAttention {
    /// Creates a layer for tokens of `size` numbers.
    ///
    /// # Errors
    /// When a size is zero or too large, or `size` is not a multiple of `heads`.
    pub fn new(size: usize, heads: usize) -> Result<Self> {
        checked_size("attention", &[size, size, 2, heads])?;
        if !size.is_multiple_of(heads) {
            return Err(Error::invalid_param(format!(
                "attention of size {size} cannot be divided into {heads} heads; give a size that is a multiple of the heads"
            )));
        }
        let dense = |outputs| Dense::new(size, outputs, Activation::Identity);
        Ok(Self { size, heads, query: dense(size)?, memory: dense(2 * size)?, output: dense(size)? })
    }

    /// Returns the number of values per token.
    pub fn size(&self) -> usize {
        self.size
    }

    /// Returns the dense layers of queries, of keys and values, and of the output.
    pub fn projections(&self) -> [Dense; 3] {
        [self.query, self.memory, self.output]
    }

    /// Returns the number of parameters.
    pub fn parameters(&self) -> usize {
        self.projections().iter().map(Dense::parameters).sum()
    }

    /// Computes `y` `[batch, queries, size]` from the tokens of the queries `[batch, queries, size]` and of the memory
    /// `[batch, keys, size]`.
    ///
    /// # Panics
    /// When a length does not match, or a sequence has no key.
    pub fn forward(
        &self,
        compute: &Compute,
        parameters: &[f32],
        [query, memory]: [&[f32]; 2],
        sequences: Sequences<'_>,
        tape: &mut AttentionTape,
        y: &mut [f32],
    ) {
        tape.prepare(self, [query.len(), memory.len()], sequences);
        let [of_query, of_memory, of_output] = self.split(parameters);
        self.query.forward(compute, of_query, query, &mut tape.queries);
        self.memory.forward(compute, of_memory, memory, &mut tape.memory);
        let [queries, keys] = tape.tokens;
        let AttentionTape { probabilities, context, .. } = tape;
        let [probabilities, context] = [
            Pieces::new(probabilities, self.heads * queries * keys),
            Pieces::new(context, queries * self.size),
        ];
        let (from, memory, lengths) = (&tape.queries, &tape.memory, &tape.lengths);
        compute.pool().run(lengths.len(), |sample| {
            // SAFETY: each sample is taken once.
            let (probabilities, context) = unsafe { (probabilities.get(sample), context.get(sample)) };
            let sample = Sample {
                layer: self,
                queries: &from[sample * queries * self.size..][..queries * self.size],
                memory: &memory[sample * keys * 2 * self.size..][..keys * 2 * self.size],
                keys,
                length: lengths[sample],
            };
            sample.attend(compute, probabilities, context);
        });
        self.output.forward(compute, of_output, &tape.context, y);
    }

    /// Computes the backward pass of the last [`Self::forward`] on this tape, from `dy`, the gradient of its output: adds to
    /// `gradients`, and returns the gradients of the tokens of queries and memory. In self-attention the gradient of the tokens is
    /// their sum.
    ///
    /// # Panics
    /// When a length does not match.
    pub fn backward<'t>(
        &self,
        compute: &Compute,
        parameters: &[f32],
        [query, memory]: [&[f32]; 2],
        dy: &mut [f32],
        tape: &'t mut AttentionTape,
        gradients: &mut [f32],
    ) -> [&'t [f32]; 2] {
        let [of_query, of_memory, of_output] = self.split(parameters);
        let (own, output_gradients) = gradients.split_at_mut(of_query.len() + of_memory.len());
        let (query_gradients, memory_gradients) = own.split_at_mut(of_query.len());
        tape.prepare_gradients([query.len(), memory.len()]);
        let AttentionTape { context, dcontext, .. } = tape;
        self.output.backward(
            compute,
            of_output,
            [context, context],
            dy,
            Some(output_gradients),
            Some(dcontext),
        );
        let [queries, keys] = tape.tokens;
        let AttentionTape { dqueries, dmemory, dprobabilities, .. } = tape;
        let dqueries = Pieces::new(dqueries, queries * self.size);
        let dmemory = Pieces::new(dmemory, keys * 2 * self.size);
        let dprobabilities = Pieces::new(dprobabilities, self.heads * queries * keys);
        let (from, all, lengths) = (&tape.queries, &tape.memory, &tape.lengths);
        let (probabilities, dcontext) = (&tape.probabilities, &tape.dcontext);
        compute.pool().run(lengths.len(), |index| {
            // SAFETY: each sample is taken once.
            let flow = unsafe { [dqueries.get(index), dmemory.get(index), dprobabilities.get(index)] };
            let sample = Sample {
                layer: self,
                queries: &from[index * queries * self.size..][..queries * self.size],
                memory: &all[index * keys * 2 * self.size..][..keys * 2 * self.size],
                keys,
                length: lengths[index],
            };
            let own = &probabilities[index * self.heads * queries * keys..][..self.heads * queries * keys];
            let dcontext = &dcontext[index * queries * self.size..][..queries * self.size];
            sample.backward(compute, own, dcontext, flow);
        });
        let AttentionTape { queries: from, memory: all, dqueries, dmemory, dinputs, .. } = tape;
        let [dquery, dtokens] = dinputs;
        self.query.backward(compute, of_query, [query, from], dqueries, Some(query_gradients), Some(dquery));
        self.memory.backward(
            compute,
            of_memory,
            [memory, all],
            dmemory,
            Some(memory_gradients),
            Some(dtokens),
        );
        [dquery, dtokens]
    }

    fn split<'p>(&self, parameters: &'p [f32]) -> [&'p [f32]; 3] {
        assert_eq!(parameters.len(), self.parameters(), "`parameters` must have the length of the layer's");
        let (query, rest) = parameters.split_at(self.query.parameters());
        let (memory, output) = rest.split_at(self.memory.parameters());
        [query, memory, output]
    }
}

impl AttentionTape {
    fn prepare(&mut self, layer: &MultiHeadAttention, [query, memory]: [usize; 2], sequences: Sequences<'_>) {
        let Sequences { queries, keys, lengths } = sequences;
        let batch = query.checked_div(queries * layer.size).unwrap_or(0);
        assert_eq!(
            [query, memory],
            [batch * queries * layer.size, batch * keys * layer.size],
            "the lengths are not those of {batch} sequences of {queries} queries and {keys} keys for {layer:?}"
        );
        self.tokens = [queries, keys];
        self.lengths.clear();
        match lengths {
            None => self.lengths.resize(batch, keys),
            Some(lengths) => self.lengths.extend_from_slice(lengths),
        }
        assert!(
            self.lengths.len() == batch && self.lengths.iter().all(|length| (1..=keys).contains(length)),
            "there must be one length in 1..={keys} per sequence"
        );
        self.queries.resize(query, 0.0);
        self.memory.resize(2 * memory, 0.0);
        self.probabilities.resize(batch * layer.heads * queries * keys, 0.0);
        self.context.resize(query, 0.0);
    }

    fn prepare_gradients(&mut self, [query, memory]: [usize; 2]) {
        assert_eq!(
            [query, 2 * memory],
            [self.queries.len(), self.memory.len()],
            "a backward pass needs the tokens of its forward pass"
        );
        self.dqueries.resize(query, 0.0);
        self.dmemory.resize(2 * memory, 0.0);
        self.dprobabilities.resize(self.probabilities.len(), 0.0);
        self.dcontext.resize(query, 0.0);
        self.dinputs[0].resize(query, 0.0);
        self.dinputs[1].resize(memory, 0.0);
    }
}

/// One sequence of a batch.
struct Sample<'a> {
    layer: &'a MultiHeadAttention,
    queries: &'a [f32],
    memory: &'a [f32],
    /// Keys, with padding, and those that count.
    keys: usize,
    length: usize,
}

impl Sample<'_> {
    /// Size of a head.
    fn width(&self) -> usize {
        self.layer.size / self.layer.heads
    }

    fn count(&self) -> usize {
        self.queries.len() / self.layer.size
    }

    /// Returns the keys, or where `values` the values, of a head.
    fn of_head(&self, head: usize, values: bool) -> Matrix<'_> {
        let at = head * self.width() + if values { self.layer.size } else { 0 };
        Matrix::with_strides(&self.memory[at..], [self.length, self.width()], [2 * self.layer.size, 1])
    }

    /// Returns the columns of a head in rows of the layer's size.
    fn columns<'v>(&self, of: &'v [f32], head: usize) -> Matrix<'v> {
        Matrix::with_strides(&of[head * self.width()..], [self.count(), self.width()], [self.layer.size, 1])
    }

    fn attend(&self, compute: &Compute, probabilities: &mut [f32], context: &mut [f32]) {
        let (count, width, size) = (self.count(), self.width(), self.layer.size);
        let scale = Product::new().alpha(1.0 / (width as f32).sqrt());
        probabilities.fill(0.0);
        for (head, probabilities) in probabilities.chunks_exact_mut(count * self.keys).enumerate() {
            let extent = ([count, self.length], [self.keys, 1]);
            scale.run(
                compute,
                self.columns(self.queries, head),
                self.of_head(head, false).transposed(),
                MatrixMut::with_strides(probabilities, extent.0, extent.1),
            );
            softmax(compute.isa(), probabilities, self.keys, self.length);
            Product::new().run(
                compute,
                Matrix::with_strides(probabilities, extent.0, extent.1),
                self.of_head(head, true),
                MatrixMut::with_strides(&mut context[head * width..], [count, width], [size, 1]),
            );
        }
    }

    fn backward(
        &self,
        compute: &Compute,
        probabilities: &[f32],
        dcontext: &[f32],
        [dqueries, dmemory, dprobabilities]: [&mut [f32]; 3],
    ) {
        let (count, width, size) = (self.count(), self.width(), self.layer.size);
        let scale = Product::new().alpha(1.0 / (width as f32).sqrt());
        let extent = ([count, self.length], [self.keys, 1]);
        let (of_memory, stride) = ([self.length, width], [2 * size, 1]);
        dmemory.fill(0.0);
        let heads = probabilities.chunks_exact(count * self.keys);
        for (head, (own, down)) in heads.zip(dprobabilities.chunks_exact_mut(count * self.keys)).enumerate() {
            let dcontext = || self.columns(dcontext, head);
            Product::new().run(
                compute,
                dcontext(),
                self.of_head(head, true).transposed(),
                MatrixMut::with_strides(down, extent.0, extent.1),
            );
            Product::new().run(
                compute,
                Matrix::with_strides(own, extent.0, extent.1).transposed(),
                dcontext(),
                MatrixMut::with_strides(&mut dmemory[size + head * width..], of_memory, stride),
            );
            softmax_backward(own, self.keys, self.length, down);
            scale.run(
                compute,
                Matrix::with_strides(down, extent.0, extent.1),
                self.of_head(head, false),
                MatrixMut::with_strides(&mut dqueries[head * width..], [count, width], [size, 1]),
            );
            scale.run(
                compute,
                Matrix::with_strides(down, extent.0, extent.1).transposed(),
                self.columns(self.queries, head),
                MatrixMut::with_strides(&mut dmemory[head * width..], of_memory, stride),
            );
        }
    }
}

/// Replaces the first `length` scores of each row of `columns` by their softmax.
fn softmax(isa: Isa, scores: &mut [f32], columns: usize, length: usize) {
    for row in scores.chunks_exact_mut(columns) {
        let row = &mut row[..length];
        let largest = row.iter().copied().fold(f32::NEG_INFINITY, f32::max);
        row.iter_mut().for_each(|score| *score -= largest);
        exp_in_place(isa, row);
        let inverse = 1.0 / row.iter().sum::<f32>();
        row.iter_mut().for_each(|probability| *probability *= inverse);
    }
}

/// Replaces the gradient of the probabilities of each row by that of its scores.
fn softmax_backward(probabilities: &[f32], columns: usize, length: usize, flow: &mut [f32]) {
    for (row, flow) in probabilities.chunks_exact(columns).zip(flow.chunks_exact_mut(columns)) {
        let (row, flow) = (&row[..length], &mut flow[..length]);
        let mean: f32 = row.iter().zip(&*flow).map(|(probability, flow)| probability * flow).sum();
        flow.iter_mut().zip(row).for_each(|(flow, probability)| *flow = probability * (*flow - mean));
    }
}
