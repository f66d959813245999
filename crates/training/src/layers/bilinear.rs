//! Bilinear resizing.

use burn::tensor::module::interpolate;
use burn::tensor::ops::{InterpolateMode, InterpolateOptions};
use burn::tensor::{Device, Tensor, TensorData};

/// Returns `x` `[batch, channels, height, width]` resized to `size`, height and width; pixels are areas ("half pixel").
///
/// Where a GPU computes the gradient, this is a matrix product per axis: Burn 0.22 has no gradient of its own interpolation
/// there.
pub fn bilinear(x: Tensor<4>, size: [usize; 2]) -> Tensor<4> {
    let device = x.device();
    if device.is_autodiff() && device.clone().inner() != Device::flex() {
        let along_width = resized_last(x, size[1]);
        return resized_last(along_width.swap_dims(2, 3), size[0]).swap_dims(2, 3);
    }
    let options = InterpolateOptions::new(InterpolateMode::Bilinear).with_align_corners(false);
    interpolate(x, options.with_output_size(size))
}

/// Resizes the last axis by a product with the weights of its neighbours.
fn resized_last(x: Tensor<4>, to: usize) -> Tensor<4> {
    let [batch, channels, rows, from] = x.dims();
    let weights = TensorData::new(weights(from, to), [from, to]);
    let weights = Tensor::<2>::from_data(weights, &x.device());
    x.reshape([batch * channels * rows, from]).matmul(weights).reshape([batch, channels, rows, to])
}

/// Returns the weight of each of `from` positions (row) in each of `to` (column), row-major.
fn weights(from: usize, to: usize) -> Vec<f32> {
    let mut weights = vec![0.0; from * to];
    for column in 0..to {
        let at = ((column as f64 + 0.5) * from as f64 / to as f64 - 0.5).clamp(0.0, from as f64 - 1.0);
        let (first, share) = (at.floor() as usize, at.fract() as f32);
        weights[first * to + column] += 1.0 - share;
        weights[(first + 1).min(from - 1) * to + column] += share;
    }
    weights
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn products_equal_the_interpolation() {
        let device = Device::flex();
        let values: Vec<f32> = (0..2 * 3 * 5 * 7).map(|index| ((index * 37) % 101) as f32).collect();
        for [height, width] in [[5, 7], [10, 14], [13, 20], [3, 4], [1, 1]] {
            let x = Tensor::<4>::from_data(TensorData::new(values.clone(), [2, 3, 5, 7]), &device);
            let wanted = bilinear(x.clone(), [height, width]);
            let found = resized_last(resized_last(x, width).swap_dims(2, 3), height).swap_dims(2, 3);
            let difference: f32 = (wanted - found).abs().max().into_scalar();
            assert!(difference < 1e-3, "{height}x{width}: {difference}");
        }
    }
}
