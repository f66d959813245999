//! Outputs and gradients of the operations equal those of Burn's.

use burn::module::Module;
use burn::nn::conv::{Conv1d, Conv1dConfig, Conv2d, Conv2dConfig};
use burn::nn::{BatchNorm, BatchNormConfig, PaddingConfig1d, PaddingConfig2d};
use burn::tensor::{Device, Distribution, Gradients, Tensor};
use opendr_training::layers::{Activation, GruConfig};
use opendr_training::operations::{add_act, batch_norm, batch_norm_act, conv1d, conv2d};

fn device() -> Device {
    Device::flex().autodiff()
}

fn random<const D: usize>(shape: [usize; D], device: &Device) -> Tensor<D> {
    Tensor::random(shape, Distribution::Uniform(-1.0, 1.0), device)
}

fn numbers<const D: usize>(tensor: Tensor<D>) -> Vec<f32> {
    tensor.into_data().iter::<f32>().collect()
}

fn assert_near(got: &[f32], wanted: &[f32], what: &str) {
    assert_eq!(got.len(), wanted.len(), "{what}");
    let largest = wanted.iter().fold(1e-3_f32, |largest, value| largest.max(value.abs()));
    for (i, (got, wanted)) in got.iter().zip(wanted).enumerate() {
        assert!((got - wanted).abs() <= 1e-4 * largest, "{what}, {i}: {got} in place of {wanted}");
    }
}

/// Output, gradient of the input and of parameters.
type Pass = Vec<Vec<f32>>;

/// Returns the output and the gradients of a loss that weighs each element differently.
fn pass<const D: usize, const O: usize>(
    x: &Tensor<D>,
    forward: impl FnOnce(Tensor<D>) -> Tensor<O>,
    parameters: impl FnOnce(&Gradients) -> Pass,
) -> Pass {
    let x = x.clone().detach().require_grad();
    let y = forward(x.clone());
    let count = y.dims().iter().product::<usize>();
    let weights = (0..count).map(|i| ((i * 37) % 11) as f32 - 5.0).collect::<Vec<_>>();
    let weights = Tensor::<1>::from_floats(weights.as_slice(), &y.device()).reshape(y.dims());
    let gradients = (y.clone() * weights).sum().backward();
    let mut all = vec![numbers(y), numbers(x.grad(&gradients).unwrap())];
    all.extend(parameters(&gradients));
    all
}

fn assert_passes(ours: &Pass, burns: &Pass, what: &str) {
    assert_eq!(ours.len(), burns.len());
    for (i, (ours, burns)) in ours.iter().zip(burns).enumerate() {
        assert_near(ours, burns, &format!("{what}, part {i}"));
    }
}

fn of_conv2d(layer: &Conv2d, gradients: &Gradients) -> Pass {
    let weight = layer.weight.val().grad(gradients).map(numbers);
    let bias = layer.bias.as_ref().and_then(|bias| bias.val().grad(gradients)).map(numbers);
    weight.into_iter().chain(bias).collect()
}

#[test]
fn convolutions_of_images() {
    let device = device();
    for (channels, kernel, stride, dilation, groups, bias) in [
        ([3, 8], [3, 3], [2, 2], [1, 1], 1, true),
        ([16, 24], [3, 3], [1, 1], [1, 1], 1, false),
        ([12, 12], [3, 3], [1, 1], [2, 2], 12, true),
        ([6, 9], [1, 1], [1, 1], [1, 1], 3, true),
        ([20, 20], [5, 3], [2, 1], [1, 1], 20, false),
    ] {
        let padding = PaddingConfig2d::Explicit(1, 2, 0, 1);
        let layer = Conv2dConfig::new(channels, kernel)
            .with_stride(stride)
            .with_dilation(dilation)
            .with_groups(groups)
            .with_bias(bias)
            .with_padding(padding)
            .init(&device);
        let x = random([2, channels[0], 24, 23], &device);
        let ours = pass(&x, |x| conv2d(&layer, x), |all| of_conv2d(&layer, all));
        let burns = pass(&x, |x| layer.forward(x), |all| of_conv2d(&layer, all));
        assert_passes(&ours, &burns, &format!("{layer:?}"));
        // Without gradients, and of images whose channels lie last.
        let (x, plain) = (x.inner(), layer.valid());
        let lying_last = x.clone().permute([0, 2, 3, 1]) * 1.0;
        let result = conv2d(&plain, lying_last.permute([0, 3, 1, 2]));
        assert_near(&numbers(result), &burns[0], "without gradients");
        assert_near(&numbers(conv2d(&plain, x)), &burns[0], "without gradients");
    }
}

