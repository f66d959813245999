use opendr_engine::Result;

use super::checked_size;
use crate::column_sums::backward_with_column_sums;
use crate::{Activation, Bias, Compute, Matrix, MatrixMut, Product};

/// `y = activation(x W + b)`.
///
/// Parameters: W by rows, `[inputs, outputs]` (the transpose of PyTorch's), then b.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Dense {
    inputs: usize,
    outputs: usize,
    activation: Activation,
}

impl Dense {
    /// A layer of these sizes.
    ///
    /// # Errors
    /// Where a size is zero or their product too large.
    pub fn new(inputs: usize, outputs: usize, activation: Activation) -> Result<Self> {
        checked_size("a dense layer", &[inputs, outputs])?;
        Ok(Self { inputs, outputs, activation })
    }

    /// Numbers of a sample that come in.
    pub fn inputs(&self) -> usize {
        self.inputs
    }

    /// Numbers of a sample that go out.
    pub fn outputs(&self) -> usize {
        self.outputs
    }

    /// What is done to every output.
    pub fn activation(&self) -> Activation {
        self.activation
    }

    /// Numbers of W and b.
    pub fn parameters(&self) -> usize {
        (self.inputs + 1) * self.outputs
    }

    /// Computes `y` `[batch, outputs]` from `x` `[batch, inputs]`.
    ///
    /// # Panics
    /// Where a length does not fit.
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

    /// Adds to `gradients`, and writes `dx`, where they are wanted. `dy`, the gradient of `y`, becomes that before the
    /// activation.
    ///
    /// # Panics
    /// Where a length does not fit.
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
            "not a batch of {self:?}"
        );
        batch
    }
}
