//! Rotated crops against plain resizing, copies, and a reference in double precision.

use opendr_engine::data::{Image, ImageView, Layout, PixelFormat};
use proptest::prelude::*;

use super::tests::{FORMATS, ORDERS, level, noise_image};
use super::*;
use crate::Similarity;

fn warped(preprocess: &Preprocess, view: ImageView<'_>, crop: &Similarity) -> Vec<f32> {
    let mut out = vec![f32::NAN; preprocess.len()];
    preprocess.warp_into(view, crop, &mut out).unwrap();
    out
}

/// Returns channel `channel` at a position: OpenCV's `warpAffine` in double precision.
fn sampled(view: &ImageView<'_>, [x, y]: [f64; 2], channel: usize, border: Border) -> f64 {
    let (x, y) = (x - 0.5, y - 0.5);
    let tap = |x: f64, y: f64| {
        let (right, bottom) = ((view.width() - 1) as f64, (view.height() - 1) as f64);
        match border {
            Border::Constant(level) if x < 0.0 || y < 0.0 || x > right || y > bottom => f64::from(level),
            _ => level(view, x.clamp(0.0, right) as usize, y.clamp(0.0, bottom) as usize, channel),
        }
    };
    let (left, top) = (x.floor(), y.floor());
    let row = |y: f64| tap(left, y) * (1.0 - (x - left)) + tap(left + 1.0, y) * (x - left);
    row(top) * (1.0 - (y - top)) + row(top + 1.0) * (y - top)
}

#[test]
fn identity_is_plain_preprocessing() {
    for (format, stored) in FORMATS.into_iter().flat_map(|f| [(f, Layout::Hwc), (f, Layout::Chw)]) {
        for bits in [8, 16, 32] {
            let image = noise_image([41, 30], format, stored, bits, 7);
            for (order, layout) in ORDERS.into_iter().flat_map(|o| [(o, Layout::Hwc), (o, Layout::Chw)]) {
                let preprocess = Preprocess::new(41, 30).order(order).layout(layout);
                let preprocess = preprocess.normalise([1.0, 2.0, 3.0], [0.5, 2.0, 1.0]);
                let mut plain = vec![0f32; preprocess.len()];
                preprocess.run_into(image.view(), &mut plain).unwrap();
                let warped = warped(&preprocess, image.view(), &Similarity::IDENTITY);
                assert!(plain.iter().zip(&warped).all(|(a, b)| (a - b).abs() < 1e-3), "{format:?} {order:?}");
            }
        }
    }
}

#[test]
fn quarter_turns_are_turned_copies() {
    let size = 24;
    let image = noise_image([size, size], PixelFormat::Rgb, Layout::Hwc, 8, 3);
    let preprocess = Preprocess::new(size, size).layout(Layout::Hwc);
    let centre = [size as f32 / 2.0; 2];
    for quarters in 0..4 {
        let angle = quarters as f32 * std::f32::consts::FRAC_PI_2;
        let crop = Similarity::rotated_square(centre, size as f32, angle, size);
        let mut bytes = vec![0u8; preprocess.len()];
        preprocess.warp_into(image.view(), &crop, &mut bytes).unwrap();
        for (y, x, c) in (0..size).flat_map(|y| (0..size).flat_map(move |x| (0..3).map(move |c| (y, x, c)))) {
            let last = size - 1;
            let (from_x, from_y) = match quarters {
                0 => (x, y),
                1 => (last - y, x),
                2 => (last - x, last - y),
                _ => (y, last - x),
            };
            let wanted = level(&image.view(), from_x, from_y, c);
            assert_eq!(f64::from(bytes[(y * size + x) * 3 + c]), wanted, "{quarters} quarters at {x},{y}");
        }
    }
}

#[test]
fn doubling_is_plain_resizing_within() {
    let image = noise_image([20, 16], PixelFormat::Bgr, Layout::Hwc, 8, 2);
    let preprocess = Preprocess::new(40, 32).border(Border::Replicate);
    let mut plain = vec![0f32; preprocess.len()];
    preprocess.run_into(image.view(), &mut plain).unwrap();
    let crop = Similarity::new(0.5, 0.0, [0.0, 0.0]);
    let warped = warped(&preprocess, image.view(), &crop);
    assert!(plain.iter().zip(&warped).all(|(a, b)| (a - b).abs() < 0.02));
}

