use opendr_engine::Result;

use super::checked_size;

/// Layer normalisation (Ba, Kiros and Hinton, 2016): normalises each sample to mean 0 and variance 1, then scales and
/// shifts it.
///
/// Parameters: scale, then shift, each of the sample's size.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LayerNorm {
    size: usize,
    epsilon: f32,
}

impl LayerNorm {
    /// Creates a layer for samples of `size` numbers; `epsilon`, 1e-5 in PyTorch, is added to the variance.
    ///
    /// # Errors
    /// When the size is zero or too large.
    pub fn new(size: usize, epsilon: f32) -> Result<Self> {
        checked_size("a layer normalisation", &[size])?;
        Ok(Self { size, epsilon })
    }

    /// Returns the number of values per sample.
    pub fn size(&self) -> usize {
        self.size
    }

    /// Returns the number of parameters, scale and shift.
    pub fn parameters(&self) -> usize {
        2 * self.size
    }

    /// Computes `y` from `x`, both `[batch, size]`.
    ///
    /// # Panics
    /// When a length does not match.
    pub fn forward(&self, parameters: &[f32], x: &[f32], y: &mut [f32]) {
        assert_eq!(x.len(), y.len(), "`x` and `y` must have equal lengths");
        let (scale, shift) = parameters.split_at(self.size);
        assert_eq!(shift.len(), self.size, "`parameters` must have the length of the layer's parameters");
        for (x, y) in x.chunks_exact(self.size).zip(y.chunks_exact_mut(self.size)) {
            let [mean, inverse] = self.moments(x);
            for (((y, &x), &scale), &shift) in y.iter_mut().zip(x).zip(scale).zip(shift) {
                *y = (x - mean) * inverse * scale + shift;
            }
        }
    }

    /// Computes the backward pass from `dy`, the gradient of the output: adds to `gradients`, and writes `dx`, where
    /// they are given.
    ///
    /// # Panics
    /// When a length does not match.
    pub fn backward(
        &self,
        parameters: &[f32],
        x: &[f32],
        dy: &[f32],
        gradients: Option<&mut [f32]>,
        dx: Option<&mut [f32]>,
    ) {
        assert_eq!(x.len(), dy.len(), "`x` and `dy` must have equal lengths");
        let rows = || x.chunks_exact(self.size).zip(dy.chunks_exact(self.size));
        if let Some(gradients) = gradients {
            let (scale, shift) = gradients.split_at_mut(self.size);
            assert_eq!(shift.len(), self.size, "`gradients` must have the length of the layer's parameters");
            for (x, dy) in rows() {
                let [mean, inverse] = self.moments(x);
                for (((scale, shift), &x), &dy) in scale.iter_mut().zip(&mut *shift).zip(x).zip(dy) {
                    *scale += dy * (x - mean) * inverse;
                    *shift += dy;
                }
            }
        }
        if let Some(dx) = dx {
            assert_eq!(x.len(), dx.len(), "`x` and `dx` must have equal lengths");
            for ((x, dy), dx) in rows().zip(dx.chunks_exact_mut(self.size)) {
                self.input_gradient(&parameters[..self.size], x, dy, dx);
            }
        }
    }

    fn input_gradient(&self, scale: &[f32], x: &[f32], dy: &[f32], dx: &mut [f32]) {
        let [mean, inverse] = self.moments(x);
        let (mut sum, mut product) = (0.0, 0.0);
        for ((&x, &dy), &scale) in x.iter().zip(dy).zip(scale) {
            sum += dy * scale;
            product += dy * scale * (x - mean) * inverse;
        }
        let count = self.size as f32;
        let (sum, product) = (sum / count, product / count);
        for (((dx, &x), &dy), &scale) in dx.iter_mut().zip(x).zip(dy).zip(scale) {
            *dx = inverse * (dy * scale - sum - (x - mean) * inverse * product);
        }
    }

    /// Returns the mean and the reciprocal of the standard deviation.
    fn moments(&self, x: &[f32]) -> [f32; 2] {
        let count = self.size as f32;
        let mean = x.iter().sum::<f32>() / count;
        let variance = x.iter().map(|&x| (x - mean) * (x - mean)).sum::<f32>() / count;
        [mean, 1.0 / (variance + self.epsilon).sqrt()]
    }
}
