//! A 4K image with persons of about 40 pixels, in one pass and in two.
//!
//! `cargo bench -p opendr-pose --bench high_resolution`

#![allow(missing_docs, clippy::expect_used)]

use std::hint::black_box;
use std::path::Path;

use criterion::{Criterion, criterion_group, criterion_main};
use opendr_engine::Device;
use opendr_engine::data::Image;
use opendr_engine::learner::{Handle, Learner};
use opendr_engine::model::{Manifest, ModelWriter};
use opendr_pose::pose_estimation::{HighResolutionPoseEstimation, LightweightOpenPose};

fn handle<L: Learner>(name: &str) -> Handle<L> {
    let weights = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../models/weights/lightweight_open_pose");
    let folder = std::env::temp_dir().join(format!("opendr-bench-{name}-{}", std::process::id()));
    let mut writer = ModelWriter::new(&folder, Manifest::new(name, "")).expect("a folder");
    let network = std::fs::read(weights.join("openpose_default.onnx")).expect("the weights");
    writer.add("model.onnx", &network).expect("a new file");
    let mut handle = Handle::new(L::Params::default(), Device::Cpu).expect("valid parameters");
    handle.load_model(writer.finish().expect("a container")).expect("its network");
    std::fs::remove_dir_all(folder).ok();
    handle
}

/// Returns a grey image with four patches of stripes as small as the persons.
fn canvas() -> Image {
    let [width, height] = [3840, 2160];
    let mut pixels = vec![128; width * height * 3];
    for [left, top] in [[300, 400], [1900, 1000], [2500, 1700], [3500, 200]] {
        for (x, y) in (0..40).flat_map(|y| (0..16).map(move |x| (left + x, top + y))) {
            let level = if (x / 3 + y / 5) % 2 == 0 { 40 } else { 220 };
            pixels[(y * width + x) * 3..][..3].fill(level);
        }
    }
    Image::from_rgb8(pixels, width, height).expect("as many samples as the size says")
}

fn high_resolution(criterion: &mut Criterion) {
    let image = canvas();
    let mut group = criterion.benchmark_group("4k");
    group.sample_size(10);
    let mut plain = handle::<LightweightOpenPose>("lightweight_open_pose");
    group.bench_function("plain", |bencher| bencher.iter(|| plain.infer(black_box(&image))));
    let mut twice = handle::<HighResolutionPoseEstimation>("high_resolution_pose_estimation");
    group.bench_function("twice", |bencher| bencher.iter(|| twice.infer(black_box(&image))));
    group.finish();
}

criterion_group!(benches, high_resolution);
criterion_main!(benches);
