//! Encoding of boxes relative to anchors (Y. Yan et al., SECOND, Sensors 2018, section 3.2), with a separate direction.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI};

use opendr_engine::target::LidarBox;

/// Number of values of an encoded box: centre, sides (logarithms), yaw.
pub const NUMBERS: usize = 7;

/// Maximum logarithm of a side relative to its anchor; e^3 = 20 anchors.
const MOST_LOG: f64 = 3.0;

/// Returns `[dx, dy, dz, log(dl), log(dw), log(dh), yaw]` of a box relative to `anchor`, and its direction: 1 for backward, 0
/// for forward.
///
/// The yaw is within a quarter turn either way; only the direction distinguishes front and rear.
pub fn offsets_from_box(found: &LidarBox, anchor: &LidarBox) -> ([f32; NUMBERS], f32) {
    let [length, width, height] = anchor.size;
    let diagonal = length.hypot(width);
    let turn = found.yaw - anchor.yaw;
    let offsets = [
        (found.center[0] - anchor.center[0]) / diagonal,
        (found.center[1] - anchor.center[1]) / diagonal,
        (found.center[2] - anchor.center[2]) / height,
        (found.size[0] / length).ln(),
        (found.size[1] / width).ln(),
        (found.size[2] / height).ln(),
        turn - PI * (turn / PI).round(),
    ];
    let back = f32::from(u8::from((found.yaw - FRAC_PI_4).rem_euclid(2.0 * PI) >= PI));
    (offsets.map(|offset| offset as f32), back)
}

/// Returns the box at `offsets` from `anchor`; `back` is a logit, above 0 for backward. The yaw is in -pi..=pi.
pub fn box_from_offsets(offsets: [f32; NUMBERS], back: f32, anchor: &LidarBox) -> LidarBox {
    let [length, width, height] = anchor.size;
    let diagonal = length.hypot(width);
    let [x, y, z, longer, wider, higher, turn] = offsets.map(f64::from);
    let side = |log: f64| log.clamp(-MOST_LOG, MOST_LOG).exp();
    // The half turn is cut at 45 degrees, far from cars along and across the road.
    let yaw = (anchor.yaw + turn - FRAC_PI_4).rem_euclid(PI) + FRAC_PI_4 + if back > 0.0 { PI } else { 0.0 };
    LidarBox {
        center: [
            anchor.center[0] + x * diagonal,
            anchor.center[1] + y * diagonal,
            anchor.center[2] + z * height,
        ],
        size: [length * side(longer), width * side(wider), height * side(higher)],
        yaw: if yaw > PI { yaw - 2.0 * PI } else { yaw },
    }
}

/// Returns the sides along x and y of the axis-aligned rectangle nearest to a rotated one: as it is, or rotated by a quarter
/// turn.
pub fn nearest_upright(found: &LidarBox) -> [f64; 2] {
    let [length, width, _] = found.size;
    let quarter = (found.yaw / FRAC_PI_2).round() as i64;
    if quarter % 2 == 0 { [length, width] } else { [width, length] }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    const ANCHOR: LidarBox = LidarBox { center: [10.0, 2.0, -1.7], size: [3.9, 1.6, 1.56], yaw: FRAC_PI_2 };

    #[test]
    fn any_offsets_decode_to_a_box() {
        let found = box_from_offsets([0.0, 0.0, 0.0, 1e30, -1e30, f32::INFINITY, 1e9], 1.0, &ANCHOR);
        assert!(found.size.iter().all(|side| side.is_finite() && *side > 0.0) && found.yaw.abs() <= PI);
    }

    #[test]
    fn nearest_upright_is_the_nearer_of_two() {
        let turned = |yaw| nearest_upright(&LidarBox { yaw, ..ANCHOR });
        assert_eq!((turned(0.7), turned(0.8)), ([3.9, 1.6], [1.6, 3.9]));
        assert_eq!((turned(-3.0), turned(-1.6)), ([3.9, 1.6], [1.6, 3.9]));
    }

    proptest! {
        #[test]
        fn coding_and_decoding_is_identity(
            x in 0f64..50.0, y in -20f64..20.0, length in 1f64..9.0, yaw in -3.1f64..3.1, quarter in 0..2,
        ) {
            let anchor = LidarBox { yaw: f64::from(quarter) * FRAC_PI_2, ..ANCHOR };
            let car = LidarBox { center: [x, y, -1.5], size: [length, 1.7, 1.4], yaw };
            let (offsets, back) = offsets_from_box(&car, &anchor);
            prop_assert!(offsets[6].abs() <= 1.571);
            let again = box_from_offsets(offsets, back - 0.5, &anchor);
            let pairs = car.center.iter().zip(again.center).chain(car.size.iter().zip(again.size));
            for (a, b) in pairs {
                prop_assert!((a - b).abs() < 1e-4, "{again:?}");
            }
            // At the edge of a half turn, rounding may exchange front and rear.
            let edge = ((yaw - FRAC_PI_4).rem_euclid(PI) / PI - 0.5).abs() > 0.499;
            let apart = (car.yaw - again.yaw).sin().abs() + if edge { 0.0 } else { 1.0 - (car.yaw - again.yaw).cos() };
            prop_assert!(apart < 1e-4, "{car:?} {again:?}");
        }
    }
}
