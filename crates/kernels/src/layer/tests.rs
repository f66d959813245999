//! Every layer against plain loops in double precision, every gradient against finite differences.

use std::sync::Arc;

use opendr_engine::{ErrorKind, Random};

use super::*;
use crate::{Activation, Compute, Isa, Layer, Network, Tape, WorkerPool};

mod reference;

fn random(length: usize, seed: u64) -> Vec<f32> {
    let mut random = Random::new(seed);
    (0..length).map(|_| random.uniform(-1.0, 1.0)).collect()
}

fn wide(values: &[f32]) -> Vec<f64> {
    values.iter().map(|&value| f64::from(value)).collect()
}

fn dot(weights: &[f32], values: &[f64]) -> f64 {
    weights.iter().zip(values).map(|(&weight, &value)| f64::from(weight) * value).sum()
}

fn assert_close(what: &str, ours: &[f32], exact: &[f64]) {
    assert_eq!(ours.len(), exact.len(), "{what}");
    let scale = exact.iter().fold(1.0f64, |scale, value| scale.max(value.abs()));
    for (index, (&ours, &exact)) in ours.iter().zip(exact).enumerate() {
        let error = (f64::from(ours) - exact).abs() / scale;
        assert!(error < 3e-6, "{what} {index}: {ours}, not {exact}");
    }
}

/// Compares a gradient at `at` with central differences of `loss`.
fn assert_gradient(what: &str, at: &[f32], gradient: &[f32], loss: impl Fn(&[f64]) -> f64) {
    let mut at = wide(at);
    let differences: Vec<f64> = (0..at.len())
        .map(|index| {
            let (middle, step) = (at[index], 1e-5);
            at[index] = middle + step;
            let above = loss(&at);
            at[index] = middle - step;
            let below = loss(&at);
            at[index] = middle;
            (above - below) / (2.0 * step)
        })
        .collect();
    assert_close(what, gradient, &differences);
}

/// Runs a network forward and backward on every instruction set and compares all results.
fn check(network: &Network, reference: impl Fn(&[f64], &[f64]) -> Vec<f64>, batch: usize) {
    let (x, parameters) = (random(batch * network.inputs(), 1), random(network.parameters(), 2));
    let weights = random(batch * network.outputs(), 3);
    for isa in Isa::available() {
        let compute = Compute::new(isa, Arc::new(WorkerPool::new(2)));
        let mut tape = Tape::default();
        let y = network.forward(&compute, &parameters, &x, &mut tape);
        assert_close("output", y, &reference(&wide(&parameters), &wide(&x)));
        let mut gradients = vec![0.0; network.parameters()];
        let dx = network.backward(&compute, &parameters, &weights, &mut tape, Some(&mut gradients), true);
        let (wide_x, wide_parameters) = (wide(&x), wide(&parameters));
        assert_gradient("parameter", &parameters, &gradients, |p| dot(&weights, &reference(p, &wide_x)));
        assert_gradient("input", &x, dx, |x| dot(&weights, &reference(&wide_parameters, x)));
    }
}

const ACTIVATIONS: [Activation; 4] =
    [Activation::Identity, Activation::Relu, Activation::Tanh, Activation::Sigmoid];

#[test]
fn dense_layers() {
    for activation in ACTIVATIONS {
        for [inputs, outputs, batch] in [[5, 3, 4], [3, 1, 40], [1, 19, 2], [17, 9, 1]] {
            let network =
                Network::new(vec![Layer::Dense(Dense::new(inputs, outputs, activation).unwrap())]).unwrap();
            check(&network, |p, x| reference::dense(p, x, [inputs, outputs], activation), batch);
        }
    }
}

#[test]
fn several_layers() {
    let network = Network::dense(&[3, 7, 6, 2], Activation::Tanh).unwrap();
    let reference = |p: &[f64], x: &[f64]| {
        let (first, rest) = p.split_at(28);
        let (second, third) = rest.split_at(48);
        let x = reference::dense(first, x, [3, 7], Activation::Tanh);
        let x = reference::dense(second, &x, [7, 6], Activation::Tanh);
        reference::dense(third, &x, [6, 2], Activation::Identity)
    };
    check(&network, reference, 5);
}

#[test]
fn convolutions() {
    for (picture, outputs, kernel, stride, padding, activation) in [
        ([2, 5, 6], 3, [3, 3], [1, 1], [0, 0], Activation::Tanh),
        ([1, 7, 5], 2, [3, 2], [2, 1], [1, 0], Activation::Identity),
        ([3, 4, 4], 2, [4, 4], [2, 3], [2, 1], Activation::Sigmoid),
        ([2, 3, 3], 4, [1, 1], [1, 1], [0, 0], Activation::Relu),
        ([1, 2, 2], 1, [5, 6], [1, 2], [2, 3], Activation::Identity),
        ([1, 1, 9], 2, [1, 3], [1, 4], [0, 2], Activation::Identity),
    ] {
        let layer = Conv2d::new(picture, outputs, kernel, stride, padding, activation).unwrap();
        let network = Network::new(vec![Layer::Conv2d(layer)]).unwrap();
        let reference = |p: &[f64], x: &[f64]| {
            reference::conv2d(p, x, picture, [outputs, kernel[0], kernel[1]], stride, padding, activation)
        };
        check(&network, reference, 3);
        check(&network, reference, 18);
    }
}

