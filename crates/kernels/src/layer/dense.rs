use opendr_engine::Result;

use super::checked_size;
use crate::column_sums::backward_with_column_sums;
use crate::{Activation, Bias, Compute, Matrix, MatrixMut, Product};

/// A fully connected layer `y = activation(x W + b)`.
///
/// Parameters: W in row-major order, `[inputs, outputs]` (the transpose of PyTorch's), then b.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Dense {
    inputs: usize,
    outputs: usize,
    activation: Activation,
}

impl Dense {
    /// Creates a layer of these sizes.
    ///
    /// # Errors
    /// When a size is zero or their product is too large.
    pub fn new(inputs: usize, outputs: usize, activation: Activation) -> Result<Self> {
        checked_size("a dense layer", &[inputs, outputs])?;
        Ok(Self { inputs, outputs, activation })
    }

    /// Returns the number of input values per sample.
    pub fn inputs(&self) -> usize {
        self.inputs
    }

    /// Returns the number of output values per sample.
    pub fn outputs(&self) -> usize {
        self.outputs
    }

    /// Returns the activation function.
    pub fn activation(&self) -> Activation {
        self.activation
    }

    /// Returns the number of parameters, W and b.
    pub fn parameters(&self) -> usize {
        (self.inputs + 1) * self.outputs
    }

    /// Computes `y` `[batch, outputs]` from `x` `[batch, inputs]`.
    ///
    /// # Panics
    /// When a length does not match.
    pub fn forward(&self, compute: &Compute, parameters: &[f32], x: &[f32], y: &mut [f32]) {
        let batch = self.batch(x, y);
        let (weights, bias) = parameters.split_at(self.inputs * self.outputs);
        Product::new().bias(Bias::Columns(bias)).activation(self.activation).run(
            compute,
            Matrix::new(x, batch, self.inputs),
            Matrix::new(weights, self.inputs, self.outputs),
            MatrixMut::new(y, batch, self.outputs),
        );
    }

    /// Computes the backward pass: adds to `gradients`, and writes `dx`, where they are given. `dy`, the gradient of
    /// `y`, becomes that before the activation.
    ///
    /// # Panics
    /// When a length does not match.
    pub fn backward(
        &self,
        compute: &Compute,
        parameters: &[f32],
        [x, y]: [&[f32]; 2],
        dy: &mut [f32],
        gradients: Option<&mut [f32]>,
        dx: Option<&mut [f32]>,
    ) {
        let batch = self.batch(x, y);
        let Self { inputs, outputs, activation } = *self;
        match gradients {
            None => activation.backward_in_place(compute.isa(), y, dy),
            Some(gradients) => {
                let (weights, bias) = gradients.split_at_mut(inputs * outputs);
                backward_with_column_sums(compute.isa(), activation, y, dy, bias);
                Product::new().beta(1.0).run(
                    compute,
                    Matrix::new(x, batch, inputs).transposed(),
                    Matrix::new(dy, batch, outputs),
                    MatrixMut::new(weights, inputs, outputs),
                );
            }
        }
        if let Some(dx) = dx {
            Product::new().run(
                compute,
                Matrix::new(dy, batch, outputs),
                Matrix::new(parameters, inputs, outputs).transposed(),
                MatrixMut::new(dx, batch, inputs),
            );
        }
    }

    fn batch(&self, x: &[f32], y: &[f32]) -> usize {
        let batch = x.len() / self.inputs;
        assert_eq!(
            [x.len(), y.len()],
            [batch * self.inputs, batch * self.outputs],
            "`x` and `y` must be a batch of {self:?}"
        );
        batch
    }
}
