//! Benchmark of `SkeletonBuffer` with five persons per frame: adding a frame, and returning the last 300 frames of a person.
//!
//! `cargo bench -p opendr-actions --bench skeleton_buffer`

#![allow(missing_docs)]

use std::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use opendr_actions::skeleton_based_action_recognition::{SkeletonBuffer, SkeletonBufferOptions};
use opendr_engine::target::{Keypoint, Pose, PoseList};

const PERSONS: usize = 5;
const FRAMES: usize = 300;

fn poses() -> PoseList {
    let pose = |person: usize| {
        let joint =
            |at: usize| Keypoint { x: (200 * person + 5 * at) as f32, y: (20 * at) as f32, confidence: 0.9 };
        Pose { keypoints: (0..18).map(joint).collect(), id: Some(person as i64), ..Pose::default() }
    };
    PoseList { poses: (0..PERSONS).map(pose).collect(), ..PoseList::default() }
}

fn bench(criterion: &mut Criterion) {
    let options = SkeletonBufferOptions { frames: FRAMES, persons: PERSONS, ..Default::default() };
    let Ok(mut buffer) = SkeletonBuffer::new(options) else { return };
    let poses = poses();
    for _ in 0..FRAMES {
        buffer.push(&poses).ok();
    }
    criterion.bench_function("skeleton_buffer/push_5_persons", |bencher| {
        bencher.iter(|| buffer.push(black_box(&poses)));
    });
    criterion.bench_function("skeleton_buffer/sequence_of_300_frames", |bencher| {
        bencher.iter(|| black_box(buffer.sequences().next()));
    });
}

criterion_group!(benches, bench);
criterion_main!(benches);
