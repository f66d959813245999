use std::sync::Arc;

use opendr_engine::Random;

use super::*;
use crate::compute::Compute;
use crate::conv::Window;
use crate::isa::Isa;
use crate::pool::WorkerPool;

fn pick(random: &mut Random, from: usize, to: usize) -> usize {
    from + (random.uniform(0.0, 0.9999) * (to - from + 1) as f32) as usize
}

fn bytes(random: &mut Random, count: usize) -> Vec<u8> {
    (0..count).map(|_| pick(random, 0, 255) as u8).collect()
}

fn number(byte: u8, is_signed: bool) -> i32 {
    if is_signed { i32::from(byte as i8) } else { i32::from(byte) }
}

fn zero(random: &mut Random, is_signed: bool) -> ByteZero {
    let zero = pick(random, 0, 255) as i32 - if is_signed { 128 } else { 0 };
    ByteZero { zero, is_signed }
}

fn window(random: &mut Random) -> Window {
    let kernel = [pick(random, 1, 5), pick(random, 1, 5)];
    let strides = [pick(random, 1, 3), pick(random, 1, 3)];
    let dilations = [pick(random, 1, 3), pick(random, 1, 3)];
    let input = [pick(random, 1, 14), pick(random, 1, 30)];
    let pads = [pick(random, 0, 3), pick(random, 0, 3)];
    let after = [pick(random, 0, 3), pick(random, 0, 3)];
    let output = [0, 1].map(|i| {
        let span = (kernel[i] - 1) * dilations[i] + 1;
        (input[i] + pads[i] + after[i]).checked_sub(span).map_or(0, |rest| rest / strides[i] + 1)
    });
    Window { kernel, strides, dilations, pads, input, output }
}

/// The plain sums of a convolution of `groups` groups.
fn reference(
    window: &Window,
    batch: usize,
    groups: usize,
    x: &[u8],
    input: ByteZero,
    weights: &ByteWeights<'_>,
) -> Vec<i32> {
    let [height, width] = window.input;
    let all = groups * weights.channels;
    let mut y = Vec::new();
    for pixel in 0..batch * window.output[0] * window.output[1] {
        let (image, rest) =
            (pixel / (window.output[0] * window.output[1]), pixel % (window.output[0] * window.output[1]));
        let (oy, ox) = (rest / window.output[1], rest % window.output[1]);
        for output in 0..weights.outputs {
            let group = output / (weights.outputs / groups);
            let mut sum = weights.bias.get(output).copied().unwrap_or(0);
            for step in 0..weights.channels * window.kernel[0] * window.kernel[1] {
                let (channel, tap) = (step % weights.channels, step / weights.channels);
                let (ky, kx) = (tap / window.kernel[1], tap % window.kernel[1]);
                let iy = (oy * window.strides[0] + ky * window.dilations[0]).wrapping_sub(window.pads[0]);
                let ix = (ox * window.strides[1] + kx * window.dilations[1]).wrapping_sub(window.pads[1]);
                if iy < height && ix < width {
                    let at = ((image * height + iy) * width + ix) * all + group * weights.channels + channel;
                    let at_weight =
                        (output * weights.channels + channel) * window.kernel[0] * window.kernel[1] + tap;
                    sum += (number(x[at], input.is_signed) - input.zero)
                        * (weights.number(at_weight) - weights.zero(output));
                }
            }
            y.push(sum);
        }
    }
    y
}

fn rounded(sum: i32, scale: f32, output: &ByteOutput) -> u8 {
    let value = (sum as f32 * scale).round_ties_even() as i32;
    value.saturating_add(output.zero.zero).clamp(output.low, output.high) as u8
}

fn computes() -> Vec<Compute> {
    let sets = Isa::available();
    sets.iter()
        .flat_map(|&isa| [1, 2].map(|threads| Compute::new(isa, Arc::new(WorkerPool::new(threads)))))
        .collect()
}

struct Case {
    window: Window,
    batch: usize,
    input: ByteZero,
    output: ByteOutput,
    x: Vec<u8>,
    weights: Vec<u8>,
    is_signed: bool,
    zeros: Vec<i32>,
    bias: Vec<i32>,
    scales: Vec<f32>,
}

