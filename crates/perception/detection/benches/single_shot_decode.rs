//! Decoding of the single-shot detector's outputs, without network and pre-processing: a 320 x 320 input, 1 and 80 classes.
//!
//! `cargo bench -p opendr-detection --bench single_shot_decode`

use std::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use opendr_detection::object_detection_2d::single_shot_detector::anchors::Anchors;
use opendr_detection::object_detection_2d::single_shot_detector::decode::LevelMaps;
use opendr_engine::Random;

const SIZE: usize = 320;

fn decode(criterion: &mut Criterion) {
    let anchors = Anchors::new(&[8, 16, 32, 64], &[3.0, 4.25], &[0.4, 1.0, 2.0]);
    for classes in [1, 80] {
        let mut random = Random::new(7);
        let maps: Vec<_> = anchors
            .levels
            .iter()
            .map(|level| {
                let cells = level.cells(SIZE).pow(2) * level.sides.len();
                // About one score in two thousand is above 0.2.
                let scores: Vec<f32> = (0..cells * classes).map(|_| random.uniform(-2800.0, 0.0)).collect();
                let offsets: Vec<f32> = (0..cells * 4).map(|_| random.uniform(-1.0, 1.0)).collect();
                (level.cells(SIZE), scores, offsets)
            })
            .collect();
        let mut candidates = Vec::new();
        criterion.bench_function(&format!("decode {classes} classes"), |bencher| {
            bencher.iter(|| {
                candidates.clear();
                for (level, (cells, scores, offsets)) in anchors.levels.iter().zip(&maps) {
                    let maps = LevelMaps { columns: *cells, rows: *cells, scores, offsets };
                    maps.decode(level, classes, 0.2, &mut candidates);
                }
                black_box(candidates.len())
            });
        });
    }
}

criterion_group!(benches, decode);
criterion_main!(benches);