#[test]
fn normalisation_and_an_activation() {
    let network = Network::new(vec![
        Layer::LayerNorm(LayerNorm::new(6, 1e-5).unwrap()),
        Layer::Activation(Activation::Tanh, 6),
    ])
    .unwrap();
    let reference = |p: &[f64], x: &[f64]| {
        let y = reference::layer_norm(p, x, 6, f64::from(1e-5f32));
        y.iter().map(|y| y.tanh()).collect()
    };
    check(&network, reference, 4);
}

#[test]
fn recurrence_through_time() {
    let (inputs, size, steps, batch) = (3, 5, 6, 2);
    let gru = Gru::new(inputs, size).unwrap();
    let parameters = random(gru.parameters(), 1);
    let (x, state) = (random(steps * batch * inputs, 2), random(batch * size, 3));
    let weights = random(steps * batch * size, 4);
    let mut starts = vec![false; steps * batch];
    (starts[1], starts[4]) = (true, true);
    let loss = |p: &[f64], x: &[f64], state: &[f64]| {
        dot(&weights, &reference::gru(p, x, state, &starts, [inputs, size]))
    };
    let [wide_p, wide_x, wide_state] = [&parameters, &x, &state].map(|values| wide(values));
    for isa in Isa::available() {
        let compute = Compute::new(isa, Arc::new(WorkerPool::new(1)));
        let mut tape = GruTape::default();
        for _ in 0..2 {
            let states = gru.forward(&compute, &parameters, &x, &state, &starts, &mut tape);
            assert_close(
                "states",
                states,
                &reference::gru(&wide_p, &wide_x, &wide_state, &starts, [inputs, size]),
            );
            let mut gradients = vec![0.0; gru.parameters()];
            let (mut dx, mut dstate) = (vec![9.0; x.len()], vec![9.0; state.len()]);
            gru.backward(
                &compute,
                &parameters,
                &starts,
                &weights,
                &mut tape,
                &mut gradients,
                Some(&mut dx),
                Some(&mut dstate),
            );
            assert_gradient("parameter", &parameters, &gradients, |p| loss(p, &wide_x, &wide_state));
            assert_gradient("input", &x, &dx, |x| loss(&wide_p, x, &wide_state));
            assert_gradient("state", &state, &dstate, |state| loss(&wide_p, &wide_x, state));
        }
    }
}

#[test]
fn attention_between_sequences_with_padding() {
    for (size, heads, queries, keys, lengths) in
        [(6, 2, 3, 4, [4, 4]), (8, 1, 1, 5, [2, 5]), (6, 3, 5, 3, [1, 2]), (16, 2, 2, 19, [19, 7])]
    {
        let layer = MultiHeadAttention::new(size, heads).unwrap();
        let parameters = random(layer.parameters(), 1);
        let (query, memory) = (random(2 * queries * size, 2), random(2 * keys * size, 3));
        let weights = random(2 * queries * size, 4);
        let exact = |p: &[f64], query: &[f64], memory: &[f64]| {
            reference::attention(p, [query, memory], [size, heads], [queries, keys], &lengths)
        };
        let [wide_p, wide_query, wide_memory] = [&parameters, &query, &memory].map(|values| wide(values));
        for isa in Isa::available() {
            let compute = Compute::new(isa, Arc::new(WorkerPool::new(2)));
            let (mut tape, mut y) = (AttentionTape::default(), vec![9.0; query.len()]);
            for _ in 0..2 {
                let sequences = Sequences { queries, keys, lengths: Some(&lengths) };
                layer.forward(&compute, &parameters, [&query, &memory], sequences, &mut tape, &mut y);
                assert_close("attention", &y, &exact(&wide_p, &wide_query, &wide_memory));
                let (mut gradients, mut dy) = (vec![0.0; layer.parameters()], weights.clone());
                let inputs = [&query[..], &memory];
                let [dquery, dmemory] =
                    layer.backward(&compute, &parameters, inputs, &mut dy, &mut tape, &mut gradients);
                let loss = |p: &[f64], query: &[f64], memory: &[f64]| dot(&weights, &exact(p, query, memory));
                assert_gradient("parameter", &parameters, &gradients, |p| loss(p, &wide_query, &wide_memory));
                assert_gradient("query", &query, dquery, |query| loss(&wide_p, query, &wide_memory));
                assert_gradient("memory", &memory, dmemory, |memory| loss(&wide_p, &wide_query, memory));
            }
        }
    }
}

