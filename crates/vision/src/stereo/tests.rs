use opendr_engine::data::{Image, Layout, PixelFormat};

use super::*;

/// A pseudo-random grey level.
fn texture(x: usize, y: usize) -> u8 {
    let mixed = (x as u64 * 0x9E37_79B9 + y as u64 * 0x85EB_CA6B).wrapping_mul(0xC2B2_AE35_27D4_EB4F);
    (mixed >> 40) as u8
}

fn grey(width: usize, height: usize, level: impl Fn(usize, usize) -> u8) -> Image {
    let levels: Vec<u8> = (0..width * height).map(|at| level(at % width, at / width)).collect();
    Image::new(levels, width, height, PixelFormat::Grey, Layout::Hwc).unwrap()
}

const SIZE: [usize; 2] = [160, 80];

/// A wall at disparity 5 and a board in front of it at 20, as stereo images.
fn pair() -> [Image; 2] {
    let is_board = |x: usize, y: usize| (60..110).contains(&x) && (20..60).contains(&y);
    let [width, height] = SIZE;
    let left = grey(width, height, |x, y| if is_board(x, y) { texture(x + 500, y) } else { texture(x, y) });
    let right = grey(width, height, |x, y| match is_board(x + 20, y) {
        true => texture(x + 20 + 500, y),
        false => texture(x + 5, y),
    });
    [left, right]
}

fn disparities([left, right]: &[Image; 2], options: &StereoOptions) -> Vec<f32> {
    let mut map = vec![7.0; left.width() * left.height()];
    StereoMatcher::default().run_into(left, right, options, &mut map).unwrap();
    map
}

fn share(map: &[f32], places: impl Fn(usize, usize) -> bool, is_right: impl Fn(f32) -> bool) -> f64 {
    let places = (0..map.len()).filter(|at| places(at % SIZE[0], at / SIZE[0]));
    let (mut right, mut count) = (0, 0);
    for at in places {
        count += 1;
        right += u32::from(is_right(map[at]));
    }
    f64::from(right) / f64::from(count)
}

#[test]
fn board_and_wall_have_their_disparities() {
    let map = disparities(&pair(), &StereoOptions { disparities: 32, ..StereoOptions::default() });
    let board =
        share(&map, |x, y| (64..106).contains(&x) && (24..56).contains(&y), |d| (d - 20.0).abs() < 0.5);
    let wall = share(&map, |x, y| x > 115 || (x > 10 && y > 65), |d| (d - 5.0).abs() < 0.5);
    assert!(board > 0.98 && wall > 0.98, "{board} {wall}");
    // The wall just left of the board is occluded in the right image.
    let hidden = |x: usize, y: usize| (47..58).contains(&x) && (25..55).contains(&y);
    assert!(share(&map, hidden, |d| d == 0.0) > 0.8);
    let filled =
        disparities(&pair(), &StereoOptions { disparities: 32, fill: true, ..StereoOptions::default() });
    let behind = |x: usize, y: usize| (47..51).contains(&x) && (25..55).contains(&y);
    assert!(share(&filled, behind, |d| (d - 5.0).abs() < 2.0) > 0.9);
    assert!(filled.iter().all(|disparity| *disparity > 0.0));
}

#[test]
fn minimum_disparity_and_reused_memory_do_not_change_results() {
    let pair = pair();
    let options = StereoOptions { disparities: 32, ..StereoOptions::default() };
    let map = disparities(&pair, &options);
    let later = disparities(&pair, &StereoOptions { min_disparity: 10, ..options });
    let board = |x: usize, y: usize| (64..106).contains(&x) && (24..56).contains(&y);
    assert!(share(&later, board, |d| (d - 20.0).abs() < 0.5) > 0.95);
    let mut matcher = StereoMatcher::default();
    let small = [grey(33, 9, texture), grey(33, 9, |x, y| texture(x + 3, y))];
    for _ in 0..2 {
        let mut again = vec![0.0; map.len()];
        matcher.run_into(&pair[0], &pair[1], &options, &mut again).unwrap();
        assert_eq!(again, map);
        let mut other = vec![0.0; 33 * 9];
        matcher.run_into(&small[0], &small[1], &options, &mut other).unwrap();
        assert!(other.iter().filter(|disparity| (**disparity - 3.0).abs() < 0.5).count() > 150);
    }
}

