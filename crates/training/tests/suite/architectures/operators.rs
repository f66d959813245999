//! Every operation with a lowering, family by family.

use burn::tensor::activation::{leaky_relu, log_sigmoid, quiet_softmax, softmin, softplus};
use burn::tensor::module::{
    adaptive_avg_pool1d, adaptive_avg_pool2d, avg_pool1d, avg_pool2d, interpolate, max_pool1d, max_pool2d,
};
use burn::tensor::ops::{AvgPoolOptions, InterpolateMode, InterpolateOptions, MaxPoolOptions, PadMode};
use burn::tensor::{Int, Tensor};

use super::Nothing;
use super::case::{Case, OutputValues, case};

/// A case without parameters.
fn plain<const D: usize, A: OutputValues>(
    name: &'static str,
    shape: [usize; D],
    outputs: &[&str],
    forward: impl Fn(Tensor<D>) -> A,
) -> Case {
    case(name, shape, outputs, |_| Nothing::default(), |_, x| forward(x))
}

pub fn all() -> Vec<Case> {
    vec![
        plain("arithmetic", [1, 3, 4], &["a", "b", "c"], arithmetic),
        plain("functions", [1, 5], &["a", "b"], functions),
        plain("comparison", [1, 3, 4], &["a", "b", "c"], comparison),
        plain("reductions", [1, 3, 4], &["a", "b", "c", "d"], reductions),
        plain("rearrangement", [1, 6, 4], &["a", "b", "c", "d", "e"], rearrangement),
        plain("slices_of_the_batch", [1, 4], &["first", "last"], |x| {
            let [batch, _] = x.dims();
            (x.clone().narrow(0, 0, 1), x.narrow(0, batch - 1, 1))
        }),
        plain("indexing", [1, 6, 4], &["a", "b", "c"], indexing),
        plain("creation", [1, 3], &["a", "b"], creation),
        plain("padding", [1, 2, 5, 6], &["a", "b", "c"], padding),
        plain("poolings", [1, 2, 9, 11], &["a", "b", "c", "d", "e", "f"], poolings),
        plain("poolings_1d", [1, 2, 11], &["a", "b", "c"], poolings_1d),
        plain("resizings", [1, 2, 5, 6], &["a", "b", "c", "d", "e", "f"], resizings),
        plain("more_activations", [1, 3, 4], &["a", "b", "c", "d"], |x: Tensor<3>| {
            let leaky = leaky_relu(x.clone(), 0.3);
            (leaky, log_sigmoid(x.clone()), softmin(x.clone(), 2), softplus(quiet_softmax(x, 1), 2.0))
        }),
    ]
}

fn arithmetic(x: Tensor<3>) -> (Tensor<3>, Tensor<3>, Tensor<3>) {
    let y = x.clone() * 2.0 - 1.0;
    let sum = (x.clone() + y.clone()) / 3.0 - x.clone().mean_dim(1);
    let bounded = x.clone().clamp(-0.5, 0.7) + y.clone().clamp_min(-1.0) * y.clone().clamp_max(1.0);
    let powers = x.clone().powf_scalar(2.0) + x.clone().abs().add_scalar(0.1).powf(y.clone().abs())
        - x.clone().powi_scalar(3)
        + x.clone().remainder_scalar(0.7)
        + x.clone().div(y.clone().abs() + 1.0);
    (sum, bounded, powers + x.sign() - y.neg())
}

fn functions(x: Tensor<2>) -> (Tensor<2>, Tensor<2>) {
    let positive = x.clone().abs() + 0.2;
    let exact = positive.clone().log()
        + positive.clone().sqrt()
        + x.clone().exp()
        + positive.clone().recip()
        + positive.log1p();
    let waves = x.clone().sin() + x.clone().cos() + x.clone().tanh() + x.clone().erf();
    let rounded = x.clone().floor() + x.clone().ceil() + x.clone().round() + x.clone().int().float();
    (exact, waves + rounded)
}

fn comparison(x: Tensor<3>) -> (Tensor<3>, Tensor<3>, Tensor<3>) {
    let y = x.clone().mean_dim(2).expand(x.shape());
    let above = x.clone().greater(y.clone());
    let chosen = x.clone().mask_where(above.clone(), y.clone() * 10.0);
    let filled = x.clone().mask_fill(x.clone().lower_equal_elem(0.0).bool_and(above.clone().bool_not()), 5.0);
    let logic = x.clone().greater_equal_elem(0.1).bool_or(x.clone().lower(y)).float() + above.int().float();
    let any = x.clone().greater_elem(1.0).any_dim(2).float() + x.lower_elem(2.0).all_dim(2).float();
    (chosen, filled, logic + any)
}