#[test]
fn convolutions_of_sequences() {
    let device = device();
    for (groups, stride, dilation) in [(1, 1, 2), (6, 2, 1)] {
        let layer: Conv1d = Conv1dConfig::new(6, 12, 5)
            .with_groups(groups)
            .with_stride(stride)
            .with_dilation(dilation)
            .with_padding(PaddingConfig1d::Explicit(3, 1))
            .init(&device);
        let parameters = |all: &Gradients| {
            let bias = layer.bias.as_ref().unwrap().val();
            vec![numbers(layer.weight.val().grad(all).unwrap()), numbers(bias.grad(all).unwrap())]
        };
        let x = random([3, 6, 31], &device);
        let ours = pass(&x, |x| conv1d(&layer, x), parameters);
        let burns = pass(&x, |x| layer.forward(x), parameters);
        assert_passes(&ours, &burns, &format!("{layer:?}"));
    }
}

fn normalization(channels: usize, device: &Device) -> BatchNorm {
    let mut layer = BatchNormConfig::new(channels).init(device);
    layer.gamma = layer.gamma.map(|gamma| random(gamma.dims(), device).detach().require_grad());
    layer.beta = layer.beta.map(|beta| (random(beta.dims(), device) + 0.3).detach().require_grad());
    layer
}

#[test]
fn batch_normalizations() {
    let device = device();
    for activation in [Activation::Identity, Activation::Relu, Activation::Relu6, Activation::Silu] {
        let ours = normalization(10, &device);
        let burns = ours.clone().load_record(ours.clone().into_record());
        let x = random([4, 10, 7, 9], &device) * 3.0 + 0.5;
        let parameters = |layer: &BatchNorm, all: &Gradients| {
            vec![numbers(layer.gamma.val().grad(all).unwrap()), numbers(layer.beta.val().grad(all).unwrap())]
        };
        let by_us = pass(&x, |x| batch_norm_act(&ours, activation, x), |all| parameters(&ours, all));
        let by_burn =
            pass(&x, |x| activation_of_burn(activation, burns.forward(x)), |all| parameters(&burns, all));
        assert_passes(&by_us, &by_burn, activation.name());
        let running = |layer: &BatchNorm| {
            [numbers(layer.running_mean.value_sync()), numbers(layer.running_var.value_sync())]
        };
        for (ours, burns) in running(&ours).iter().zip(&running(&burns)) {
            assert_near(ours, burns, "running statistics");
        }
        let frozen = ours.clone().freeze();
        let by_us = pass(&x, |x| batch_norm_act(&frozen, activation, x), |_| Vec::new());
        let by_burn = pass(&x, |x| activation_of_burn(activation, frozen.forward(x)), |_| Vec::new());
        assert_passes(&by_us, &by_burn, "frozen");
        let (plain, x) = (ours.valid(), x.inner());
        let wanted = numbers(activation_of_burn(activation, plain.forward(x.clone())));
        assert_near(&numbers(batch_norm_act(&plain, activation, x)), &wanted, "without gradients");
    }
    let layer = normalization(5, &device);
    let x = random([40, 5], &device);
    let burns = layer.clone().load_record(layer.clone().into_record());
    let (ours, burns) =
        (pass(&x, |x| batch_norm(&layer, x), |_| Vec::new()), pass(&x, |x| burns.forward(x), |_| Vec::new()));
    assert_passes(&ours, &burns, "vectors");
}