impl Case {
    fn new(random: &mut Random, index: usize, outputs: usize, channels: usize, groups: usize) -> Self {
        let (batch, mut window) = (pick(random, 1, 2), window(random));
        if index.is_multiple_of(3) {
            let size = window.input;
            window = Window {
                kernel: [1; 2],
                strides: [1; 2],
                dilations: [1; 2],
                pads: [0; 2],
                input: size,
                output: size,
            };
        }
        if groups > 1 {
            let size = [3, 5, 3, 4][index % 4];
            window = Window { kernel: [size; 2], dilations: [1 + index / 4 % 2; 2], ..window };
            window.output = [0, 1].map(|i| {
                let span = (size - 1) * window.dilations[i] + 1;
                (window.input[i] + window.pads[i])
                    .checked_sub(span)
                    .map_or(0, |rest| rest / window.strides[i] + 1)
            });
        }
        let (is_signed, is_input_signed) = (pick(random, 0, 1) == 1, pick(random, 0, 1) == 1);
        let input = zero(random, is_input_signed);
        let is_output_signed = pick(random, 0, 1) == 1;
        let mut output = ByteOutput::new(zero(random, is_output_signed));
        if index.is_multiple_of(4) {
            output.low = output.zero.zero;
            output.high -= 20;
            output.high = output.high.max(output.low);
        }
        let each = if index.is_multiple_of(2) { 1 } else { outputs };
        let zeros = (0..each)
            .map(|_| if index.is_multiple_of(5) { 0 } else { zero(random, is_signed).zero })
            .collect();
        Self {
            window,
            batch,
            input,
            output,
            x: bytes(random, batch * window.input[0] * window.input[1] * channels * groups),
            weights: bytes(random, outputs * channels * window.kernel[0] * window.kernel[1]),
            is_signed,
            zeros,
            bias: (0..outputs).map(|_| pick(random, 0, 20_000) as i32 - 10_000).collect(),
            scales: (0..each).map(|_| random.uniform(1e-5, 3e-3)).collect(),
        }
    }

    fn weights(&self, channels: usize) -> ByteWeights<'_> {
        ByteWeights {
            bytes: &self.weights,
            is_signed: self.is_signed,
            zeros: &self.zeros,
            outputs: self.bias.len(),
            channels,
            kernel: self.window.kernel,
            bias: &self.bias,
            scales: &self.scales,
        }
    }

    fn wanted(&self, sums: &[i32]) -> Vec<u8> {
        let outputs = self.bias.len();
        sums.iter()
            .enumerate()
            .map(|(i, &sum)| rounded(sum, self.weights(1).scale(i % outputs), &self.output))
            .collect()
    }
}

#[test]
fn random_convolutions_equal_plain_sums() {
    let mut random = Random::new(1);
    for index in 0..120 {
        let (outputs, channels) = (pick(&mut random, 1, 70), pick(&mut random, 1, 24));
        let case = Case::new(&mut random, index, outputs, channels, 1);
        let weights = case.weights(channels);
        let sums = reference(&case.window, case.batch, 1, &case.x, case.input, &weights);
        let wanted = case.wanted(&sums);
        for compute in computes() {
            let conv = ByteConvolution {
                filters: Arc::new(ByteFilters::new(&compute, &weights, case.input)),
                window: case.window,
                batch: case.batch,
                output: case.output,
            };
            let mut y = vec![7; wanted.len()];
            conv.run(&compute, &case.x, &mut y);
            assert!(y == wanted, "case {index} {} {:?}", compute.isa(), case.window);
            let mut y = vec![7; wanted.len()];
            conv.run_to_sums(&compute, &case.x, &mut y);
            assert!(y == sums, "case {index} {} {:?}", compute.isa(), case.window);
        }
    }
}

#[test]
fn random_depthwise_convolutions_equal_plain_sums() {
    let mut random = Random::new(2);
    for index in 0..200 {
        let channels = pick(&mut random, 2, 150);
        let case = Case::new(&mut random, index, channels, 1, channels);
        let mut weights = case.weights(1);
        weights.bytes = &case.weights;
        let sums = reference(&case.window, case.batch, channels, &case.x, case.input, &weights);
        let wanted = case.wanted(&sums);
        for compute in computes() {
            let conv = ByteDepthwise {
                filters: Arc::new(ByteDepthwiseFilters::new(&compute, &weights, case.input)),
                window: case.window,
                batch: case.batch,
                output: case.output,
            };
            let mut y = vec![7; wanted.len()];
            conv.run(&compute, &case.x, &mut y);
            assert!(y == wanted, "case {index} {} {:?} {:?}", compute.isa(), case.window, case.input);
        }
    }
}

#[test]
fn wide_products_use_several_shares_of_the_weights() {
    let mut random = Random::new(3);
    let (outputs, depth) = (300, 512);
    let size = [1, 3];
    let window = Window {
        kernel: [1; 2],
        strides: [1; 2],
        dilations: [1; 2],
        pads: [0; 2],
        input: size,
        output: size,
    };
    let mut case = Case::new(&mut random, 1, outputs, depth, 1);
    case.window = window;
    case.batch = 1;
    case.x = bytes(&mut random, 3 * depth);
    case.weights = bytes(&mut random, outputs * depth);
    let weights = case.weights(depth);
    let wanted = reference(&window, 1, 1, &case.x, case.input, &weights);
    for compute in computes() {
        let filters = Arc::new(ByteFilters::new(&compute, &weights, case.input));
        let conv = ByteConvolution { filters, window, batch: 1, output: case.output };
        let mut y = vec![0; wanted.len()];
        conv.run_to_sums(&compute, &case.x, &mut y);
        assert_eq!(y, wanted, "{}", compute.isa());
    }
}

