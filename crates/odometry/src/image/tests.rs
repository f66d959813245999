use opendr_engine::data::{Image, Layout, PixelFormat};

use super::*;

/// A smooth random surface: sums of waves.
fn brightness(x: f64, y: f64) -> f64 {
    let waves = [(0.31, 0.12), (-0.17, 0.29), (0.05, -0.41), (0.47, 0.33), (0.11, 0.07), (-0.38, 0.21)];
    128.0 + waves.iter().enumerate().map(|(at, (u, v))| 18.0 * (u * x + v * y + at as f64).sin()).sum::<f64>()
}

fn pyramid(dx: f64, dy: f64, brighter: f64) -> Pyramid {
    let (width, height) = (320, 240);
    let level =
        |at: usize| (brightness((at % width) as f64 - dx, (at / width) as f64 - dy) + brighter).round() as u8;
    let bytes: Vec<u8> = (0..width * height).map(level).collect();
    let image = Image::new(bytes, width, height, PixelFormat::Grey, Layout::Hwc).unwrap();
    let mut pyramid = Pyramid::default();
    pyramid.fill(&image);
    pyramid
}

#[test]
fn motion_is_found_to_a_tenth_of_a_pixel_whatever_the_brightness() {
    let (one, other) = (pyramid(0.0, 0.0, 0.0), pyramid(3.4, -2.3, 12.0));
    for place in [[100.0, 80.0], [160.5, 120.25], [220.0, 150.0]] {
        let found = follow(&one, &other, place, place, 3).unwrap();
        let error = (found.place[0] - place[0] - 3.4).abs().max((found.place[1] - place[1] + 2.3).abs());
        assert!(error < 0.1, "{found:?}");
        assert!(found.difference < 2.0, "{found:?}");
    }
}

#[test]
fn without_texture_or_outside_nothing_is_found() {
    let plain = Image::new(vec![90_u8; 320 * 240], 320, 240, PixelFormat::Grey, Layout::Hwc).unwrap();
    let mut flat = Pyramid::default();
    flat.fill(&plain);
    assert_eq!(follow(&flat, &flat, [100.0; 2], [100.0; 2], 3), None);
    let one = pyramid(0.0, 0.0, 0.0);
    for place in [[3.0, 100.0], [-1e9, 0.0], [f32::NAN, 50.0], [1e30, 1e30]] {
        assert_eq!(follow(&one, &one, place, place, 3), None, "{place:?}");
    }
    let mut corners = Vec::new();
    CornerFinder::default().find(flat.finest(), 32, std::iter::empty(), 100, &mut corners);
    assert!(corners.is_empty());
}

#[test]
fn corners_fill_free_cells() {
    let one = pyramid(0.0, 0.0, 0.0);
    let (mut finder, mut corners) = (CornerFinder::default(), Vec::new());
    finder.find(one.finest(), 20, std::iter::empty(), 1000, &mut corners);
    let all = corners.len();
    assert!(all > 100, "{all}");
    let taken = corners.clone();
    corners.clear();
    finder.find(one.finest(), 20, taken.into_iter(), 1000, &mut corners);
    assert!(corners.is_empty(), "{corners:?}");
    finder.find(one.finest(), 20, std::iter::empty(), 7, &mut corners);
    assert_eq!(corners.len(), 7);
}

#[test]
fn disparities_are_found() {
    let (left, right) = (pyramid(0.0, 0.0, 0.0), pyramid(-9.6, 0.0, 0.0));
    let found = find_disparity(&left, &right, [200.0, 100.0], 20).unwrap();
    assert!((found - 9.6).abs() < 0.15, "{found}");
    assert_eq!(find_disparity(&left, &right, [2.0, 2.0], 20), None);
}

#[test]
fn descriptors_of_one_corner_differ_in_few_bits() {
    let (one, other) = (pyramid(0.0, 0.0, 0.0), pyramid(4.0, 2.0, 20.0));
    let sampling = Sampling::new();
    let describe = |pyramid: &Pyramid, corner| sampling.describe(&pyramid.levels()[1], corner);
    let own = describe(&one, [120.0, 100.0]).unwrap();
    assert!(distance(&own, &describe(&other, [124.0, 102.0]).unwrap()) < 25);
    assert!(distance(&own, &describe(&other, [177.0, 60.0]).unwrap()) > 60);
    assert_eq!(describe(&one, [5.0, 100.0]), None);
}
