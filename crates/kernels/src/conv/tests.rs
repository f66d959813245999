use std::sync::Arc;

use opendr_engine::Random;

use super::*;
use crate::compute::Compute;
use crate::isa::Isa;
use crate::pool::WorkerPool;
use crate::unary::Unary;

/// The plain sum of products in double precision, channels last in and out.
fn reference(
    window: &Window,
    batch: usize,
    [groups, outputs, channels]: [usize; 3],
    x: &[f32],
    weights: &[f32],
    bias: &[f32],
) -> Vec<f64> {
    let [height, width] = window.input;
    let all = groups * channels;
    let mut y = Vec::new();
    for image in 0..batch {
        for oy in 0..window.output[0] {
            for ox in 0..window.output[1] {
                for (output, bias) in bias[..groups * outputs].iter().enumerate() {
                    let group = output / outputs;
                    let mut sum = f64::from(*bias);
                    for channel in 0..channels {
                        for ky in 0..window.kernel[0] {
                            for kx in 0..window.kernel[1] {
                                let y = (oy * window.strides[0] + ky * window.dilations[0])
                                    .wrapping_sub(window.pads[0]);
                                let x_at = (ox * window.strides[1] + kx * window.dilations[1])
                                    .wrapping_sub(window.pads[1]);
                                if y < height && x_at < width {
                                    let at = ((image * height + y) * width + x_at) * all
                                        + group * channels
                                        + channel;
                                    let tap = ((output * channels + channel) * window.kernel[0] + ky)
                                        * window.kernel[1]
                                        + kx;
                                    sum += f64::from(x[at]) * f64::from(weights[tap]);
                                }
                            }
                        }
                    }
                    y.push(sum);
                }
            }
        }
    }
    y
}

fn planes(x: &[f32], batch: usize, pixels: usize, channels: usize) -> Vec<f32> {
    let mut planes = vec![0.0; x.len()];
    for image in 0..batch {
        for pixel in 0..pixels {
            for channel in 0..channels {
                planes[(image * channels + channel) * pixels + pixel] =
                    x[(image * pixels + pixel) * channels + channel];
            }
        }
    }
    planes
}

fn numbers(random: &mut Random, count: usize) -> Vec<f32> {
    (0..count).map(|_| random.uniform(-1.0, 1.0)).collect()
}

fn pick(random: &mut Random, from: usize, to: usize) -> usize {
    from + (random.uniform(0.0, 0.9999) * (to - from + 1) as f32) as usize
}

fn window(random: &mut Random) -> Window {
    let kernel = [pick(random, 1, 5), pick(random, 1, 5)];
    let strides = [pick(random, 1, 3), pick(random, 1, 3)];
    let dilations = [pick(random, 1, 2), pick(random, 1, 2)];
    let input = [pick(random, 1, 20), pick(random, 1, 40)];
    let pads = [pick(random, 0, 3), pick(random, 0, 3)];
    let after = [pick(random, 0, 3), pick(random, 0, 3)];
    let output = [0, 1].map(|i| {
        let span = (kernel[i] - 1) * dilations[i] + 1;
        (input[i] + pads[i] + after[i]).checked_sub(span).map_or(0, |rest| rest / strides[i] + 1)
    });
    Window { kernel, strides, dilations, pads, input, output }
}

fn computes() -> Vec<Compute> {
    let sets = Isa::available();
    sets.iter()
        .flat_map(|&isa| [1, 2].map(|threads| Compute::new(isa, Arc::new(WorkerPool::new(threads)))))
        .collect()
}

