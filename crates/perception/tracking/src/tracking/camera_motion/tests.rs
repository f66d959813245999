use super::*;

/// Returns a texture of sums of waves: sharp corners everywhere, no early repetition.
fn level(x: f64, y: f64) -> f64 {
    let wave = |fx: f64, fy: f64, at: f64| (fx * x + fy * y + at).sin();
    let sum =
        wave(0.11, 0.05, 0.3) + wave(-0.07, 0.13, 1.0) + wave(0.19, -0.16, 2.0) + wave(0.043, 0.21, 4.0);
    128.0 + 28.0 * sum
}

/// Renders the texture through `motion`: a point p of it is at motion(p).
fn picture(motion: &SimilarityMotion, [width, height]: [usize; 2], object: Option<[usize; 4]>) -> Image {
    let norm = motion.scale().powi(2);
    let [sx, sy] = motion.map([0.0, 0.0]);
    let [a, b] = motion.map_direction([1.0, 0.0]);
    let mut samples = Vec::with_capacity(width * height * 3);
    for at in 0..width * height {
        let (x, y) = ((at % width) as f64 + 0.5 - sx, (at / width) as f64 + 0.5 - sy);
        let mut grey = level((a * x + b * y) / norm, (a * y - b * x) / norm) as u8;
        if let Some([x0, y0, x1, y1]) = object
            && (x0..x1).contains(&(at % width))
            && (y0..y1).contains(&(at / width))
        {
            grey = level((at % width - x0) as f64 * 1.7, (at / width - y0) as f64 * 1.7) as u8;
        }
        samples.extend([grey; 3]);
    }
    Image::from_rgb8(samples, width, height).unwrap()
}

/// Returns the largest distance between two motions over an image, in pixels.
fn distance(one: &SimilarityMotion, other: &SimilarityMotion, [width, height]: [usize; 2]) -> f64 {
    let corners = [[0, 0], [width, 0], [0, height], [width, height]].map(|corner| corner.map(|at| at as f64));
    let apart = corners.map(|corner| {
        let ([x, y], [u, v]) = (one.map(corner), other.map(corner));
        (x - u).hypot(y - v)
    });
    apart.into_iter().fold(0.0, f64::max)
}

#[test]
fn shifts_turns_and_scales_are_found() {
    let turn = |scale: f64, angle: f64| [scale * angle.cos(), scale * angle.sin()];
    for (size, true_motion) in [
        ([640, 480], SimilarityMotion::new([1.0, 0.0], [12.0, -7.0])),
        ([640, 480], SimilarityMotion::new(turn(1.02, 0.02), [3.0, 5.0])),
        ([1280, 720], SimilarityMotion::new(turn(0.98, -0.02), [-10.0, 25.0])),
        ([320, 240], SimilarityMotion::new([1.0, 0.0], [0.0, 0.0])),
    ] {
        let mut camera = CameraMotion::default();
        assert_eq!(
            camera.update(&picture(&SimilarityMotion::NONE, size, None), &[]).unwrap(),
            SimilarityMotion::NONE
        );
        let found = camera.update(&picture(&true_motion, size, None), &[]).unwrap();
        let apart = distance(&found, &true_motion, size);
        assert!(apart < 1.0, "{size:?}: {found:?} instead of {true_motion:?}, {apart} pixels");
    }
}

#[test]
fn moving_objects_are_ignored() {
    let (size, true_motion) = ([640, 480], SimilarityMotion::new([1.0, 0.0], [6.0, 2.0]));
    let mut camera = CameraMotion::default();
    let object = ValidBox { corners: [100.0, 100.0, 380.0, 420.0], confidence: 1.0, index: 0 };
    camera.update(&picture(&SimilarityMotion::NONE, size, Some([100, 100, 380, 420])), &[object]).unwrap();
    let found = camera.update(&picture(&true_motion, size, Some([70, 90, 350, 410])), &[]).unwrap();
    assert!(distance(&found, &true_motion, size) < 1.0, "{found:?}");
}

#[test]
fn images_without_corners_have_no_motion() {
    let flat = |grey: u8, [width, height]: [usize; 2]| {
        Image::from_rgb8(vec![grey; 3 * width * height], width, height).unwrap()
    };
    let mut camera = CameraMotion::default();
    for (grey, size) in [(0, [640, 480]), (255, [640, 480]), (9, [1, 1]), (9, [64, 4000]), (9, [70, 70])] {
        for _ in 0..2 {
            assert_eq!(camera.update(&flat(grey, size), &[]).unwrap(), SimilarityMotion::NONE);
        }
    }
    // Another scene: no two points agree by chance.
    camera.update(&picture(&SimilarityMotion::NONE, [640, 480], None), &[]).unwrap();
    let elsewhere = SimilarityMotion::new([0.4, 0.5], [5000.0, 3000.0]);
    assert_eq!(camera.update(&picture(&elsewhere, [640, 480], None), &[]).unwrap(), SimilarityMotion::NONE);
}
