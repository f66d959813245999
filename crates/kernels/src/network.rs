use opendr_engine::{Error, Result};

use crate::{Activation, Compute, Conv2d, Dense, LayerNorm};

/// A layer of a [`Network`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Layer {
    /// Fully connected.
    Dense(Dense),
    /// Convolution. Flattening what comes out is doing nothing.
    Conv2d(Conv2d),
    /// Normalisation of each sample.
    LayerNorm(LayerNorm),
    /// An activation by itself, of this many numbers a sample: where one stands behind a normalisation.
    Activation(Activation, usize),
}

/// Layers one after the other, with all their parameters in one slice, first layer first.
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
    /// Where the parameters of each layer start, and where the last ones end.
    offsets: Vec<usize>,
    inputs: usize,
}

/// What a pass forward leaves for the pass back: memory that is used again, so that only the first passes allocate.
#[derive(Debug, Clone, Default)]
pub struct Tape {
    batch: usize,
    /// The input, then what each layer gave.
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

    #[expect(clippy::too_many_arguments, reason = "what goes in and out of a backward pass")]
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
    /// What the last [`Network::forward`] gave; empty before one.
    pub fn output(&self) -> &[f32] {
        self.values.last().map_or(&[], |values| values)
    }

    /// The input of a layer in the last [`Network::forward`].
    ///
    /// # Panics
    /// Where there is no such layer, or before a pass.
    pub fn input_of(&self, layer: usize) -> &[f32] {
        &self.values[layer]
    }

    /// Forgets all but some rows of the batch of the last [`Network::forward`], given in rising order: the way back is then
    /// only gone for them, as if they had come alone.
    ///
    /// # Panics
    /// Where there is no such row.
    pub fn keep_rows(&mut self, rows: &[usize]) {
        if rows.len() == self.batch {
            return;
        }
        self.gradients.resize_with(self.values.len(), Vec::new);
        for (values, gradients) in self.values.iter_mut().zip(&mut self.gradients) {
            let width = values.len().checked_div(self.batch).unwrap_or(0);
            // The next time other rows may be kept, or more: there is room for all of them, once and for all.
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
    /// A network of these layers.
    ///
    /// # Errors
    /// Where there is no layer, or one does not take what the one before gives.
    pub fn new(layers: Vec<Layer>) -> Result<Self> {
        let Some(first) = layers.first() else {
            return Err(Error::invalid_param("a network of no layers; give at least one"));
        };
        for (index, pair) in layers.windows(2).enumerate() {
            let (given, taken) = (pair[0].outputs(), pair[1].inputs());
            if given != taken {
                return Err(Error::invalid_param(format!(
                    "layer {index} gives {given} numbers, but layer {} takes {taken}; make them equal",
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

    /// Dense layers of these sizes, from the input to the output, with an activation behind each but the last.
    ///
    /// # Errors
    /// Where there are fewer than two sizes, one is zero, or the whole is too large.
    pub fn dense(sizes: &[usize], hidden: Activation) -> Result<Self> {
        let last = sizes.len().saturating_sub(2);
        let layer = |(index, pair): (usize, &[usize])| {
            let activation = if index == last { Activation::Identity } else { hidden };
            Dense::new(pair[0], pair[1], activation).map(Layer::Dense)
        };
        Self::new(sizes.windows(2).enumerate().map(layer).collect::<Result<_>>()?)
    }

    /// Numbers of a sample that come in.
    pub fn inputs(&self) -> usize {
        self.inputs
    }

    /// Numbers of a sample that go out.
    pub fn outputs(&self) -> usize {
        self.layers.last().map_or(0, Layer::outputs)
    }

    /// Numbers of all parameters.
    pub fn parameters(&self) -> usize {
        self.offsets.last().copied().unwrap_or(0)
    }

    /// The layers.
    pub fn layers(&self) -> &[Layer] {
        &self.layers
    }

    /// The parameters of a layer among all.
    ///
    /// # Panics
    /// Where there is no such layer.
    pub fn parameters_of(&self, layer: usize) -> std::ops::Range<usize> {
        self.offsets[layer]..self.offsets[layer + 1]
    }

    /// Computes the output, `[batch, outputs]`, of `x`, `[batch, inputs]`.
    ///
    /// # Panics
    /// Where a length does not fit.
    pub fn forward<'t>(
        &self,
        compute: &Compute,
        parameters: &[f32],
        x: &[f32],
        tape: &'t mut Tape,
    ) -> &'t [f32] {
        let batch = x.len() / self.inputs;
        assert_eq!(x.len(), batch * self.inputs, "no batch of {} numbers each", self.inputs);
        assert_eq!(parameters.len(), self.parameters(), "parameters of another network");
        tape.batch = batch;
        tape.values.resize_with(self.layers.len() + 1, Vec::new);
        tape.values[0].clear();
        tape.values[0].extend_from_slice(x);
        for (index, layer) in self.layers.iter().enumerate() {
            let (before, after) = tape.values.split_at_mut(index + 1);
            after[0].resize(batch * layer.outputs(), 0.0);
            layer.forward(compute, &parameters[self.parameters_of(index)], &before[index], &mut after[0]);
        }
        &tape.values[self.layers.len()]
    }

    /// The way back of the last [`Network::forward`] on this tape, from `dy`, the gradient of its output.
    ///
    /// Adds to `gradients`, unless they are not wanted; gives the gradient of the input where `wants_input`, else
    /// nothing.
    ///
    /// # Panics
    /// Where a length does not fit.
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
        assert_eq!(values.len(), self.layers.len() + 1, "no forward pass before");
        assert_eq!(dy.len(), values[self.layers.len()].len(), "not the gradient of the output");
        flow.resize_with(values.len(), Vec::new);
        flow[self.layers.len()].clear();
        flow[self.layers.len()].extend_from_slice(dy);
        for (index, layer) in self.layers.iter().enumerate().rev() {
            let (before, after) = flow.split_at_mut(index + 1);
            let dx = (index > 0 || wants_input).then(|| {
                before[index].resize(values[index].len(), 0.0);
                &mut *before[index]
            });
            let range = self.parameters_of(index);
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