#[test]
fn random_convolutions_equal_plain_sums() {
    let mut random = Random::new(1);
    for case in 0..300 {
        let (batch, window) = (pick(&mut random, 1, 2), window(&mut random));
        let [groups, outputs, channels] =
            [pick(&mut random, 1, 3), pick(&mut random, 1, 70), pick(&mut random, 1, 20)];
        let pixels = window.input[0] * window.input[1];
        let x = numbers(&mut random, batch * pixels * groups * channels);
        let weights = numbers(&mut random, groups * outputs * channels * window.kernel[0] * window.kernel[1]);
        let bias = numbers(&mut random, groups * outputs);
        let wanted = reference(&window, batch, [groups, outputs, channels], &x, &weights, &bias);
        let residual = numbers(&mut random, wanted.len());
        let mut first: Option<(String, Vec<f32>)> = None;
        for compute in computes() {
            let planar = case % 2 == 1;
            let filters = Filters::new(
                &compute,
                &weights,
                [groups, outputs, channels],
                window.kernel,
                Some(&bias),
                planar,
            );
            let (x, x_strides) = if planar {
                (
                    planes(&x, batch, pixels, groups * channels),
                    Strides::planar(window.input, groups * channels),
                )
            } else {
                (x.clone(), Strides::channels_last(window.input, groups * channels))
            };
            let y_strides = Strides::channels_last(window.output, groups * outputs);
            let conv = Convolution {
                filters: Arc::new(filters),
                window,
                batch,
                x: x_strides,
                y: y_strides,
                residual: y_strides,
                finish: Finish { activation: Unary::Relu, slopes: None, residual_last: case % 3 == 0 },
            };
            let mut y = vec![f32::NAN; wanted.len()];
            conv.run(&compute, &x, Some(&residual), &mut y);
            for (index, (&y, &wanted)) in y.iter().zip(&wanted).enumerate() {
                let add = f64::from(residual[index]);
                let wanted = if case % 3 == 0 { wanted.max(0.0) + add } else { (wanted + add).max(0.0) };
                assert!(
                    (f64::from(y) - wanted).abs() < 1e-3,
                    "case {case} {} {window:?}: {y} {wanted}",
                    compute.isa()
                );
            }
            let isa = compute.isa().to_string();
            match &first {
                Some((same, bits)) if *same == isa => {
                    assert!(bits.iter().zip(&y).all(|(a, b)| a.to_bits() == b.to_bits()))
                }
                _ => first = Some((isa, y)),
            }
        }
    }
}

#[test]
fn random_depthwise_convolutions_equal_plain_sums() {
    let mut random = Random::new(2);
    for case in 0..300 {
        let (batch, mut window) = (pick(&mut random, 1, 2), window(&mut random));
        if case % 2 == 0 {
            let size = [3, 5][case / 2 % 2];
            window = Window { kernel: [size; 2], dilations: [1; 2], ..window };
            window.output = [0, 1].map(|i| {
                (window.input[i] + window.pads[i])
                    .checked_sub(size)
                    .map_or(0, |rest| rest / window.strides[i] + 1)
            });
        }
        let channels = pick(&mut random, 1, 40);
        let x = numbers(&mut random, batch * window.input[0] * window.input[1] * channels);
        let weights = numbers(&mut random, channels * window.kernel[0] * window.kernel[1]);
        let bias = numbers(&mut random, channels);
        let wanted = reference(&window, batch, [channels, 1, 1], &x, &weights, &bias);
        for compute in computes() {
            let filters = DepthwiseFilters::new(&weights, channels, window.kernel, Some(&bias));
            let depthwise = DepthwiseConvolution {
                filters: Arc::new(filters),
                window,
                batch,
                x: Strides::channels_last(window.input, channels),
                y: Strides::channels_last(window.output, channels),
                finish: Finish::default(),
            };
            let mut y = vec![f32::NAN; wanted.len()];
            depthwise.run(&compute, &x, &mut y);
            for (&y, &wanted) in y.iter().zip(&wanted) {
                assert!(
                    (f64::from(y) - wanted).abs() < 1e-4,
                    "case {case} {} {window:?}: {y} {wanted}",
                    compute.isa()
                );
            }
        }
    }
}

#[test]
fn what_is_not_a_number_reaches_the_outputs_that_read_it() {
    for compute in computes() {
        let filters = Filters::new(&compute, &[1.0, 0.0, 2.0], [1, 1, 1], [1, 3], None, false);
        let window = Window {
            kernel: [1, 3],
            strides: [1; 2],
            dilations: [1; 2],
            pads: [0, 1],
            input: [1, 5],
            output: [1, 5],
        };
        let strides = Strides::channels_last([1, 5], 1);
        let conv = Convolution {
            filters: Arc::new(filters),
            window,
            batch: 1,
            x: strides,
            y: strides,
            residual: strides,
            finish: Finish::default(),
        };
        let mut y = [0.0; 5];
        conv.run(&compute, &[1.0, f32::NAN, 0.0, f32::INFINITY, 1.0], None, &mut y);
        assert!(y[0].is_nan() && y[1].is_nan() && y[2].is_nan(), "{y:?}");
        assert!(y[4].is_infinite(), "{y:?}");
    }
}

