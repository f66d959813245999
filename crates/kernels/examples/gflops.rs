//! Prints the speed of products and of a small network's step on one thread:
//! `cargo run --release -p opendr-kernels --example gflops`.
//!
//! One line for each case: name, microseconds, GFLOPS. `benches/gemm.py` reads them.

use std::time::Instant;

use opendr_engine::Random;
use opendr_kernels::{Activation, Compute, Matrix, MatrixMut, Network, Product, Tape};

fn main() {
    let compute = Compute::single();
    println!("# {} on {} thread", compute.isa(), compute.pool().threads());
    for [rows, columns, depth] in [
        [1, 64, 64],
        [8, 64, 64],
        [64, 64, 64],
        [256, 64, 64],
        [256, 2, 64],
        [256, 256, 256],
        [512, 512, 512],
        [1024, 1024, 1024],
    ] {
        let operations = 2.0 * (rows * columns * depth) as f64;
        let (a, b) = (random(rows * depth, 1), random(depth * columns, 2));
        let mut c = vec![0.0; rows * columns];
        let (left, right) = (Matrix::new(&a, rows, depth), Matrix::new(&b, depth, columns));
        let right_by_columns = Matrix::new(&b, columns, depth).transposed();
        let left_by_columns = Matrix::new(&a, depth, rows).transposed();
        for (name, left, right) in
            [("nn", left, right), ("nt", left, right_by_columns), ("tn", left_by_columns, right)]
        {
            let seconds = fastest(operations, || {
                Product::new().run(&compute, left, right, MatrixMut::new(&mut c, rows, columns));
            });
            report(&format!("{rows}x{columns}x{depth}-{name}"), seconds, operations);
        }
    }
    for batch in [1, 64, 256] {
        network(&compute, batch);
    }
}

/// A policy of two hidden layers of 64: forward, and forward and backward.
fn network(compute: &Compute, batch: usize) {
    let Ok(network) = Network::dense(&[4, 64, 64, 2], Activation::Tanh) else { return };
    let (parameters, mut gradients) = (random(network.parameters(), 1), vec![0.0; network.parameters()]);
    let (x, dy) = (random(batch * network.inputs(), 2), random(batch * network.outputs(), 3));
    let mut tape = Tape::default();
    let operations = 2.0 * (batch * network.parameters()) as f64;
    let seconds = fastest(operations, || {
        network.forward(compute, &parameters, &x, &mut tape);
    });
    report(&format!("policy-forward-{batch}"), seconds, operations);
    let seconds = fastest(3.0 * operations, || {
        gradients.fill(0.0);
        network.forward(compute, &parameters, &x, &mut tape);
        network.backward(compute, &parameters, &dy, &mut tape, Some(&mut gradients), false);
    });
    report(&format!("policy-forward-backward-{batch}"), seconds, 3.0 * operations);
}

fn random(length: usize, seed: u64) -> Vec<f32> {
    let mut random = Random::new(seed);
    (0..length).map(|_| random.uniform(-1.0, 1.0)).collect()
}

/// Returns the seconds of one call: the fastest of twenty rounds of some milliseconds each, because other programs
/// only add time.
fn fastest(operations: f64, mut call: impl FnMut()) -> f64 {
    let calls = (1e8 / operations).clamp(1.0, 20_000.0) as usize;
    let round = |_| {
        let start = Instant::now();
        (0..calls).for_each(|_| call());
        start.elapsed().as_secs_f64() / calls as f64
    };
    (0..20).map(round).fold(f64::INFINITY, f64::min)
}

fn report(name: &str, seconds: f64, operations: f64) {
    println!("{name} {:.3} {:.1}", seconds * 1e6, operations / seconds / 1e9);
}
