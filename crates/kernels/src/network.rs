use opendr_engine::{Error, Result};

use crate::{Activation, Compute, Conv2d, Dense, LayerNorm};

/// A layer of a [`Network`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Layer {
    /// Fully connected layer.
    Dense(Dense),
    /// Convolution. Flattening its output needs no work.
    Conv2d(Conv2d),
    /// Layer normalisation of each sample.
    LayerNorm(LayerNorm),
    /// An activation of its own, of this many values per sample, e.g. after a normalisation.
    Activation(Activation, usize),
}

/// A sequence of layers, with all parameters in one slice, first layer first.
///
/// ```
/// use opendr_kernels::{Activation, Compute, Network, Tape};
///
/// let network = Network::dense(&[4, 64, 64, 2], Activation::Tanh).unwrap();
/// let (compute, mut tape) = (Compute::single(), Tape::default());
/// let (parameters, mut gradients) = (vec![0.01; network.parameters()], vec![0.0; network.parameters()]);
/// let y = network.forward(&compute, &parameters, &[0.5; 3 * 4], &mut tape);
/// assert_eq!(y.len(), 3 * 2);
/// network.backward(&compute, &parameters, &[1.0; 3 * 2], &mut tape, Some(&mut gradients), false);
/// assert!(gradients.iter().all(|gradient| *gradient > 0.0));
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Network {
    layers: Vec<Layer>,
    /// Start of the parameters of each layer, and the end of the last ones.
    offsets: Vec<usize>,
    inputs: usize,
}

/// Values of a forward pass for the backward pass; the memory is reused, so that only the first passes allocate.
#[derive(Debug, Clone, Default)]
pub struct Tape {
    batch: usize,
    /// The input, then the output of each layer.
    values: Vec<Vec<f32>>,
    /// The gradients of those.
    gradients: Vec<Vec<f32>>,
    scratch: Vec<f32>,
}

impl Layer {
    fn inputs(&self) -> usize {
        match self {
            Self::Dense(layer) => layer.inputs(),
            Self::Conv2d(layer) => layer.inputs(),
            Self::LayerNorm(layer) => layer.size(),
            Self::Activation(_, size) => *size,
        }
    }

    fn outputs(&self) -> usize {
        match self {
            Self::Dense(layer) => layer.outputs(),
            Self::Conv2d(layer) => layer.outputs(),
            Self::LayerNorm(layer) => layer.size(),
            Self::Activation(_, size) => *size,
        }
    }

    fn parameters(&self) -> usize {
        match self {
            Self::Dense(layer) => layer.parameters(),
            Self::Conv2d(layer) => layer.parameters(),
            Self::LayerNorm(layer) => layer.parameters(),
            Self::Activation(..) => 0,
        }
    }

    fn forward(&self, compute: &Compute, parameters: &[f32], x: &[f32], y: &mut [f32]) {
        match self {
            Self::Dense(layer) => layer.forward(compute, parameters, x, y),
            Self::Conv2d(layer) => layer.forward(compute, parameters, x, y),
            Self::LayerNorm(layer) => layer.forward(parameters, x, y),
            Self::Activation(activation, _) => {
                y.copy_from_slice(x);
                activation.apply(compute.isa(), y);
            }
        }
    }

    #[expect(clippy::too_many_arguments, reason = "inputs and outputs of a backward pass")]
    fn backward(
        &self,
        compute: &Compute,
        parameters: &[f32],
        [x, y]: [&[f32]; 2],
        dy: &mut [f32],
        gradients: Option<&mut [f32]>,
        dx: Option<&mut [f32]>,
        scratch: &mut Vec<f32>,
    ) {
        match self {
            Self::Dense(layer) => layer.backward(compute, parameters, [x, y], dy, gradients, dx),
            Self::Conv2d(layer) => layer.backward(compute, parameters, [x, y], dy, gradients, dx, scratch),
            Self::LayerNorm(layer) => layer.backward(parameters, x, dy, gradients, dx),
            Self::Activation(activation, _) => {
                activation.backward_in_place(compute.isa(), y, dy);
                if let Some(dx) = dx {
                    dx.copy_from_slice(dy);
                }
            }
        }
    }
}

