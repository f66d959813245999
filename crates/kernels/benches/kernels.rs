//! Matrix products and training steps of small networks: `cargo bench -p opendr-kernels`.

use std::hint::black_box;
use std::time::Duration;

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use opendr_engine::Random;
use opendr_kernels::{
    Activation, Adam, AdamOptions, Compute, Matrix, MatrixMut, Network, Product, Tape, tanh_in_place,
};

fn random(length: usize, seed: u64) -> Vec<f32> {
    let mut random = Random::new(seed);
    (0..length).map(|_| random.uniform(-1.0, 1.0)).collect()
}

fn products(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("product");
    let compute = Compute::single();
    for side in [64, 256, 512] {
        let (a, b, mut c) = (random(side * side, 1), random(side * side, 2), vec![0.0; side * side]);
        group.throughput(Throughput::Elements(2 * (side as u64).pow(3)));
        group.bench_function(BenchmarkId::from_parameter(side), |bencher| {
            bencher.iter(|| {
                let (a, b) = (Matrix::new(&a, side, side), Matrix::new(&b, side, side));
                Product::new().run(&compute, black_box(a), b, MatrixMut::new(&mut c, side, side));
            });
        });
    }
}

fn networks(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("forward, backward, Adam");
    for (name, sizes, batch) in
        [("4-64-64-2 of 64", [4, 64, 64, 2], 64), ("4-256-256-1 of 256", [4, 256, 256, 1], 256)]
    {
        let Ok(network) = Network::dense(&sizes, Activation::Tanh) else { continue };
        let (compute, mut tape) = (Compute::single(), Tape::default());
        let mut parameters = random(network.parameters(), 1);
        let mut gradients = vec![0.0; network.parameters()];
        let mut adam = Adam::new(network.parameters(), AdamOptions::default());
        let (x, dy) = (random(batch * network.inputs(), 2), random(batch * network.outputs(), 3));
        group.bench_function(name, |bencher| {
            bencher.iter(|| {
                gradients.fill(0.0);
                network.forward(&compute, &parameters, black_box(&x), &mut tape);
                network.backward(&compute, &parameters, &dy, &mut tape, Some(&mut gradients), false);
                adam.step(&compute, 1e-6, &mut parameters, &gradients);
            });
        });
    }
}

fn elementary(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("elementary");
    let (compute, mut values) = (Compute::single(), random(4096, 1));
    group.throughput(Throughput::Elements(4096));
    group.bench_function("tanh", |bencher| {
        bencher.iter(|| tanh_in_place(compute.isa(), black_box(&mut values)))
    });
}

criterion_group! {
    name = benches;
    config = Criterion::default()
        .sample_size(20)
        .warm_up_time(Duration::from_millis(300))
        .measurement_time(Duration::from_secs(1));
    targets = products, networks, elementary
}
criterion_main!(benches);
