//! Encoding and decoding of the maps of one, five and twenty persons.
//!
//! `cargo bench -p opendr-pose --bench part_affinity`

#![allow(missing_docs, clippy::expect_used)]

use std::hint::black_box;

use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use opendr_engine::target::Keypoint;
use opendr_pose::pose_estimation::part_affinity::{
    DecodeScratch, FIELDS, Grid, HEAT_MAPS, JOINTS, MapEncoder, PartAffinity, PartMaps,
};

/// The maps of a 16:9 image at a height of 256 pixels.
const GRID: Grid = Grid { rows: 32, columns: 57, stride: 8.0 };

/// Returns joints in two columns, so that limbs are separate.
fn person(number: usize) -> [Keypoint; JOINTS] {
    let [left, top] = [20.0 + (number % 10) as f32 * 42.0, 10.0 + (number / 10) as f32 * 120.0];
    std::array::from_fn(|joint| {
        let (side, step) = (joint % 2, joint / 2);
        Keypoint { x: left + 18.0 * side as f32, y: top + 11.0 * step as f32, confidence: 1.0 }
    })
}

fn part_affinity(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("part_affinity");
    for count in [1, 5, 20] {
        let persons: Vec<_> = (0..count).map(person).collect();
        let [mut heat, mut fields] = [HEAT_MAPS, FIELDS].map(|maps| vec![0.0; maps * GRID.cells()]);
        let painter = MapEncoder::default();
        group.bench_function(BenchmarkId::new("paint", count), |bencher| {
            bencher.iter(|| painter.encode(GRID, black_box(&persons), &mut heat, &mut fields));
        });
        painter.encode(GRID, &persons, &mut heat, &mut fields);
        let maps = PartMaps::new(GRID, &heat, &fields).expect("as many numbers as the grid says");
        let (how, mut memory, mut found) = (PartAffinity::default(), DecodeScratch::default(), Vec::new());
        group.bench_function(BenchmarkId::new("decode", count), |bencher| {
            bencher.iter(|| how.decode(black_box(&maps), &mut memory, &mut found));
        });
    }
    group.finish();
}

criterion_group!(benches, part_affinity);
criterion_main!(benches);
