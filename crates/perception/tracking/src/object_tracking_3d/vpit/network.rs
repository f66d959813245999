//! VPIT's network for training: features of views.

use burn::module::{Module, Param};
use burn::nn::conv::{Conv2d, Conv2dConfig};
use burn::tensor::module::conv2d;
use burn::tensor::ops::ConvOptions;
use burn::tensor::{Device, Tensor};
use opendr_training::layers::{ConvNormAct, ConvNormActConfig};
use opendr_training::operations;

use super::layout::{CELLS, CHANNELS, FEATURES, PLACES, TEMPLATE};

/// Channels of the first layer.
const FIRST: usize = 24;
/// Initial logit of a position.
const BIAS: f32 = -2.0;

/// The trainable network: four convolutions, the second with a stride, and the scale and bias of scores.
#[derive(Module, Debug)]
pub struct VpitNetwork {
    layers: Vec<ConvNormAct>,
    last: Conv2d,
    scale: Param<Tensor<1>>,
    bias: Param<Tensor<1>>,
}

impl VpitNetwork {
    /// Creates a network with random weights.
    pub fn new(device: &Device) -> Self {
        let layer = |from, to, stride| ConvNormActConfig::new([from, to]).with_stride(stride).init(device);
        Self {
            layers: vec![layer(CHANNELS, FIRST, 1), layer(FIRST, FEATURES, 2), layer(FEATURES, FEATURES, 1)],
            last: Conv2dConfig::new([FEATURES, FEATURES], [1, 1]).init(device),
            scale: Param::from_tensor(Tensor::full([1], 1.0, device)),
            bias: Param::from_tensor(Tensor::full([1], BIAS, device)),
        }
    }

    /// Computes features of views, `[views, channels, 64, 64]` to `[views, features, 32, 32]`.
    pub fn features(&self, views: Tensor<4>) -> Tensor<4> {
        operations::conv2d(&self.last, self.layers.iter().fold(views, |x, layer| layer.forward(x)))
    }

    /// Returns the logits `[pairs, positions, positions]` of the centres of `templates` at each position of `views`, both
    /// features; `shares` `[pairs, 1, 16, 16]` has the weight of each cell of a template.
    pub fn compare(&self, templates: Tensor<4>, shares: Tensor<4>, views: Tensor<4>) -> Tensor<3> {
        let [pairs, ..] = views.dims();
        let begin = (CELLS - TEMPLATE) / 2;
        let middle = begin..begin + TEMPLATE;
        let kernels = templates.slice([0..pairs, 0..FEATURES, middle.clone(), middle]) * shares;
        let views = views.reshape([1, pairs * FEATURES, CELLS, CELLS]);
        let options = ConvOptions::new([1, 1], [0, 0], [1, 1], pairs);
        let products = conv2d(views, kernels, None, options).reshape([pairs, PLACES, PLACES]);
        products * self.scale.val().reshape([1, 1, 1]) + self.bias.val().reshape([1, 1, 1])
    }

    /// Returns scale and bias of [`Self::compare`].
    pub fn scale_and_bias(&self) -> [f32; 2] {
        [&self.scale, &self.bias].map(|number| number.val().into_scalar::<f32>())
    }
}

#[cfg(test)]
mod tests {
    use opendr_engine::Random;

    use super::super::layout::{VIEW, VpitLayout};
    use super::super::template::Template;
    use super::*;

    /// Checks that training and inference compare alike.
    #[test]
    fn both_comparisons_agree() {
        let device = Device::flex();
        let network = VpitNetwork::new(&device);
        let mut random = Random::new(2);
        let mut views = || {
            let numbers: Vec<f32> = (0..CHANNELS * VIEW * VIEW).map(|_| random.normal() as f32).collect();
            network
                .features(Tensor::<1>::from_floats(&numbers[..], &device).reshape([1, CHANNELS, VIEW, VIEW]))
        };
        let (template, view) = (views(), views());
        let [scale, bias] = network.scale_and_bias();
        let layout = VpitLayout { pillar: 0.2, heights: [-0.5, 3.0], scale, bias };
        let covered: Vec<_> = layout.covered([4.0, 1.7], 0.25).collect();
        let mut shares = vec![0.0; TEMPLATE * TEMPLATE];
        covered.iter().for_each(|[row, column]| shares[row * TEMPLATE + column] = 1.0 / covered.len() as f32);
        let shares = Tensor::<1>::from_floats(&shares[..], &device).reshape([1, 1, TEMPLATE, TEMPLATE]);
        let numbers = |tensor: Tensor<4>| tensor.into_data().try_to_vec::<f32>().unwrap();
        let trained = network.compare(template.clone(), shares, view.clone());
        let trained = trained.into_data().try_to_vec::<f32>().unwrap();
        let (mut own, mut comparison) = (Template::default(), [0.0; PLACES * PLACES]);
        own.take(&layout, [4.0, 1.7], 0.25, &numbers(template));
        own.compare(&numbers(view), &mut comparison);
        for (trained, alike) in trained.iter().zip(comparison) {
            assert!((trained - (scale * alike + bias)).abs() < 1e-4, "{trained} {alike}");
        }
    }
}