#[test]
fn gaussian_error_linear_units() {
    let (x, weights) = (random(37, 1).iter().map(|x| 4.0 * x).collect::<Vec<_>>(), random(37, 2));
    let exact = |x: &[f64]| x.iter().map(|&x| x * reference::normal_distribution(x)).collect::<Vec<_>>();
    for isa in Isa::available() {
        let (mut y, mut dx) = (vec![0.0; 37], weights.clone());
        Gelu.forward(&Compute::new(isa, Arc::new(WorkerPool::new(1))), &x, &mut y);
        assert_close("gelu", &y, &exact(&wide(&x)));
        Gelu.backward(isa, &x, &mut dx);
        assert_gradient("input", &x, &dx, |x| dot(&weights, &exact(x)));
    }
}

#[test]
fn embeddings_of_repeated_indices() {
    let (layer, indices) = (Embedding::new(4, 3).unwrap(), [2, 0, 2]);
    let (parameters, weights) = (random(12, 1), random(9, 2));
    let mut y = vec![1.0; 9];
    layer.add_forward(&parameters, indices.into_iter(), &mut y);
    assert_eq!([y[0], y[3], y[8]], [1.0 + parameters[6], 1.0 + parameters[0], 1.0 + parameters[8]]);
    let mut gradients = vec![0.0; 12];
    layer.backward(indices.into_iter(), &weights, &mut gradients);
    assert_gradient("vector", &parameters, &gradients, |p| {
        let rows = indices.iter().flat_map(|index| &p[index * 3..index * 3 + 3]);
        weights.iter().zip(rows).map(|(&weight, value)| f64::from(weight) * value).sum()
    });
}

/// A policy network for images: bit-identical on one thread and on three, forward and backward.
#[test]
fn threads_do_not_change_a_bit() {
    let first = Conv2d::new([2, 20, 20], 8, [5, 5], [2, 2], [1, 1], Activation::Relu).unwrap();
    let second = Conv2d::new(first.output_shape(), 12, [3, 3], [1, 1], [0, 0], Activation::Relu).unwrap();
    let network = Network::new(vec![
        Layer::Conv2d(first),
        Layer::Conv2d(second),
        Layer::Dense(Dense::new(second.outputs(), 96, Activation::Tanh).unwrap()),
        Layer::Dense(Dense::new(96, 3, Activation::Identity).unwrap()),
    ])
    .unwrap();
    let (batch, parameters) = (50, random(network.parameters(), 1));
    let (x, dy) = (random(batch * network.inputs(), 2), random(batch * 3, 3));
    let run = |threads| {
        let (compute, mut tape) = (Compute::with_threads(threads), Tape::default());
        let y = network.forward(&compute, &parameters, &x, &mut tape).to_vec();
        let mut gradients = vec![0.0; network.parameters()];
        let dx = network.backward(&compute, &parameters, &dy, &mut tape, Some(&mut gradients), true);
        (y, dx.to_vec(), gradients)
    };
    let alone = run(1);
    assert_eq!(alone, run(2));
    assert_eq!(alone, run(3));
}

#[test]
fn gradients_add_up_and_unwanted_ones_are_left_out() {
    let network = Network::dense(&[3, 4, 2], Activation::Relu).unwrap();
    let (compute, mut tape) = (Compute::single(), Tape::default());
    let (parameters, x, dy) = (random(network.parameters(), 1), random(6, 2), random(4, 3));
    let mut back = |gradients: Option<&mut [f32]>, wants_input| {
        network.forward(&compute, &parameters, &x, &mut tape);
        network.backward(&compute, &parameters, &dy, &mut tape, gradients, wants_input).to_vec()
    };
    let (mut once, mut twice) = (vec![0.0; network.parameters()], vec![0.0; network.parameters()]);
    let dx = back(Some(&mut once), true);
    back(Some(&mut twice), false);
    assert!(back(Some(&mut twice), false).is_empty());
    assert_eq!(dx, back(None, true));
    for (once, twice) in once.iter().zip(&twice) {
        assert!((2.0 * once - twice).abs() < 1e-6, "{once} {twice}");
    }
}

#[test]
fn impossible_shapes_are_errors() {
    let conv = |picture, kernel, stride| Conv2d::new(picture, 1, kernel, stride, [0, 0], Activation::Relu);
    let errors = [
        Dense::new(0, 3, Activation::Relu).unwrap_err(),
        Dense::new(usize::MAX, 3, Activation::Relu).unwrap_err(),
        conv([1, 4, 4], [5, 1], [1, 1]).unwrap_err(),
        conv([1, 4, 4], [1, 1], [0, 1]).unwrap_err(),
        conv([1, 1 << 20, 1 << 20], [1, 1], [1, 1]).unwrap_err(),
        LayerNorm::new(0, 1e-5).unwrap_err(),
        MultiHeadAttention::new(7, 2).unwrap_err(),
        MultiHeadAttention::new(4, 0).unwrap_err(),
        Embedding::new(1 << 20, 1 << 20).unwrap_err(),
        Gru::new(3, 0).unwrap_err(),
        Network::new(vec![]).unwrap_err(),
        Network::dense(&[3], Activation::Tanh).unwrap_err(),
        Network::new(vec![Layer::Activation(Activation::Relu, 3), Layer::Activation(Activation::Relu, 4)])
            .unwrap_err(),
    ];
    for error in errors {
        assert_eq!(error.kind(), ErrorKind::InvalidParam, "{error}");
    }
}
