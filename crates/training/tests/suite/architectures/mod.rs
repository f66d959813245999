//! Architectures of the export tests. An example of the crate uses them, too, so they may unwrap.
#![allow(dead_code, clippy::unwrap_used)]

pub mod case;
mod networks;
mod operators;

use burn::module::Module;
use burn::nn::conv::Conv2dConfig;
use burn::nn::{LinearConfig, PaddingConfig2d};
use burn::tensor::Device;
use burn::tensor::activation::{log_softmax, softmax};
use opendr_training::layers::{
    Activation, ConvNormActConfig, GruConfig, InvertedResidualConfig, MobileNetV1Config, ResNet18Config,
    SeparableConvConfig,
};

use case::{Case, case};

/// A module without parameters, for operators.
#[derive(Module, Debug, Default)]
pub struct Nothing {
    unused: usize,
}

/// Returns every architecture.
pub fn all() -> Vec<Case> {
    let mut cases = vec![
        case(
            "mobilenet_v1",
            [1, 3, 64, 96],
            &["stride_8", "stride_16", "stride_32"],
            |device| MobileNetV1Config::new().with_width(0.25).with_taps(vec![8, 16, 32]).init(device),
            |network, x| network.features(x),
        ),
        case(
            "mobilenet_v1_stride_8_dilated",
            [1, 3, 48, 48],
            &["features"],
            |device| {
                let config =
                    MobileNetV1Config::new().with_width(0.25).with_output_stride(8).with_dilated(true);
                config.with_blocks(9).init(device)
            },
            |network, x| network.forward(x),
        ),
        case(
            "resnet18",
            [1, 3, 64, 64],
            &["logits"],
            |device| ResNet18Config::new(10).with_width(16).init(device),
            |network, x| network.forward(x),
        ),
        case(
            "resnet18_small",
            [1, 1, 32, 32],
            &["logits", "probabilities"],
            |device| {
                ResNet18Config::new(10).with_width(8).with_input_channels(1).with_small(true).init(device)
            },
            |network, x| {
                let logits = network.forward(x);
                (logits.clone(), softmax(logits, 1))
            },
        ),
        case(
            "mobilenet_v2_blocks",
            [1, 8, 20, 20],
            &["features"],
            |device| {
                let blocks = [([8, 8], 1, 1), ([8, 16], 6, 2), ([16, 16], 6, 1)];
                blocks.map(|(channels, expansion, stride)| {
                    let config = InvertedResidualConfig::new(channels).with_expansion(expansion);
                    config.with_stride(stride).init(device)
                })
            },
            |blocks, x| blocks.iter().fold(x, |x, block| block.forward(x)),
        ),
        case(
            "gru",
            [1, 12, 5],
            &["classes", "states"],
            |device| (GruConfig::new(5, 16).init(device), LinearConfig::new(16, 3).init(device)),
            |(gru, classifier), x| {
                let states = gru.forward(x);
                let last = states.clone().narrow(1, 11, 1).squeeze_dim::<2>(1);
                (log_softmax(classifier.forward(last), 1), states)
            },
        ),
        case(
            "separable_convolutions",
            [1, 4, 15, 17],
            &["features"],
            |device| {
                let first =
                    SeparableConvConfig::new([4, 8]).with_stride(2).with_activation(Activation::LeakyRelu);
                let second = SeparableConvConfig::new([8, 8]).with_kernel(5).with_dilation(2);
                (first.init(device), second.with_activation(Activation::Silu).init(device))
            },
            |(first, second), x| second.forward(first.forward(x)),
        ),
        case(
            "uneven_padding",
            [1, 4, 9, 10],
            &["features"],
            |device: &Device| {
                let config = Conv2dConfig::new([4, 6], [2, 4]).with_groups(2);
                let second = Conv2dConfig::new([6, 3], [3, 3]).with_padding(PaddingConfig2d::Same);
                (config.with_padding(PaddingConfig2d::Explicit(1, 0, 0, 2)).init(device), second.init(device))
            },
            |(first, second), x| second.forward(first.forward(x)),
        ),
    ];
    cases.extend(Activation::ALL.map(|activation| {
        case(
            activation.name(),
            [1, 3, 8, 8],
            &["features"],
            |device| ConvNormActConfig::new([3, 6]).with_activation(activation).init(device),
            |block, x| block.forward(x),
        )
    }));
    cases.extend(networks::all());
    cases.extend(operators::all());
    cases
}
