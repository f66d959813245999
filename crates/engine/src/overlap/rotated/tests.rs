use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI, SQRT_2};

use proptest::prelude::*;

use super::*;

fn rectangle(center: [f64; 2], size: [f64; 2], angle: f64) -> RotatedRectangle {
    RotatedRectangle { center, size, angle }
}

fn near(value: f64, expected: f64) {
    assert!((value - expected).abs() < 1e-12, "{value} is not {expected}");
}

/// A square and itself rotated by 45 degrees share a regular octagon: the square of side 2 without four corners, each a
/// right triangle whose height is half the diagonal less half the side, sqrt(2) - 1, hence of area (sqrt(2) - 1)².
#[test]
fn rotated_squares_share_an_octagon() {
    let [upright, rotated] = [0.0, FRAC_PI_4].map(|angle| rectangle([3.0, -7.0], [2.0, 2.0], angle));
    let octagon = 4.0 - 4.0 * (SQRT_2 - 1.0).powi(2);
    near(upright.intersection_area(&rotated), octagon);
    near(upright.iou(&rotated), octagon / (8.0 - octagon));
}

/// A 4 x 2 rectangle and itself at a right angle share the 2 x 2 square in the middle: 4 of 8 + 8 - 4.
#[test]
fn crossed_rectangles() {
    let along = rectangle([0.0, 0.0], [4.0, 2.0], 0.0);
    near(along.iou(&rectangle([0.0, 0.0], [4.0, 2.0], FRAC_PI_2)), 4.0 / 12.0);
    near(along.iou(&rectangle([0.0, 0.0], [4.0, 2.0], PI)), 1.0);
    near(along.iou(&rectangle([3.0, 1.0], [4.0, 2.0], 0.0)), 1.0 / 15.0);
    assert_eq!(along.iou(&along), 1.0);
}

/// The tip of a diamond reaches 0.5 into a square: a triangle 0.5 high and 1 wide.
#[test]
fn tip_of_a_diamond() {
    let square = rectangle([0.0, 0.0], [2.0, 2.0], 0.0);
    let diamond = rectangle([0.5 + SQRT_2, 0.0], [2.0, 2.0], FRAC_PI_4);
    near(square.intersection_area(&diamond), 0.25);
}

#[test]
fn apart_touching_and_flat() {
    let square = rectangle([0.0, 0.0], [2.0, 2.0], 0.0);
    assert_eq!(square.iou(&rectangle([2.0, 0.0], [2.0, 2.0], 0.0)), 0.0);
    assert_eq!(square.iou(&rectangle([1e9, 0.0], [2.0, 2.0], 1.0)), 0.0);
    for size in [[0.0, 2.0], [-2.0, -2.0], [f64::NAN, 1.0]] {
        assert_eq!(square.iou(&rectangle([0.0, 0.0], size, 0.3)), 0.0);
    }
    let inside = rectangle([0.1, 0.2], [0.5, 0.25], 0.7);
    near(square.intersection_area(&inside), 0.125);
    near(inside.intersection_area(&square), 0.125);
}

/// Octagon base as above, heights 2 and 3 that share 1.
#[test]
fn standing_boxes() {
    let [low, high] = [([0.0, 2.0], 0.0), ([1.0, 4.0], FRAC_PI_4)]
        .map(|(vertical, angle)| UprightBox3D { base: rectangle([1.0, 2.0], [2.0, 2.0], angle), vertical });
    let octagon = 4.0 - 4.0 * (SQRT_2 - 1.0).powi(2);
    near(low.iou(&high), octagon / (8.0 + 12.0 - octagon));
    assert_eq!(low.iou(&UprightBox3D { vertical: [2.0, 3.0], ..low }), 0.0);
}

fn any_rectangle() -> impl Strategy<Value = RotatedRectangle> {
    ([-3.0..3.0, -3.0..3.0f64], [0.1..4.0, 0.1..4.0f64], -7.0..7.0f64)
        .prop_map(|(center, size, angle)| rectangle(center, size, angle))
}

fn contains(a: &RotatedRectangle, [x, y]: [f64; 2]) -> bool {
    let (sin, cos) = a.angle.sin_cos();
    let (x, y) = (x - a.center[0], y - a.center[1]);
    (cos * x + sin * y).abs() <= a.size[0] / 2.0 && (cos * y - sin * x).abs() <= a.size[1] / 2.0
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]
    #[test]
    fn area_is_that_of_counted_points(a in any_rectangle(), b in any_rectangle()) {
        let steps = 400;
        let at = |index: usize| -6.0 + 12.0 * (index as f64 + 0.5) / steps as f64;
        let points = (0..steps * steps).map(|index| [at(index / steps), at(index % steps)]);
        let inside = points.filter(|point| contains(&a, *point) && contains(&b, *point)).count();
        let counted = inside as f64 * (12.0 / steps as f64).powi(2);
        let shared = a.intersection_area(&b);
        prop_assert!((shared - counted).abs() < 0.1, "{shared} is not {counted}");
        prop_assert!((shared - b.intersection_area(&a)).abs() < 1e-12);
        prop_assert!(shared <= a.area().min(b.area()) + 1e-12);
    }
}
