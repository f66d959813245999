use opendr_engine::{Error, Result};

use super::checked_size;
use super::patches::Patches;
use crate::aligned::{PATCH_GRADIENTS, PATCHES, with_buffer};
use crate::pool::Pieces;
use crate::{Activation, Bias, Compute, Matrix, MatrixMut, Product};

/// A convolution `y = activation(x * W + b)` (a cross-correlation, as in PyTorch) with zero padding.
///
/// Input and output samples are `[channels, height, width]`, so that flattening a sample needs no work. Parameters,
/// as in PyTorch: W `[outputs, channels, kernel height, kernel width]`, then b.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Conv2d {
    patches: Patches,
    outputs: usize,
    activation: Activation,
}

/// Maximum number of parts of a batch; the gradients of the parts are added in their order.
const PARTS: usize = 16;

impl Conv2d {
    /// Creates a layer for images `[channels, height, width]`; kernel, stride and padding are vertical, then
    /// horizontal.
    ///
    /// # Errors
    /// When a size is zero, the kernel is larger than the padded image, or the whole is too large.
    pub fn new(
        [channels, height, width]: [usize; 3],
        outputs: usize,
        kernel: [usize; 2],
        stride: [usize; 2],
        padding: [usize; 2],
        activation: Activation,
    ) -> Result<Self> {
        let size = [height, width];
        checked_size("an image", &[channels, height, width])?;
        checked_size("a kernel", &[outputs, channels, kernel[0], kernel[1]])?;
        checked_size("a stride", &stride)?;
        let mut places = [0; 2];
        for axis in [0, 1] {
            let padded = padding[axis].checked_mul(2).and_then(|twice| twice.checked_add(size[axis]));
            let Some(room) = padded.and_then(|padded| padded.checked_sub(kernel[axis])) else {
                return Err(Error::invalid_param(format!(
                    "a kernel of {kernel:?} does not fit into an image of {size:?} with padding {padding:?}; use a smaller kernel"
                )));
            };
            places[axis] = room / stride[axis] + 1;
        }
        checked_size("the patches of an image", &[channels, kernel[0], kernel[1], places[0], places[1]])?;
        checked_size("the output of a convolution", &[outputs, places[0], places[1]])?;
        let patches = Patches { channels, size, kernel, stride, padding, places };
        Ok(Self { patches, outputs, activation })
    }

    /// Returns the number of input values per sample.
    pub fn inputs(&self) -> usize {
        self.patches.picture()
    }

    /// Returns the number of output values per sample.
    pub fn outputs(&self) -> usize {
        self.outputs * self.patches.columns()
    }

    /// Returns channels, height and width of the input.
    pub fn input_shape(&self) -> [usize; 3] {
        [self.patches.channels, self.patches.size[0], self.patches.size[1]]
    }

    /// Returns height and width of the kernels.
    pub fn kernel(&self) -> [usize; 2] {
        self.patches.kernel
    }

    /// Returns the stride, vertical and horizontal.
    pub fn stride(&self) -> [usize; 2] {
        self.patches.stride
    }

    /// Returns the zero padding, vertical and horizontal, on each side.
    pub fn padding(&self) -> [usize; 2] {
        self.patches.padding
    }

    /// Returns the activation function.
    pub fn activation(&self) -> Activation {
        self.activation
    }

    /// Returns channels, height and width of the output.
    pub fn output_shape(&self) -> [usize; 3] {
        [self.outputs, self.patches.places[0], self.patches.places[1]]
    }

    /// Returns the number of parameters, W and b.
    pub fn parameters(&self) -> usize {
        self.outputs * (self.patches.rows() + 1)
    }

    /// Computes `y` `[batch, outputs]` from `x` `[batch, inputs]`.
    ///
    /// # Panics
    /// When a length does not match.
    pub fn forward(&self, compute: &Compute, parameters: &[f32], x: &[f32], y: &mut [f32]) {
        let batch = self.batch(x, y);
        assert_eq!(
            parameters.len(),
            self.parameters(),
            "`parameters` must have the length of the layer's parameters"
        );
        let (rows, columns) = (self.patches.rows(), self.patches.columns());
        let (weights, bias) = parameters.split_at(self.outputs * rows);
        let product = Product::new().bias(Bias::Rows(bias)).activation(self.activation);
        let length = batch.div_ceil(PARTS).max(1);
        compute.pool().run_on_pieces(y, length * self.outputs(), |part, y| {
            let x = &x[part * length * self.inputs()..];
            with_buffer(&PATCHES, rows * columns, |matrix| {
                for (x, y) in x.chunks_exact(self.inputs()).zip(y.chunks_exact_mut(self.outputs())) {
                    self.patches.gather(x, matrix);
                    product.run(
                        compute,
                        Matrix::new(weights, self.outputs, rows),
                        Matrix::new(matrix, rows, columns),
                        MatrixMut::new(y, self.outputs, columns),
                    );
                }
            });
        });
    }

