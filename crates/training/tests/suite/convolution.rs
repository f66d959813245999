//! Exported convolutions of any parameters equal Burn's.

use burn::module::Module;
use burn::nn::PaddingConfig2d;
use burn::nn::conv::{Conv2d, Conv2dConfig, ConvTranspose2d, ConvTranspose2dConfig};
use burn::tensor::{Device, Distribution, Tensor};
use opendr_inference::{Builtin, OnnxRuntime, Runtime, Session, TensorView};
use opendr_training::export::{self, Input};
use proptest::prelude::*;

/// Parameters of a convolution.
#[derive(Debug, Clone)]
struct Parameters {
    groups: usize,
    channels: [usize; 2],
    kernel: [usize; 2],
    stride: [usize; 2],
    dilation: [usize; 2],
    padding: [usize; 4],
    size: [usize; 2],
    bias: bool,
}

fn parameters() -> impl Strategy<Value = Parameters> {
    let two = |range: std::ops::RangeInclusive<usize>| [range.clone(), range];
    let pads = [0..=2_usize, 0..=2, 0..=2, 0..=2];
    (1..=3_usize, two(1..=2), two(1..=4), two(1..=3), two(1..=2), pads, two(9..=13), any::<bool>()).prop_map(
        |(groups, channels, kernel, stride, dilation, padding, size, bias)| Parameters {
            groups,
            channels: channels.map(|channels| channels * groups),
            kernel,
            stride,
            dilation,
            padding,
            size,
            bias,
        },
    )
}

impl Parameters {
    fn convolution(&self, device: &Device) -> Conv2d {
        let [top, left, bottom, right] = self.padding;
        Conv2dConfig::new(self.channels, self.kernel)
            .with_groups(self.groups)
            .with_stride(self.stride)
            .with_dilation(self.dilation)
            .with_padding(PaddingConfig2d::Explicit(top, left, bottom, right))
            .with_bias(self.bias)
            .init(device)
    }

    /// Padded within its kernel, as a transposed convolution must be.
    fn transposed(&self, device: &Device) -> ConvTranspose2d {
        let within = |axis: usize| self.padding[axis].min(self.kernel[axis] - 1);
        ConvTranspose2dConfig::new(self.channels, self.kernel)
            .with_groups(self.groups)
            .with_stride(self.stride)
            .with_padding([within(0), within(1)])
            .with_padding_out(self.stride.map(|stride| stride - 1))
            .with_bias(self.bias)
            .init(device)
    }
}

/// Returns the largest difference between Burn and a runtime, as a share of the largest magnitude.
fn difference<M: Module>(
    runtime: &dyn Runtime,
    network: &M,
    [channels, height, width]: [usize; 3],
    forward: impl Fn(&M, Tensor<4>) -> Tensor<4>,
) -> f32 {
    let input = Input::new("input", [1, channels, height, width]).open(0);
    let model = export::onnx(network, input, &["output"], &forward).unwrap();
    let shape = [2, channels, height, width];
    let input = Tensor::<4>::random(shape, Distribution::Normal(0.0, 1.0), &Device::flex());
    let values: Vec<f32> = input.clone().into_data().try_to_vec_as().unwrap();
    let answer = forward(network, input);
    let sizes = answer.dims();
    let answer: Vec<f32> = answer.into_data().try_to_vec_as().unwrap();
    let session = Session::open_with(runtime, &model, opendr_engine::Device::Cpu).unwrap();
    let mut apart = f32::INFINITY;
    session
        .run(&[TensorView::new(&shape, &values).unwrap()], |outputs| {
            if outputs[0].shape() == sizes {
                let magnitude = answer.iter().fold(1e-6_f32, |largest, value| largest.max(value.abs()));
                let pairs = outputs[0].values::<f32>()?.iter().zip(&answer);
                apart = pairs.map(|(a, b)| (a - b).abs() / magnitude).fold(0.0, f32::max);
            }
            Ok(())
        })
        .unwrap();
    apart
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn convolutions_agree(parameters in parameters()) {
        let _turn = crate::turn();
        let network = parameters.convolution(&Device::flex());
        let sizes = [parameters.channels[0], parameters.size[0], parameters.size[1]];
        for runtime in [&Builtin as &dyn Runtime, &*OnnxRuntime::find().unwrap()] {
            let apart = difference(runtime, &network, sizes, |network, x| network.forward(x));
            prop_assert!(apart < 1e-4, "{apart} in {}", runtime.name());
        }
    }

    #[test]
    fn transposed_convolutions_agree(parameters in parameters()) {
        let _turn = crate::turn();
        let network = parameters.transposed(&Device::flex());
        let sizes = [parameters.channels[0], parameters.size[0], parameters.size[1]];
        for runtime in [&Builtin as &dyn Runtime, &*OnnxRuntime::find().unwrap()] {
            let apart = difference(runtime, &network, sizes, |network, x| network.forward(x));
            prop_assert!(apart < 1e-4, "{apart} in {}", runtime.name());
        }
    }
}
