//! Reference implementations of the layers in double precision.

use crate::Activation;

pub(super) fn activate(activation: Activation, x: f64) -> f64 {
    match activation {
        Activation::Identity => x,
        Activation::Relu => x.max(0.0),
        Activation::Tanh => x.tanh(),
        Activation::Sigmoid => 1.0 / (1.0 + (-x).exp()),
    }
}

pub(super) fn dense(p: &[f64], x: &[f64], [inputs, outputs]: [usize; 2], activation: Activation) -> Vec<f64> {
    let sum = |x: &[f64], j: usize| -> f64 {
        let products = (0..inputs).map(|i| x[i] * p[i * outputs + j]);
        p[inputs * outputs + j] + products.sum::<f64>()
    };
    let row = |x: &[f64]| (0..outputs).map(|j| activate(activation, sum(x, j))).collect::<Vec<_>>();
    x.chunks(inputs).flat_map(row).collect()
}

pub(super) fn conv2d(
    p: &[f64],
    x: &[f64],
    [channels, height, width]: [usize; 3],
    [outputs, kernel_height, kernel_width]: [usize; 3],
    stride: [usize; 2],
    padding: [usize; 2],
    activation: Activation,
) -> Vec<f64> {
    let places = [
        (height + 2 * padding[0] - kernel_height) / stride[0] + 1,
        (width + 2 * padding[1] - kernel_width) / stride[1] + 1,
    ];
    let bias = &p[outputs * channels * kernel_height * kernel_width..];
    let mut result = Vec::new();
    for x in x.chunks(channels * height * width) {
        for (o, &bias) in bias.iter().enumerate() {
            for (i, j) in (0..places[0]).flat_map(|i| (0..places[1]).map(move |j| (i, j))) {
                let mut sum = bias;
                for c in 0..channels {
                    for (u, v) in (0..kernel_height).flat_map(|u| (0..kernel_width).map(move |v| (u, v))) {
                        let y = (i * stride[0] + u).wrapping_sub(padding[0]);
                        let z = (j * stride[1] + v).wrapping_sub(padding[1]);
                        if y < height && z < width {
                            let weight = ((o * channels + c) * kernel_height + u) * kernel_width + v;
                            sum += x[(c * height + y) * width + z] * p[weight];
                        }
                    }
                }
                result.push(activate(activation, sum));
            }
        }
    }
    result
}

pub(super) fn layer_norm(p: &[f64], x: &[f64], size: usize, epsilon: f64) -> Vec<f64> {
    let row = |x: &[f64]| {
        let mean = x.iter().sum::<f64>() / size as f64;
        let variance = x.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / size as f64;
        let normal = |i: usize| (x[i] - mean) / (variance + epsilon).sqrt();
        (0..size).map(|i| normal(i) * p[i] + p[size + i]).collect::<Vec<_>>()
    };
    x.chunks(size).flat_map(row).collect()
}

pub(super) fn gru(
    p: &[f64],
    x: &[f64],
    state: &[f64],
    starts: &[bool],
    [inputs, size]: [usize; 2],
) -> Vec<f64> {
    let (w, rest) = p.split_at(3 * size * inputs);
    let (u, biases) = rest.split_at(3 * size * size);
    let sigmoid = |x| activate(Activation::Sigmoid, x);
    let mut states: Vec<Vec<f64>> = state.chunks(size).map(<[f64]>::to_vec).collect();
    let batch = states.len();
    let mut result = Vec::new();
    for (sample, x) in x.chunks(inputs).enumerate() {
        let h = &mut states[sample % batch];
        if starts[sample] {
            h.fill(0.0);
        }
        let from_input = |k: usize| biases[k] + (0..inputs).map(|i| x[i] * w[i * 3 * size + k]).sum::<f64>();
        let from_state =
            |k: usize| biases[3 * size + k] + (0..size).map(|i| h[i] * u[i * 3 * size + k]).sum::<f64>();
        let next: Vec<f64> = (0..size)
            .map(|k| {
                let r = sigmoid(from_input(k) + from_state(k));
                let z = sigmoid(from_input(size + k) + from_state(size + k));
                let n = (from_input(2 * size + k) + r * from_state(2 * size + k)).tanh();
                (1.0 - z) * n + z * h[k]
            })
            .collect();
        result.extend_from_slice(&next);
        *h = next;
    }
    result
}

pub(super) fn attention(
    p: &[f64],
    [query, memory]: [&[f64]; 2],
    [size, heads]: [usize; 2],
    [queries, keys]: [usize; 2],
    lengths: &[usize],
) -> Vec<f64> {
    let width = size / heads;
    let (of_query, rest) = p.split_at((size + 1) * size);
    let (of_memory, of_output) = rest.split_at((size + 1) * 2 * size);
    let from = dense(of_query, query, [size, size], Activation::Identity);
    let all = dense(of_memory, memory, [size, 2 * size], Activation::Identity);
    let mut context = vec![0.0; query.len()];
    for (sample, &length) in lengths.iter().enumerate() {
        for (token, head) in (0..queries).flat_map(|token| (0..heads).map(move |head| (token, head))) {
            let own = (sample * queries + token) * size + head * width;
            let key = |key: usize| (sample * keys + key) * 2 * size + head * width;
            let score = |at: usize| {
                let products = (0..width).map(|i| from[own + i] * all[key(at) + i]);
                (products.sum::<f64>() / (width as f64).sqrt()).exp()
            };
            let sum: f64 = (0..length).map(score).sum();
            for at in 0..length {
                for i in 0..width {
                    context[own + i] += score(at) / sum * all[key(at) + size + i];
                }
            }
        }
    }
    dense(of_output, &context, [size, size], Activation::Identity)
}

/// Distribution function of the normal distribution, by Simpson's rule.
pub(super) fn normal_distribution(x: f64) -> f64 {
    let (steps, density) = (2000, |t: f64| (-0.5 * t * t).exp() / std::f64::consts::TAU.sqrt());
    let width = x / f64::from(steps);
    let weight = |i: i32| if i == 0 || i == steps { 1.0 } else { 2.0 + 2.0 * f64::from(i % 2) };
    0.5 + width / 3.0 * (0..=steps).map(|i| weight(i) * density(f64::from(i) * width)).sum::<f64>()
}
