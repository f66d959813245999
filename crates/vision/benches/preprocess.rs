//! Pre-processing of a decoded frame, with one thread per core.
//!
//! `benches/preprocess.py` runs this and the same with OpenCV and NumPy, and prints both.

#![allow(missing_docs, clippy::expect_used)]

use std::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use opendr_engine::data::{Image, Layout, PixelFormat};
use opendr_vision::{ChannelOrder, InputSample, LetterboxAlign, Preprocess, Similarity};

fn frame(width: usize, height: usize, layout: Layout) -> Image {
    let samples: Vec<u8> =
        (0..width * height * 3).map(|index| ((index * 2_654_435_761) >> 7) as u8).collect();
    Image::new(samples, width, height, PixelFormat::Bgr, layout).expect("the sample count matches the size")
}

fn case<T: InputSample + Default>(
    criterion: &mut Criterion,
    name: &str,
    preprocess: &Preprocess,
    image: &Image,
) {
    let mut out = vec![T::default(); preprocess.len()];
    criterion.bench_function(name, |bencher| {
        bencher.iter(|| preprocess.run_into(black_box(image.view()), black_box(&mut out)));
    });
}

fn preprocess(criterion: &mut Criterion) {
    let camera = frame(1920, 1080, Layout::Hwc);
    let centernet = Preprocess::new(512, 512);
    case::<f32>(criterion, "centernet_1080p", &centernet, &camera);
    let nanodet = Preprocess::new(416, 416)
        .order(ChannelOrder::Bgr)
        .normalise([103.53, 116.28, 123.675], [57.375, 57.12, 58.395]);
    case::<f32>(criterion, "nanodet_1080p", &nanodet, &camera);
    let letterbox = nanodet.letterbox(LetterboxAlign::Centre, 0.0);
    case::<f32>(criterion, "nanodet_letterbox_1080p", &letterbox, &camera);
    let posenet =
        Preprocess::new(385, 385).letterbox(LetterboxAlign::Centre, 0.0).normalise([127.5; 3], [127.5; 3]);
    case::<f32>(criterion, "posenet_1080p", &posenet, &camera);
    let yunet = Preprocess::new(640, 640).letterbox(LetterboxAlign::TopLeft, 0.0).order(ChannelOrder::Bgr);
    case::<f32>(criterion, "yunet_1080p", &yunet, &camera);
    let ultra_light = Preprocess::new(320, 240).normalise([127.0; 3], [128.0; 3]);
    case::<f32>(criterion, "ultra_light_1080p", &ultra_light, &camera);
    let movenet = Preprocess::new(192, 192).letterbox(LetterboxAlign::Centre, 0.0).layout(Layout::Hwc);
    case::<i32>(criterion, "movenet_1080p", &movenet, &camera);
    case::<f32>(criterion, "centernet_320x240", &centernet, &frame(320, 240, Layout::Hwc));
    case::<f32>(criterion, "centernet_1080p_chw", &centernet, &frame(1920, 1080, Layout::Chw));
    case::<f32>(criterion, "centernet_1080p_one_thread", &centernet.threads(1), &camera);
}

fn warp(criterion: &mut Criterion) {
    let camera = frame(1920, 1080, Layout::Hwc);
    let hand = Preprocess::new(224, 224).normalise([0.0; 3], [255.0; 3]).threads(1);
    let mut out = vec![0f32; hand.len()];
    for (name, angle) in [("warp_224_upright", 0.0), ("warp_224_turned", 0.7)] {
        let crop = Similarity::rotated_square([900.0, 500.0], 400.0, angle, 224);
        criterion.bench_function(name, |bencher| {
            bencher.iter(|| hand.warp_into(black_box(camera.view()), black_box(&crop), black_box(&mut out)));
        });
    }
}

criterion_group!(benches, preprocess, warp);
criterion_main!(benches);
