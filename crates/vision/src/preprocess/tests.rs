//! Every path against one plain reference in double precision.

use opendr_engine::data::{Image, ImageView, Layout, PixelFormat, Pixels, Samples};
use proptest::prelude::*;

use super::*;

/// Returns the level of one sample.
pub(super) fn level(view: &ImageView<'_>, x: usize, y: usize, channel: usize) -> f64 {
    let [row, column, plane] = view.strides();
    let at = y * row + x * column + channel * plane;
    match view.samples() {
        Samples::U8(samples) => f64::from(samples[at]),
        Samples::U16(samples) => f64::from(samples[at]) / 257.0,
        Samples::F32(samples) => f64::from(samples[at]) * 255.0,
    }
}

/// Returns OpenCV's `INTER_LINEAR` at output pixel `(x, y)` of `width` x `height`.
fn blended(view: &ImageView<'_>, channel: usize, x: usize, y: usize, width: usize, height: usize) -> f64 {
    let position = |index: usize, source: usize, target: usize| {
        let at = (index as f64 + 0.5) * source as f64 / target as f64 - 0.5;
        let at = at.clamp(0.0, (source - 1) as f64);
        (at as usize, (at as usize + 1).min(source - 1), at.fract())
    };
    let (left, right, across) = position(x, view.width(), width);
    let (upper, lower, down) = position(y, view.height(), height);
    let row = |y| level(view, left, y, channel) * (1.0 - across) + level(view, right, y, channel) * across;
    row(upper) * (1.0 - down) + row(lower) * down
}

/// Returns the expected output of `preprocess` for `view`.
fn reference(preprocess: &Preprocess, view: &ImageView<'_>) -> Vec<f64> {
    let [width, height] = preprocess.size;
    let channels = preprocess.order.channels();
    let source = [view.width(), view.height()];
    let placement = match preprocess.letterbox {
        Some((anchor, _)) => Placement::letterbox(source, preprocess.size, anchor),
        None => Placement::stretch(preprocess.size),
    };
    let rgb = view.format().rgb_offsets();
    let mut out = vec![0.0; width * height * channels];
    for (y, x, c) in
        (0..height).flat_map(|y| (0..width).flat_map(move |x| (0..channels).map(move |c| (y, x, c))))
    {
        let (inside_x, inside_y) = (x.wrapping_sub(placement.x), y.wrapping_sub(placement.y));
        let blend = |channel| blended(view, channel, inside_x, inside_y, placement.width, placement.height);
        let level = if inside_x >= placement.width || inside_y >= placement.height {
            f64::from(preprocess.letterbox.unwrap().1)
        } else {
            match preprocess.order {
                ChannelOrder::Rgb => blend(rgb[c]),
                ChannelOrder::Bgr => blend(rgb[2 - c]),
                ChannelOrder::Grey if view.format().channels() == 1 => blend(0),
                ChannelOrder::Grey => 0.299 * blend(rgb[0]) + 0.587 * blend(rgb[1]) + 0.114 * blend(rgb[2]),
            }
        };
        let at = match preprocess.layout {
            Layout::Chw => (c * height + y) * width + x,
            Layout::Hwc => (y * width + x) * channels + c,
        };
        out[at] = level * f64::from(preprocess.scale[c]) + f64::from(preprocess.bias[c]);
    }
    out
}

/// Pseudo-random samples.
fn noise(count: usize, seed: u64) -> impl Iterator<Item = u32> {
    let mut state = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1;
    (0..count).map(move |_| {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state >> 32) as u32
    })
}

pub(super) fn noise_image(
    size: [usize; 2],
    format: PixelFormat,
    layout: Layout,
    bits: u32,
    seed: u64,
) -> Image {
    let samples = noise(size[0] * size[1] * format.channels(), seed);
    let pixels: Pixels = match bits {
        8 => samples.map(|sample| sample as u8).collect::<Vec<_>>().into(),
        16 => samples.map(|sample| sample as u16).collect::<Vec<_>>().into(),
        _ => samples.map(|sample| sample as f32 / u32::MAX as f32).collect::<Vec<_>>().into(),
    };
    Image::new(pixels, size[0], size[1], format, layout).unwrap()
}