#[test]
fn a_pair_of_convolutions_equals_one_after_the_other() {
    let mut random = Random::new(3);
    for case in 0..12 {
        let batch = 1 + case % 2;
        let (inner, outer) = (pick(&mut random, 20, 40), pick(&mut random, 1, 70));
        let (side, step) = (pick(&mut random, 45, 60), 1 + case % 2);
        let input = [side * step, (side + 3) * step];
        let window = Window {
            kernel: [3; 2],
            strides: [step; 2],
            dilations: [1; 2],
            pads: [1; 2],
            input,
            output: [side, side + 3],
        };
        let x = numbers(&mut random, batch * input[0] * input[1] * inner);
        let taps = numbers(&mut random, inner * 9);
        let weights = numbers(&mut random, outer * inner);
        let bias = numbers(&mut random, outer);
        let residual = numbers(&mut random, batch * side * (side + 3) * outer);
        for compute in computes() {
            let between = Strides::channels_last(window.output, inner);
            let depthwise = DepthwiseConvolution {
                filters: Arc::new(DepthwiseFilters::new(&taps, inner, window.kernel, None)),
                window,
                batch,
                x: Strides::channels_last(input, inner),
                y: between,
                finish: Finish { activation: Unary::Relu, ..Finish::default() },
            };
            let filters = Filters::from_matrix(&compute, &weights, [inner, outer], true, Some(&bias));
            let y_strides = Strides::channels_last(window.output, outer);
            let one =
                Window { kernel: [1; 2], strides: [1; 2], pads: [0; 2], input: window.output, ..window };
            let pointwise = Convolution {
                filters: Arc::new(filters),
                window: one,
                batch,
                x: between,
                y: y_strides,
                residual: y_strides,
                finish: Finish { activation: Unary::Relu, slopes: None, residual_last: case % 3 == 0 },
            };
            let residual = (case % 4 > 0).then_some(residual.as_slice());
            let mut apart = vec![0.0; batch * between.image];
            let mut wanted = vec![f32::NAN; batch * y_strides.image];
            depthwise.run(&compute, &x, &mut apart);
            pointwise.run(&compute, &apart, residual, &mut wanted);
            let pair = DepthwisePointwise::new(&depthwise, &pointwise).unwrap();
            let mut y = vec![f32::NAN; wanted.len()];
            pair.run(&compute, &x, residual, &mut y);
            assert!(y.iter().zip(&wanted).all(|(a, b)| a.to_bits() == b.to_bits()), "case {case}");
            // Not the image that the first one writes.
            let other = Convolution { batch: batch + 1, ..pointwise };
            assert!(DepthwisePointwise::new(&depthwise, &other).is_none());
        }
    }
}

#[test]
fn winograd_convolutions_equal_plain_sums() {
    let mut random = Random::new(4);
    for case in 0..60 {
        let (batch, outputs, channels) =
            (pick(&mut random, 1, 2), pick(&mut random, 1, 40), pick(&mut random, 1, 40));
        let (input, pads) = (
            [pick(&mut random, 3, 20), pick(&mut random, 3, 30)],
            [pick(&mut random, 0, 2), pick(&mut random, 0, 2)],
        );
        let output = [0, 1].map(|i| input[i] + pads[i] + case % 2 - 2);
        let window = Window { kernel: [3; 2], strides: [1; 2], dilations: [1; 2], pads, input, output };
        let x = numbers(&mut random, batch * input[0] * input[1] * channels);
        let weights = numbers(&mut random, outputs * channels * 9);
        let bias = numbers(&mut random, outputs);
        let wanted = reference(&window, batch, [1, outputs, channels], &x, &weights, &bias);
        let residual = numbers(&mut random, wanted.len());
        let mut first: Option<(String, Vec<f32>)> = None;
        for compute in computes() {
            let filters = WinogradFilters::new(&compute, &weights, [outputs, channels], Some(&bias));
            let conv = Winograd {
                filters: Arc::new(filters),
                window,
                batch,
                y: Strides::channels_last(output, outputs),
                finish: Finish { activation: Unary::Relu, slopes: None, residual_last: case % 3 == 0 },
            };
            let mut y = vec![f32::NAN; wanted.len()];
            conv.run(&compute, &x, Some(&residual), &mut y);
            for (index, (&y, &wanted)) in y.iter().zip(&wanted).enumerate() {
                let add = f64::from(residual[index]);
                let wanted = if case % 3 == 0 { wanted.max(0.0) + add } else { (wanted + add).max(0.0) };
                let difference = (f64::from(y) - wanted).abs();
                assert!(difference < 2e-4, "case {case} {} {window:?}: {y} {wanted}", compute.isa());
            }
            let isa = compute.isa().to_string();
            match &first {
                Some((same, bits)) if *same == isa => {
                    assert!(bits.iter().zip(&y).all(|(a, b)| a.to_bits() == b.to_bits()))
                }
                _ => first = Some((isa, y)),
            }
        }
    }
}