fn activation_of_burn<const D: usize>(activation: Activation, x: Tensor<D>) -> Tensor<D> {
    use burn::tensor::activation::{hard_swish, leaky_relu, relu, relu6, sigmoid, silu, tanh};
    match activation {
        Activation::Identity => x,
        Activation::Relu => relu(x),
        Activation::Relu6 => relu6(x),
        Activation::LeakyRelu => leaky_relu(x, 0.1),
        Activation::HardSwish => hard_swish(x),
        Activation::Silu => silu(x),
        Activation::Gelu => burn::tensor::activation::gelu(x),
        Activation::Sigmoid => sigmoid(x),
        Activation::Tanh => tanh(x),
    }
}

#[test]
fn activations_and_sums() {
    let device = device();
    let x = random([2, 5, 6, 7], &device) * 8.0;
    // Its channels lie last.
    let other = random([2, 6, 7, 5], &device).permute([0, 3, 1, 2]);
    for activation in Activation::ALL {
        let ours = pass(&x, |x| activation.apply(x), |_| Vec::new());
        let burns = pass(&x, |x| activation_of_burn(activation, x), |_| Vec::new());
        assert_passes(&ours, &burns, activation.name());
        let ours = pass(&x, |x| add_act(x.clone(), other.clone(), activation) + x, |_| Vec::new());
        let burns =
            pass(&x, |x| activation_of_burn(activation, x.clone() + other.clone()) + x, |_| Vec::new());
        assert_passes(&ours, &burns, activation.name());
    }
}

#[test]
fn recurrent_units() {
    let device = device();
    let unit = GruConfig::new(3, 20).init(&device);
    let x = random([4, 9, 3], &device);
    let parameters = |all: &Gradients| {
        let weights =
            [&unit.weight_ih_l0, &unit.weight_hh_l0].map(|weight| numbers(weight.val().grad(all).unwrap()));
        let biases = [&unit.bias_ih_l0, &unit.bias_hh_l0].map(|bias| numbers(bias.val().grad(all).unwrap()));
        weights.into_iter().chain(biases).collect()
    };
    let ours = pass(&x, |x| unit.forward(x), parameters);
    let burns = by_steps(&unit, &x, parameters);
    assert_passes(&ours, &burns, "GRU");
    let plain = unit.valid();
    assert_near(&numbers(plain.forward(x.inner())), &ours[0], "without gradients");
}

/// The equations of the unit, operation by operation.
fn by_steps(
    unit: &opendr_training::layers::Gru,
    x: &Tensor<3>,
    parameters: impl FnOnce(&Gradients) -> Pass,
) -> Pass {
    use burn::tensor::activation::{sigmoid, tanh};
    let forward = |x: Tensor<3>| -> Tensor<3> {
        let [batch, time, features] = x.dims();
        let hidden = 20;
        let mut state = Tensor::<2>::zeros([batch, hidden], &x.device());
        let mut states = Vec::new();
        for step in 0..time {
            let now = x.clone().narrow(1, step, 1).reshape([batch, features]);
            let from_x =
                now.matmul(unit.weight_ih_l0.val().transpose()) + unit.bias_ih_l0.val().unsqueeze::<2>();
            let from_state = state.clone().matmul(unit.weight_hh_l0.val().transpose())
                + unit.bias_hh_l0.val().unsqueeze::<2>();
            let gate = |of: &Tensor<2>, index: usize| of.clone().narrow(1, index * hidden, hidden);
            let reset = sigmoid(gate(&from_x, 0) + gate(&from_state, 0));
            let update = sigmoid(gate(&from_x, 1) + gate(&from_state, 1));
            let new = tanh(gate(&from_x, 2) + reset * gate(&from_state, 2));
            state = new.clone() + update * (state - new);
            states.push(state.clone());
        }
        Tensor::stack(states, 1)
    };
    pass(x, forward, parameters)
}