#[test]
fn wrong_crops_and_buffers_are_refused() {
    let image = noise_image([4, 4], PixelFormat::Rgb, Layout::Hwc, 8, 1);
    let preprocess = Preprocess::new(8, 8);
    let mut out = vec![0f32; preprocess.len()];
    for crop in [
        Similarity::new(f32::NAN, 0.0, [0.0; 2]),
        Similarity::new(1.0, f32::NAN, [0.0; 2]),
        Similarity::new(1.0, 0.0, [f32::NEG_INFINITY, 0.0]),
        Similarity::new(0.0, 0.0, [0.0; 2]),
        Similarity::new(1e9, 0.0, [0.0; 2]),
        Similarity::rotated_square([0.0; 2], f32::INFINITY, 0.0, 8),
    ] {
        let error = preprocess.warp_into(image.view(), &crop, &mut out).unwrap_err();
        assert_eq!(error.kind(), opendr_engine::ErrorKind::InvalidInput);
    }
    assert!(preprocess.warp_into(image.view(), &Similarity::IDENTITY, &mut out[1..]).is_err());
    let none = Preprocess::new(0, 8).warp_into(image.view(), &Similarity::IDENTITY, &mut [0f32; 0]);
    assert_eq!(none.unwrap_err().kind(), opendr_engine::ErrorKind::InvalidParam);
}

#[test]
fn far_away_is_the_border() {
    let image = Image::from_rgb8(vec![200; 12 * 9 * 3], 12, 9).unwrap();
    let far = Similarity::new(3.0, 1.0, [4e8, -5e8]);
    let level = Preprocess::new(16, 16).border(Border::Constant(7.0)).normalise([1.0; 3], [2.0; 3]);
    assert!(warped(&level, image.view(), &far).iter().all(|value| *value == 3.0));
    let repeat = Preprocess::new(16, 16).border(Border::Replicate);
    assert!(warped(&repeat, image.view(), &far).iter().all(|value| *value == 200.0));
}

proptest! {
    #[test]
    fn any_crop_is_the_reference(
        source in [1usize..50, 1usize..40],
        target in [1usize..140, 1usize..120],
        scale in 0.05f32..4.0,
        angle in -4.0f32..4.0,
        origin in [-30.0f32..60.0, -30.0f32..60.0],
        format in prop::sample::select(&FORMATS[1..]),
        (stored_chw, out_hwc, repeat) in any::<(bool, bool, bool)>(),
        bits in prop::sample::select(&[8u32, 16, 32][..]),
        seed: u64,
    ) {
        let stored = if stored_chw { Layout::Chw } else { Layout::Hwc };
        let image = noise_image(source, format, stored, bits, seed);
        let border = if repeat { Border::Replicate } else { Border::Constant(114.0) };
        let layout = if out_hwc { Layout::Hwc } else { Layout::Chw };
        let preprocess = Preprocess::new(target[0], target[1]).border(border).layout(layout);
        let crop = Similarity::new(scale, angle, origin);
        let out = warped(&preprocess, image.view(), &crop);
        let rgb = image.format().rgb_offsets();
        let (sine, cosine) = f64::from(angle).sin_cos();
        let scale = f64::from(scale);
        for (y, x) in (0..target[1]).flat_map(|y| (0..target[0]).map(move |x| (y, x))) {
            let (across, down) = ((x as f64 + 0.5) * scale, (y as f64 + 0.5) * scale);
            let at = [
                across * cosine - down * sine + f64::from(origin[0]),
                across * sine + down * cosine + f64::from(origin[1]),
            ];
            for (c, channel) in rgb.into_iter().enumerate() {
                let index = if out_hwc { (y * target[0] + x) * 3 + c } else { (c * target[1] + y) * target[0] + x };
                let wanted = sampled(&image.view(), at, channel, border);
                prop_assert!((f64::from(out[index]) - wanted).abs() < 0.02, "{} is not {wanted}", out[index]);
            }
        }
    }
}