    /// Computes the backward pass: adds to `gradients`, and writes `dx`, where they are given. `dy`, the gradient of
    /// `y`, becomes that before the activation. `scratch` is work memory that grows as needed and is reused.
    ///
    /// # Panics
    /// When a length does not match.
    #[expect(clippy::too_many_arguments, reason = "inputs and outputs of a backward pass")]
    pub fn backward(
        &self,
        compute: &Compute,
        parameters: &[f32],
        [x, y]: [&[f32]; 2],
        dy: &mut [f32],
        gradients: Option<&mut [f32]>,
        dx: Option<&mut [f32]>,
        scratch: &mut Vec<f32>,
    ) {
        let batch = self.batch(x, y);
        assert_eq!(
            parameters.len(),
            self.parameters(),
            "`parameters` must have the length of the layer's parameters"
        );
        let wants_input = dx.is_some();
        let dx = dx.unwrap_or_default();
        assert!(!wants_input || dx.len() == x.len(), "`x` and `dx` must have equal lengths");
        self.activation.backward_in_place(compute.isa(), y, dy);
        let length = batch.div_ceil(PARTS).max(1);
        let parts = batch.div_ceil(length);
        let wanted = if gradients.is_some() { self.parameters() } else { 0 };
        scratch.clear();
        scratch.resize(parts * wanted, 0.0);
        let sums = Pieces::new(scratch, wanted);
        let dx = Pieces::new(dx, length * self.inputs());
        let dy = &*dy;
        compute.pool().run(parts, |part| {
            let x = x.chunks(length * self.inputs()).nth(part).unwrap_or_default();
            let dy = dy.chunks(length * self.outputs()).nth(part).unwrap_or_default();
            // SAFETY: each part is processed once.
            let (sums, dx) = unsafe { (sums.get(part), dx.get(part)) };
            if wanted > 0 {
                self.add_gradients(compute, x, dy, sums);
            }
            if wants_input {
                self.input_gradient(compute, parameters, dy, dx);
            }
        });
        if let Some(gradients) = gradients {
            assert_eq!(gradients.len(), wanted, "`gradients` must have the length of the layer's parameters");
            for part in scratch.chunks_exact(wanted) {
                for (total, &value) in gradients.iter_mut().zip(part) {
                    *total += value;
                }
            }
        }
    }

    fn add_gradients(&self, compute: &Compute, x: &[f32], dy: &[f32], sums: &mut [f32]) {
        let (rows, columns) = (self.patches.rows(), self.patches.columns());
        let (weights, bias) = sums.split_at_mut(self.outputs * rows);
        with_buffer(&PATCHES, rows * columns, |matrix| {
            for (x, dy) in x.chunks_exact(self.inputs()).zip(dy.chunks_exact(self.outputs())) {
                self.patches.gather(x, matrix);
                Product::new().beta(1.0).run(
                    compute,
                    Matrix::new(dy, self.outputs, columns),
                    Matrix::new(matrix, rows, columns).transposed(),
                    MatrixMut::new(weights, self.outputs, rows),
                );
                for (sum, dy) in bias.iter_mut().zip(dy.chunks_exact(columns)) {
                    *sum += dy.iter().sum::<f32>();
                }
            }
        });
    }

    fn input_gradient(&self, compute: &Compute, parameters: &[f32], dy: &[f32], dx: &mut [f32]) {
        let (rows, columns) = (self.patches.rows(), self.patches.columns());
        with_buffer(&PATCH_GRADIENTS, rows * columns, |matrix| {
            for (dy, dx) in dy.chunks_exact(self.outputs()).zip(dx.chunks_exact_mut(self.inputs())) {
                Product::new().run(
                    compute,
                    Matrix::new(parameters, self.outputs, rows).transposed(),
                    Matrix::new(dy, self.outputs, columns),
                    MatrixMut::new(matrix, rows, columns),
                );
                dx.fill(0.0);
                self.patches.scatter(matrix, dx);
            }
        });
    }

    fn batch(&self, x: &[f32], y: &[f32]) -> usize {
        let batch = x.len() / self.inputs();
        let expected = [batch * self.inputs(), batch * self.outputs()];
        assert_eq!([x.len(), y.len()], expected, "`x` and `y` must be a batch of {self:?}");
        batch
    }
}