#[test]
fn textureless_images_have_unknown_disparities() {
    let black = || grey(64, 48, |_, _| 0);
    assert!(disparities(&[black(), black()], &StereoOptions::default()).iter().all(|d| *d == 0.0));
    let nan = || Image::new(vec![f32::NAN; 64 * 48], 64, 48, PixelFormat::Grey, Layout::Hwc).unwrap();
    assert!(disparities(&[nan(), nan()], &StereoOptions::default()).iter().all(|d| d.is_finite()));
    for (width, height) in [(1, 1), (200, 1), (1, 200), (3, 2)] {
        let picture = || grey(width, height, texture);
        let map = disparities(&[picture(), picture()], &StereoOptions { fill: true, ..Default::default() });
        assert!(map.iter().all(|d| d.is_finite() && *d >= 0.0));
    }
}

#[test]
fn extreme_options_do_no_harm() {
    let pair = pair();
    for (uniqueness, penalty, range) in [(99, 255, f32::NAN), (0, 0, -1.0)] {
        let options = StereoOptions {
            uniqueness,
            p1: penalty,
            p2: penalty,
            speckle_range: range,
            min_disparity: 1000,
            max_left_right_difference: None,
            ..StereoOptions::default()
        };
        assert!(disparities(&pair, &options).iter().all(|d| *d == 0.0));
        let options = StereoOptions { min_disparity: 0, ..options };
        assert!(disparities(&pair, &options).iter().all(|d| d.is_finite()));
    }
}

#[test]
fn pairs_of_two_sizes_and_too_large_ones_are_refused() {
    let [left, _] = pair();
    let mut map = vec![0.0; left.width() * left.height()];
    let run = |right: &Image, options: &StereoOptions, map: &mut [f32]| {
        StereoMatcher::default().run_into(&left, right, options, map).unwrap_err().to_string()
    };
    let options = StereoOptions::default();
    assert!(run(&grey(160, 79, texture), &options, &mut map).contains("one size"));
    assert!(run(&left, &options, &mut map[1..]).contains("one value per pixel"));
    let huge = grey(5000, 40, texture);
    let many = StereoOptions { disparities: 4096, ..options };
    let error = StereoMatcher::default().run_into(&huge, &huge, &many, &mut vec![0.0; 200_000]);
    assert!(error.unwrap_err().to_string().contains("too many"));
}

#[test]
fn metres_follow_from_disparities() {
    let camera = StereoCamera {
        focal_length: 1000.0,
        baseline: 0.2,
        principal_point: [80.0, 40.0],
        principal_point_offset: 10.0,
    };
    assert_eq!([0.0, 10.0, 30.0, f32::NAN].map(|d| camera.depth(d)), [0.0, 10.0, 5.0, 0.0]);
    let depths = [0.0, 10.0, 5.0, 400.0];
    let image = grey(2, 2, |x, y| (10 * y + x) as u8);
    let cloud = camera.points(&depths, [2, 2], 50.0, Some(&image)).unwrap();
    assert_eq!(cloud.shape(), [2, 6]);
    let points: Vec<_> = cloud.points().collect();
    assert_eq!(points[0], [-0.785, -0.395, 10.0, 1.0, 1.0, 1.0]);
    assert_eq!(points[1][2..], [5.0, 10.0, 10.0, 10.0]);
    assert!(camera.points(&depths, [3, 2], 50.0, None).is_err());
    assert!(camera.points(&[], [0, 0], 50.0, None).unwrap().is_empty());
}

#[test]
fn shrink_equals_matching_a_reduced_pair() {
    let small = pair();
    let [width, height] = SIZE;
    let large = small.each_ref().map(|image| {
        let opendr_engine::data::Pixels::U8(levels) = image.pixels() else { panic!() };
        let at = |x: usize, y: usize| levels[y * width + x];
        grey(2 * width + 1, 2 * height, |x, y| at((x / 2).min(width - 1), y / 2))
    });
    let options =
        StereoOptions { disparities: 32, speckle_size: 25, speckle_range: 0.5, ..Default::default() };
    let wanted = disparities(&small, &options);
    let shrunk =
        StereoOptions { disparities: 64, speckle_size: 100, speckle_range: 1.0, downscale: 2, ..options };
    let map = disparities(&large, &shrunk);
    for (at, found) in map.iter().enumerate() {
        let (x, y) = (at % (2 * width + 1), at / (2 * width + 1));
        assert_eq!(*found, 2.0 * wanted[y / 2 * width + (x / 2).min(width - 1)], "{x} {y}");
    }
    let whole = StereoOptions { downscale: 1000, ..options };
    assert!(disparities(&small, &whole).iter().all(|found| *found == 0.0));
}
