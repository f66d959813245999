//! A 3x3 convolution whose neurons also weigh the products of all pairs of their inputs.

use burn::module::{Initializer, Module};
use burn::nn::PaddingConfig2d;
use burn::nn::conv::{Conv2d, Conv2dConfig};
use burn::tensor::{Device, Tensor};
use opendr_training::operations::conv2d;

/// Side of a kernel.
const SIDE: usize = 3;

/// Layer from `[batch, channels, height, width]` to the same height and width with other channels.
///
/// The powers of the input, from the first to the `order`th, are separate channels. For each of them a neuron adds its 9 values
/// and the 45 products of two of them, weighted. All products of values at distance `d` are one feature map, the product of the
/// input and its shifted copy, and their weights are a convolution of it: 13 convolutions in place of 45 products per neuron.
#[derive(Module, Debug)]
pub struct QuadraticConvolution {
    linear: Conv2d,
    products: Vec<Conv2d>,
    order: usize,
}

/// Returns the distances between the two values of a product, rows and columns, each pair once.
fn distances() -> impl Iterator<Item = [isize; 2]> {
    let reach = SIDE as isize - 1;
    let all = (0..=reach).flat_map(move |down| (-reach..=reach).map(move |right| [down, right]));
    all.filter(|[down, right]| *down > 0 || *right >= 0)
}

impl QuadraticConvolution {
    /// Returns a layer with initial weights.
    pub fn new([inputs, outputs]: [usize; 2], order: usize, device: &Device) -> Self {
        let inputs = inputs * order;
        let uniform = |taps: usize| {
            let bound = (6.0 / (taps * (inputs + outputs)) as f64).sqrt();
            Initializer::Uniform { min: -bound, max: bound }
        };
        let taps = SIDE * SIDE;
        let product = |[down, right]: [isize; 2]| {
            let kernel = [SIDE - down.unsigned_abs(), SIDE - right.unsigned_abs()];
            Conv2dConfig::new([inputs, outputs], kernel)
                .with_bias(false)
                .with_initializer(uniform(taps * taps))
                .init(device)
        };
        Self {
            linear: Conv2dConfig::new([inputs, outputs], [SIDE, SIDE])
                .with_padding(PaddingConfig2d::Explicit(1, 1, 1, 1))
                .with_initializer(uniform(taps))
                .init(device),
            products: distances().map(product).collect(),
            order,
        }
    }

    /// Returns the outputs of the neurons.
    pub fn forward(&self, input: Tensor<4>) -> Tensor<4> {
        let mut powers = vec![input.clone()];
        for _ in 1..self.order {
            if let Some(last) = powers.last() {
                powers.push(last.clone() * input.clone());
            }
        }
        let powers = Tensor::cat(powers, 1);
        let [_, _, height, width] = powers.dims();
        let bordered = powers.clone().pad((1, 1, 1, 1), 0.0f32);
        let linear = conv2d(&self.linear, powers);
        distances().zip(&self.products).fold(linear, |sum, ([down, right], weights)| {
            let [rows, columns] =
                [height + SIDE - 1 - down.unsigned_abs(), width + SIDE - 1 - right.unsigned_abs()];
            let part =
                |down: usize, right: usize| bordered.clone().narrow(2, down, rows).narrow(3, right, columns);
            let one = part(0, (-right).max(0).unsigned_abs());
            let other = part(down.unsigned_abs(), right.max(0).unsigned_abs());
            sum + weights.forward(one * other)
        })
    }
}

#[cfg(test)]
mod tests {
    use burn::tensor::TensorData;

    use super::*;

    /// Compares the layer with its definition at single positions: the values and every pair of them once.
    #[test]
    fn weighs_every_pair_once() {
        assert_eq!(distances().count(), 13);
        let device = Device::flex();
        device.seed(3);
        let layer = QuadraticConvolution::new([1, 1], 1, &device);
        let picture: Vec<f32> = (0..20).map(|at| ((at * at) as f32 * 0.7).sin()).collect();
        let input = Tensor::<4>::from_data(TensorData::new(picture.clone(), [1, 1, 4, 5]), &device);
        let output = layer.forward(input).into_data().try_to_vec::<f32>().unwrap();
        let numbers = |weights: Tensor<4>| weights.into_data().try_to_vec::<f32>().unwrap();
        let bias = layer.linear.bias.as_ref().unwrap().val().into_data().try_to_vec::<f32>().unwrap()[0];
        for (row, column) in [(0, 0), (1, 2), (3, 4), (2, 3)] {
            let value = |down: isize, right: isize| {
                let (row, column) = (row as isize + down - 1, column as isize + right - 1);
                let inside = (0..4).contains(&row) && (0..5).contains(&column);
                if inside { picture[(row * 5 + column) as usize] } else { 0.0 }
            };
            let linear = numbers(layer.linear.weight.val());
            let mut expected = bias;
            for (at, weight) in linear.iter().enumerate() {
                expected += weight * value(at as isize / 3, at as isize % 3);
            }
            for ([down, right], weights) in distances().zip(&layer.products) {
                let columns = 3 - right.abs();
                for (at, weight) in numbers(weights.weight.val()).iter().enumerate() {
                    let (i, j) = (at as isize / columns, at as isize % columns);
                    let one = value(i, j + (-right).max(0));
                    expected += weight * one * value(i + down, j + right.max(0));
                }
            }
            let actual = output[row * 5 + column];
            assert!((actual - expected).abs() < 1e-5, "{actual} {expected}");
        }
    }
}
