//! Benchmark of the cepstra of one second of audio, on one thread; `mfcc.py` beside this file prints librosa's time.

#![allow(missing_docs, clippy::expect_used)]

use std::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use opendr_audio::mfcc::{Mfcc, MfccOptions};

fn recipes(criterion: &mut Criterion) {
    let second: Vec<f32> = (0..16_000).map(|at| ((at * at) as f32 * 1e-4).sin()).collect();
    let recipes =
        [("keywords", MfccOptions::keywords()), ("librosa_64", MfccOptions::librosa(16_000, 640, 480, 64))];
    for (name, options) in recipes {
        let mfcc = Mfcc::new(options).expect("valid options");
        let mut cepstra = Vec::new();
        criterion.bench_function(&format!("mfcc/{name}"), |bencher| {
            bencher.iter(|| mfcc.run_into(black_box(&second), black_box(&mut cepstra)));
        });
    }
}

criterion_group!(benches, recipes);
criterion_main!(benches);
