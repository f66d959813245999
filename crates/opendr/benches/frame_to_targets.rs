//! Time from a decoded 1080p frame to targets, and of the bare session; the difference is pre- and post-processing.
//!
//! `OPENDR_TEST_DATA=../shared cargo bench -p opendr --bench frame_to_targets`; `benches/compare.py` runs the same in
//! Python beside it.

#![allow(clippy::unwrap_used, clippy::panic)]

#[path = "../tests/suite/models/mod.rs"]
mod models;

use criterion::{Criterion, criterion_group, criterion_main};
use opendr::data::PixelFormat;
use opendr::inference::{Session, TensorView};
use opendr::learner::Ports;
use opendr::params::ParamMap;
use opendr::{Device, Model};

fn frame_to_targets(criterion: &mut Criterion) {
    let Some(models) = models::Models::find() else { return };
    let photo = opendr::vision::open(models.data("photos/zidane.jpg")).unwrap();
    let frame = opendr::vision::resize(&photo, 1920, 1080).unwrap();
    assert_eq!(frame.format(), PixelFormat::Rgb);
    for entry in opendr::registry().entries() {
        let Some(path) = models.get(entry.spec.name) else { continue };
        let mut learner = entry.make(&ParamMap::new(), Device::Cpu).unwrap();
        learner.load(&path).unwrap();
        let mut group = criterion.benchmark_group(entry.spec.name);
        group.sample_size(50);
        group.bench_function("frame to targets", |bencher| {
            bencher.iter(|| learner.infer(&Ports::one(&frame)).unwrap());
        });
        let network = Model::open(&path).unwrap().file("model.onnx").unwrap();
        let session = Session::open(&network, Device::Cpu).unwrap();
        let dims: Vec<usize> = session.inputs()[0].dims.iter().map(|size| size.unwrap_or(256)).collect();
        let input = vec![0.0_f32; dims.iter().product()];
        group.bench_function("bare session", |bencher| {
            bencher.iter(|| session.run(&[TensorView::new(&dims, &input).unwrap()], |_| Ok(())).unwrap());
        });
        group.finish();
    }
}

criterion_group!(benches, frame_to_targets);
criterion_main!(benches);