#[test]
fn numbers_become_bytes_with_ties_to_even() {
    let output = ByteOutput::new(ByteZero { zero: 128, is_signed: false });
    let signed = ByteOutput::new(ByteZero { zero: -5, is_signed: true });
    for compute in computes() {
        let x = [0.0, 1.0, 3.0, -1.0, 1e9, -1e9, f32::NAN, 249.0];
        let mut y = [0; 8];
        quantize(&compute, &x, 2.0, output, &mut y);
        assert_eq!(y, [128, 128, 130, 128, 255, 0, 0, 252]);
        quantize(&compute, &x, 2.0, signed, &mut y);
        assert_eq!(y.map(|byte| byte as i8), [-5, -5, -3, -5, 127, -128, -128, 119]);
        let mut back = [0.0; 8];
        dequantize(&compute, &y, 2.0, signed.zero, &mut back);
        assert_eq!(back, [0.0, 0.0, 4.0, 0.0, 264.0, -246.0, -246.0, 248.0]);
    }
}

#[test]
fn sums_of_bytes_are_those_of_single_precision() {
    let mut random = Random::new(4);
    for case in 0..8 {
        let signs = [case & 1 != 0, case & 2 != 0, case & 4 != 0];
        let [a_zero, b_zero, y_zero] = signs.map(|is_signed| zero(&mut random, is_signed));
        let (a_ratio, b_ratio) = (random.uniform(0.1, 2.0), random.uniform(0.1, 2.0));
        let (a, b) = (bytes(&mut random, 70_000), bytes(&mut random, 70_000));
        let output = ByteOutput::new(y_zero);
        let fixed = y_zero.zero as f32 - (a_ratio * a_zero.zero as f32 + b_ratio * b_zero.zero as f32);
        for compute in computes() {
            let mut y = vec![0; a.len()];
            let sum = ByteSum { terms: [(a_zero, a_ratio), (b_zero, b_ratio)], output };
            sum.run(&compute, [&a, &b], &mut y);
            for ((&a, &b), &y) in a.iter().zip(&b).zip(&y) {
                let (a, b) = (number(a, signs[0]) as f32, number(b, signs[1]) as f32);
                let wanted = ((fixed + a * a_ratio) + b * b_ratio).round_ties_even() as i32;
                assert_eq!(number(y, signs[2]), wanted.clamp(output.low, output.high), "{a} {b}");
            }
        }
    }
}

#[test]
fn rows_of_bytes_are_added() {
    for compute in computes() {
        let x: Vec<u8> = (0..600).map(|i| (i % 251) as u8).collect();
        for is_signed in [false, true] {
            let mut sums = vec![1; 300];
            add_byte_rows(&compute, &x, is_signed, &mut sums);
            for (i, sum) in sums.into_iter().enumerate() {
                assert_eq!(sum, 1 + number(x[i], is_signed) + number(x[300 + i], is_signed));
            }
        }
    }
}

#[test]
fn resized_bytes_are_products_of_weights() {
    let mut random = Random::new(5);
    for is_signed in [false, true] {
        let resize = ByteResize {
            rows: vec![([0, 1], 0), ([0, 1], 300), ([2, 2], 1024)],
            columns: vec![([0, 1], 1000), ([1, 3], 512)],
            input: [3, 4],
            channels: 37,
            zero: ByteZero { zero: 0, is_signed },
        };
        let x = bytes(&mut random, 2 * 3 * 4 * 37);
        let unsigned = |byte: u8| i64::from(if is_signed { byte ^ 0x80 } else { byte });
        for compute in computes() {
            let mut y = vec![0; 2 * 3 * 2 * 37];
            resize.run(&compute, &x, &mut y);
            for (i, &y) in y.iter().enumerate() {
                let (channel, pixel) = (i % 37, i / 37);
                let ([top, bottom], down) = resize.rows[pixel / 2 % 3];
                let ([left, right], across) = resize.columns[pixel % 2];
                let at = |row: usize, column: usize| {
                    unsigned(x[((pixel / 6 * 3 + row) * 4 + column) * 37 + channel])
                };
                let (across, down) = (i64::from(across), i64::from(down));
                let above = at(top, left) * (1024 - across) + at(top, right) * across;
                let below = at(bottom, left) * (1024 - across) + at(bottom, right) * across;
                assert_eq!(unsigned(y), (above * (1024 - down) + below * down) >> 20);
            }
        }
    }
}