/// Runs `preprocess` and compares with the reference, within 0.02 levels.
fn check(preprocess: &Preprocess, view: ImageView<'_>) {
    let expected = reference(preprocess, &view);
    let mut out = vec![f32::NAN; preprocess.len()];
    preprocess.run_into(view, &mut out).unwrap();
    let tolerance = preprocess.scale.iter().fold(0.0f32, |most, scale| most.max(scale.abs())) * 0.02;
    for (index, (value, wanted)) in out.iter().zip(&expected).enumerate() {
        assert!(
            (f64::from(*value) - wanted).abs() <= f64::from(tolerance),
            "{value} is not {wanted} at {index} of {preprocess:?} for {}x{} {:?}, strides {:?}",
            view.width(),
            view.height(),
            view.format(),
            view.strides(),
        );
    }
}

pub(super) const FORMATS: [PixelFormat; 5] =
    [PixelFormat::Grey, PixelFormat::Rgb, PixelFormat::Bgr, PixelFormat::Rgba, PixelFormat::Bgra];
pub(super) const ORDERS: [ChannelOrder; 3] = [ChannelOrder::Rgb, ChannelOrder::Bgr, ChannelOrder::Grey];

#[test]
fn every_combination_is_the_reference() {
    let mut seed = 0;
    for format in FORMATS {
        for (stored, bits) in [(Layout::Hwc, 8), (Layout::Chw, 8), (Layout::Hwc, 16), (Layout::Chw, 32)] {
            seed += 1;
            let image = noise_image([37, 23], format, stored, bits, seed);
            for (order, layout) in ORDERS.into_iter().flat_map(|o| [(o, Layout::Chw), (o, Layout::Hwc)]) {
                let stretched = Preprocess::new(19, 31).order(order).layout(layout);
                check(&stretched, image.view());
                let normalised = stretched.normalise([103.5, 116.3, 123.7], [57.4, 57.1, 58.4]);
                check(&normalised.clone().letterbox(LetterboxAlign::Centre, 114.0), image.view());
                check(
                    &normalised.letterbox(LetterboxAlign::TopLeft, 0.0),
                    image.view().crop(5, 3, 21, 30).unwrap(),
                );
            }
        }
    }
}

#[test]
fn large_inputs_are_cut_into_bands() {
    let image = noise_image([320, 180], PixelFormat::Bgr, Layout::Hwc, 8, 5);
    for threads in [1, 2, 3, 16] {
        let preprocess = Preprocess::new(131, 127).threads(threads);
        check(&preprocess, image.view());
        check(&preprocess.layout(Layout::Hwc).letterbox(LetterboxAlign::Centre, 7.0), image.view());
    }
}

#[test]
fn same_size_is_a_copy() {
    let image = noise_image([40, 30], PixelFormat::Rgb, Layout::Hwc, 8, 9);
    let preprocess = Preprocess::new(40, 30);
    let mut bytes = vec![0u8; preprocess.len()];
    preprocess.run_into(image.view(), &mut bytes).unwrap();
    assert_eq!(bytes, image.chw_u8());
}

#[test]
fn integers_are_rounded_and_cut() {
    let image = noise_image([50, 40], PixelFormat::Rgb, Layout::Hwc, 8, 3);
    for layout in [Layout::Chw, Layout::Hwc] {
        let preprocess = Preprocess::new(300, 9).layout(layout).normalise([128.0; 3], [0.9; 3]);
        let mut floats = vec![0f32; preprocess.len()];
        let mut ints = vec![0i32; preprocess.len()];
        let mut bytes = vec![0i8; preprocess.len()];
        preprocess.run_into(image.view(), &mut floats).unwrap();
        preprocess.run_into(image.view(), &mut ints).unwrap();
        preprocess.run_into(image.view(), &mut bytes).unwrap();
        for ((float, int), byte) in floats.iter().zip(&ints).zip(&bytes) {
            assert!((float - *int as f32).abs() <= 0.5001);
            assert_eq!(i32::from(*byte), (*int).clamp(-128, 127));
        }
        assert!(ints.iter().any(|int| *int > 127) && ints.iter().any(|int| *int < -128));
    }
}

#[test]
fn smallest_pictures_and_inputs() {
    for size in [[1, 1], [1, 7], [2, 1], [2, 2], [3, 1]] {
        for format in FORMATS {
            let image = noise_image(size, format, Layout::Hwc, 8, 4);
            for target in [[1, 1], [1, 9], [7, 2], [8, 8], [9, 1], [33, 2]] {
                check(&Preprocess::new(target[0], target[1]), image.view());
                check(
                    &Preprocess::new(target[0], target[1])
                        .letterbox(LetterboxAlign::Centre, 1.0)
                        .layout(Layout::Hwc),
                    image.view(),
                );
            }
        }
    }
}

