//! Benchmark of beat detection in a minute of an ECG at 360 Hz, on one thread.

#![allow(missing_docs, clippy::expect_used)]

use std::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use opendr_signals::beats::{BeatDetector, BeatSignal};

fn minute(criterion: &mut Criterion) {
    let wave =
        |at: usize| (-((at % 288) as f32 - 100.0).powi(2) / 36.0).exp() + 0.1 * (at as f32 * 0.01).sin();
    let samples: Vec<f32> = (0..60 * 360).map(wave).collect();
    let detector = BeatDetector::new(360.0).expect("a valid rate");
    criterion.bench_function("beats/minute", |bencher| {
        bencher.iter(|| {
            let (mut signal, mut beats) = (BeatSignal::default(), 0);
            detector.push(&mut signal, black_box(&samples), |_| beats += 1);
            detector.flush(&mut signal, |_| beats += 1);
            beats
        });
    });
}

criterion_group!(benches, minute);
criterion_main!(benches);