fn reductions(x: Tensor<3>) -> (Tensor<3>, Tensor<2>, Tensor<3>, Tensor<1>) {
    let means = x.clone().mean_dim(2) + x.clone().sum_dim(2) - x.clone().var(2);
    let flat = x.clone().max_dim(1).squeeze_dim::<2>(1) * x.clone().min_dim(1).squeeze_dim::<2>(1);
    let places = x.clone().argmax(2).float() + x.clone().argmin(2).float() + x.clone().cumsum(2);
    let pooled: Tensor<3> = x.clone().prod_dim(1);
    (means, flat, places + pooled, x.clone().mean() + x.max())
}

fn rearrangement(x: Tensor<3>) -> (Tensor<3>, Tensor<4>, Tensor<2>, Tensor<3>, Tensor<3>) {
    let [batch, _, _] = x.dims();
    let parts = x.clone().chunk(3, 1);
    let swapped = Tensor::cat(vec![parts[2].clone(), parts[0].clone()], 1).swap_dims(1, 2);
    let permuted = x.clone().reshape([batch, 2, 3, 4]).permute([0, 3, 1, 2]);
    let flat = x.clone().slice([0..batch, 1..5, 0..4]).flatten::<2>(1, 2);
    let flipped = x.clone().flip([1, 2]).repeat_dim(2, 2);
    let expanded = x.clone().narrow(1, 0, 1).expand([batch, 3, 4]) + x.slice_dim(1, 1..=3);
    (swapped, permuted, flat, flipped, expanded)
}

fn indexing(x: Tensor<3>) -> (Tensor<3>, Tensor<3>, Tensor<3>) {
    let picks = Tensor::<1, Int>::from_data([5, 0, 2], &x.device());
    let selected = x.clone().select(1, picks);
    let order = x.clone().argsort(1).narrow(1, 0, 2);
    let gathered = x.clone().gather(1, order);
    (selected, gathered, x.topk(3, 2))
}

fn creation(x: Tensor<2>) -> (Tensor<2>, Tensor<3>) {
    let [batch, size] = x.dims();
    let device = x.device();
    let ones = Tensor::<2>::ones([batch, size], &device) * 2.0 + Tensor::full([1, size], 0.5, &device);
    let steps = Tensor::<1, Int>::arange(0..4, &device).float().reshape([1, 1, 4]);
    let grid = x.clone().unsqueeze_dim::<3>(2) * steps + Tensor::<3>::zeros([batch, 1, 4], &device);
    (x + ones, grid)
}

fn padding(x: Tensor<4>) -> (Tensor<4>, Tensor<4>, Tensor<4>) {
    (
        x.clone().pad([(1, 2), (0, 1)], PadMode::Constant(0.5)),
        x.clone().pad([(1, 2), (2, 1)], PadMode::Reflect),
        x.pad([(1, 2), (2, 1)], PadMode::Edge),
    )
}

type Six = (Tensor<4>, Tensor<4>, Tensor<4>, Tensor<4>, Tensor<4>, Tensor<4>);

fn poolings(x: Tensor<4>) -> Six {
    let maximum = MaxPoolOptions::new([3, 2]).with_stride([2, 2]).with_padding([1, 0]);
    let mean = AvgPoolOptions::new([3, 3]).with_stride([2, 2]).with_padding([1, 1]);
    (
        max_pool2d(x.clone(), maximum.clone()),
        max_pool2d(x.clone(), maximum.with_ceil_mode(true)),
        avg_pool2d(x.clone(), mean.clone().with_count_include_pad(true)),
        avg_pool2d(x.clone(), mean.with_count_include_pad(false)),
        adaptive_avg_pool2d(x.clone(), [3, 11]),
        adaptive_avg_pool2d(x, [4, 7]),
    )
}

fn poolings_1d(x: Tensor<3>) -> (Tensor<3>, Tensor<3>, Tensor<3>) {
    (
        max_pool1d(x.clone(), MaxPoolOptions::new([3]).with_stride([2]).with_padding([1])),
        avg_pool1d(x.clone(), AvgPoolOptions::new([4]).with_stride([3])),
        adaptive_avg_pool1d(x, 4),
    )
}

fn resizings(x: Tensor<4>) -> Six {
    let resized = |mode, corners, size| {
        let options = InterpolateOptions::new(mode).with_align_corners(corners).with_output_size(size);
        interpolate(x.clone(), options)
    };
    (
        resized(InterpolateMode::Nearest, false, [10, 9]),
        resized(InterpolateMode::Nearest, false, [7, 13]),
        resized(InterpolateMode::Bilinear, false, [9, 7]),
        resized(InterpolateMode::Bilinear, true, [10, 12]),
        resized(InterpolateMode::Bicubic, false, [8, 11]),
        resized(InterpolateMode::Bicubic, true, [10, 4]),
    )
}