#[test]
fn agrees_with_opencv() {
    // cv2.resize of OpenCV 5.0.0 (11-bit weights) on (37 x + 91 y) mod 256, 11x7 pixels.
    let down = [
        49, 117, 177, 157, 65, 133, 177, 21, 88, 156, 192, 36, 112, 180, 24, 91, 127, 195, 111, 83, 151, 72,
        126, 98,
    ];
    let wide = [
        61, 80, 106, 131, 157, 182, 207, 121, 88, 111, 77, 79, 104, 129, 155, 175, 17, 37, 62, 88, 113, 138,
        164, 189, 215, 232, 82, 35, 60, 86, 111, 131, 144, 163, 152, 60, 69, 95, 120, 146, 142, 111, 136,
        162, 171, 80, 68, 87,
    ];
    let samples: Vec<u8> = (0..77).map(|index| (index % 11 * 37 + index / 11 * 91) as u8).collect();
    let image = Image::new(samples, 11, 7, PixelFormat::Grey, Layout::Hwc).unwrap();
    for (size, wanted) in [([6, 4], &down[..]), ([16, 3], &wide)] {
        let mut out = vec![0u8; wanted.len()];
        Preprocess::new(size[0], size[1]).order(ChannelOrder::Grey).run_into(image.view(), &mut out).unwrap();
        assert!(out.iter().zip(wanted).all(|(value, wanted)| value.abs_diff(*wanted) <= 1), "{out:?}");
    }
}

#[test]
fn wrong_buffers_are_refused() {
    let image = noise_image([4, 4], PixelFormat::Rgb, Layout::Hwc, 8, 1);
    let few = Preprocess::new(8, 8).run_into(image.view(), &mut [0f32; 191]).unwrap_err();
    assert_eq!(few.kind(), opendr_engine::ErrorKind::InvalidInput);
    let none = Preprocess::new(0, 8).run_into(image.view(), &mut [0f32; 0]).unwrap_err();
    assert_eq!(none.kind(), opendr_engine::ErrorKind::InvalidParam);
}

#[test]
fn plain_kernel_is_the_reference_where_the_packed_one_runs() {
    let image = noise_image([61, 40], PixelFormat::Bgr, Layout::Hwc, 8, 6);
    for layout in [Layout::Chw, Layout::Hwc] {
        let preprocess = Preprocess::new(45, 52).layout(layout);
        let view = image.view();
        let source = Source::new(view, preprocess.finish(&view)).plain();
        let sizes = Sizes { source: [61, 40], target: [45, 52], step: 0 };
        let mut out = vec![0f32; preprocess.len()];
        preprocess.plans.with(sizes, |plan| {
            preprocess.write(&source, plan, Placement::stretch([45, 52]), &mut out);
        });
        for (value, wanted) in out.iter().zip(reference(&preprocess, &view)) {
            assert!((f64::from(*value) - wanted).abs() < 0.01);
        }
    }
}

proptest! {
    /// Random sizes, strides and alignments: crops begin at any byte and end at or before the end of the memory.
    #[test]
    fn any_crop_to_any_size(
        source in [1usize..90, 1usize..40],
        target in [1usize..70, 1usize..40],
        corner in [0usize..40, 0usize..20],
        cut in [0usize..6, 0usize..6],
        format in prop::sample::select(&FORMATS[1..]),
        order in prop::sample::select(&ORDERS[..]),
        interleaved: bool,
        letterbox: bool,
        seed: u64,
    ) {
        let image = noise_image(source, format, Layout::Hwc, 8, seed);
        let (x, y) = (corner[0].min(source[0] - 1), corner[1].min(source[1] - 1));
        let size = |axis: usize, start: usize| (source[axis] - start).saturating_sub(cut[axis]).max(1);
        let view = image.view().crop(x, y, size(0, x), size(1, y)).unwrap();
        let layout = if interleaved { Layout::Hwc } else { Layout::Chw };
        let preprocess = Preprocess::new(target[0], target[1]).order(order).layout(layout);
        let preprocess = preprocess.normalise([1.0, 2.0, 3.0], [2.0, 0.5, 1.0]);
        check(&if letterbox { preprocess.letterbox(LetterboxAlign::Centre, 9.0) } else { preprocess }, view);
    }
}