impl Tape {
    /// Returns the output of the last [`Network::forward`]; empty before one.
    pub fn output(&self) -> &[f32] {
        self.values.last().map_or(&[], |values| values)
    }

    /// Returns the input of a layer in the last [`Network::forward`].
    ///
    /// # Panics
    /// Where there is no such layer, or before a pass.
    pub fn input_of(&self, layer: usize) -> &[f32] {
        &self.values[layer]
    }

    /// Keeps only some rows of the batch of the last [`Network::forward`], given in ascending order; the backward
    /// pass then runs for these, as if the batch had contained only them.
    ///
    /// # Panics
    /// When there is no such row.
    pub fn keep_rows(&mut self, rows: &[usize]) {
        if rows.len() == self.batch {
            return;
        }
        self.gradients.resize_with(self.values.len(), Vec::new);
        for (values, gradients) in self.values.iter_mut().zip(&mut self.gradients) {
            let width = values.len().checked_div(self.batch).unwrap_or(0);
            // The buffers stay large enough for all rows, so that later calls do not allocate.
            gradients.clear();
            gradients.reserve(values.len());
            for (to, &from) in rows.iter().enumerate() {
                values.copy_within(from * width..(from + 1) * width, to * width);
            }
            values.truncate(rows.len() * width);
        }
        self.batch = rows.len();
    }
}

impl Network {
    /// Creates a network of these layers.
    ///
    /// # Errors
    /// When there is no layer, or the sizes of consecutive layers differ.
    pub fn new(layers: Vec<Layer>) -> Result<Self> {
        let Some(first) = layers.first() else {
            return Err(Error::invalid_param("a network needs at least one layer"));
        };
        for (index, pair) in layers.windows(2).enumerate() {
            let (given, taken) = (pair[0].outputs(), pair[1].inputs());
            if given != taken {
                return Err(Error::invalid_param(format!(
                    "layer {index} has {given} outputs, but layer {} has {taken} inputs; make them equal",
                    index + 1
                )));
            }
        }
        let mut offsets = vec![0];
        offsets.extend(layers.iter().scan(0, |end, layer| {
            *end += layer.parameters();
            Some(*end)
        }));
        Ok(Self { inputs: first.inputs(), layers, offsets })
    }

    /// Creates a network of dense layers of these sizes, from the input to the output, with an activation after each
    /// but the last.
    ///
    /// # Errors
    /// When there are fewer than two sizes, one is zero, or the whole is too large.
    pub fn dense(sizes: &[usize], hidden: Activation) -> Result<Self> {
        let last = sizes.len().saturating_sub(2);
        let layer = |(index, pair): (usize, &[usize])| {
            let activation = if index == last { Activation::Identity } else { hidden };
            Dense::new(pair[0], pair[1], activation).map(Layer::Dense)
        };
        Self::new(sizes.windows(2).enumerate().map(layer).collect::<Result<_>>()?)
    }

    /// Returns the number of input values per sample.
    pub fn inputs(&self) -> usize {
        self.inputs
    }

    /// Returns the number of output values per sample.
    pub fn outputs(&self) -> usize {
        self.layers.last().map_or(0, Layer::outputs)
    }

    /// Returns the number of all parameters.
    pub fn parameters(&self) -> usize {
        self.offsets.last().copied().unwrap_or(0)
    }

    /// Returns the layers.
    pub fn layers(&self) -> &[Layer] {
        &self.layers
    }

    /// Returns the range of a layer's parameters among all.
    ///
    /// # Panics
    /// When there is no such layer.
    pub fn parameter_range(&self, layer: usize) -> std::ops::Range<usize> {
        self.offsets[layer]..self.offsets[layer + 1]
    }

    /// Computes the output, `[batch, outputs]`, for `x`, `[batch, inputs]`.
    ///
    /// # Panics
    /// When a length does not match.
    pub fn forward<'t>(
        &self,
        compute: &Compute,
        parameters: &[f32],
        x: &[f32],
        tape: &'t mut Tape,
    ) -> &'t [f32] {
        let batch = x.len() / self.inputs;
        assert_eq!(x.len(), batch * self.inputs, "`x` must be a batch of {} numbers each", self.inputs);
        assert_eq!(
            parameters.len(),
            self.parameters(),
            "`parameters` must have the length of the network's parameters"
        );
        tape.batch = batch;
        tape.values.resize_with(self.layers.len() + 1, Vec::new);
        tape.values[0].clear();
        tape.values[0].extend_from_slice(x);
        for (index, layer) in self.layers.iter().enumerate() {
            let (before, after) = tape.values.split_at_mut(index + 1);
            after[0].resize(batch * layer.outputs(), 0.0);
            layer.forward(compute, &parameters[self.parameter_range(index)], &before[index], &mut after[0]);
        }
        &tape.values[self.layers.len()]
    }

    /// Computes the backward pass of the last [`Network::forward`] on this tape, from `dy`, the gradient of its
    /// output.
    ///
    /// Adds to `gradients`, if given; returns the gradient of the input where `wants_input`, else an empty slice.
    ///
    /// # Panics
    /// When a length does not match.
    pub fn backward<'t>(
        &self,
        compute: &Compute,
        parameters: &[f32],
        dy: &[f32],
        tape: &'t mut Tape,
        mut gradients: Option<&mut [f32]>,
        wants_input: bool,
    ) -> &'t [f32] {
        let Tape { values, gradients: flow, scratch, .. } = tape;
        assert_eq!(values.len(), self.layers.len() + 1, "a backward pass needs a forward pass before it");
        assert_eq!(dy.len(), values[self.layers.len()].len(), "`dy` must have the length of the output");
        flow.resize_with(values.len(), Vec::new);
        flow[self.layers.len()].clear();
        flow[self.layers.len()].extend_from_slice(dy);
        for (index, layer) in self.layers.iter().enumerate().rev() {
            let (before, after) = flow.split_at_mut(index + 1);
            let dx = (index > 0 || wants_input).then(|| {
                before[index].resize(values[index].len(), 0.0);
                &mut *before[index]
            });
            let range = self.parameter_range(index);
            let own = gradients.as_deref_mut().map(|all| &mut all[range.clone()]);
            let ends = [&*values[index], &*values[index + 1]];
            layer.backward(compute, &parameters[range], ends, &mut after[0], own, dx, scratch);
        }
        if wants_input { &flow[0] } else { &[] }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_that_are_kept_have_the_gradients_of_the_batch() {
        let network = Network::dense(&[3, 20, 2], Activation::Relu).unwrap();
        let (compute, mut tape) = (Compute::single(), Tape::default());
        let numbers = |count: usize| (0..count).map(|at| (at as f32).sin()).collect::<Vec<_>>();
        let (parameters, x, dy) = (numbers(network.parameters()), numbers(7 * 3), numbers(7 * 2));
        for rows in [&[0, 3, 4, 6][..], &[], &[5], &[0, 1, 2, 3, 4, 5, 6]] {
            network.forward(&compute, &parameters, &x, &mut tape);
            let all = network.backward(&compute, &parameters, &dy, &mut tape, None, true).to_vec();
            let of = |numbers: &[f32], width: usize| {
                let rows = rows.iter().flat_map(|row| &numbers[row * width..(row + 1) * width]);
                rows.copied().collect::<Vec<_>>()
            };
            tape.keep_rows(rows);
            let kept = network.backward(&compute, &parameters, &of(&dy, 2), &mut tape, None, true);
            assert_eq!(kept, of(&all, 3));
        }
    }
}
