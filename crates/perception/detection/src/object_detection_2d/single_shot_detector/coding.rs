//! Encoding of boxes relative to anchors (Liu et al., SSD, ECCV 2016, Eq. 2).

use super::anchors::Anchor;

/// Divisors of offsets, for about unit variance: centres, then logarithms of sides.
pub const VARIANCES: [f32; 2] = [0.1, 0.2];

/// Limit of the logarithm of a side: e^(4.6) = 100 anchors.
const MOST_LOG: f32 = 4.6;

/// Returns `[dx, dy, log(dw), log(dh)]` of a box `[x0, y0, x1, y1]` of positive area, relative to `anchor`.
pub fn offsets_from_corners(corners: [f32; 4], anchor: &Anchor) -> [f32; 4] {
    let [x0, y0, x1, y1] = corners;
    [
        ((x0 + x1) / 2.0 - anchor.x) / anchor.width / VARIANCES[0],
        ((y0 + y1) / 2.0 - anchor.y) / anchor.height / VARIANCES[0],
        ((x1 - x0) / anchor.width).ln() / VARIANCES[1],
        ((y1 - y0) / anchor.height).ln() / VARIANCES[1],
    ]
}

/// Returns the box `[x0, y0, x1, y1]` at `offsets` from `anchor`.
pub fn corners_from_offsets(offsets: [f32; 4], anchor: &Anchor) -> [f32; 4] {
    let side = |log: f32| (log * VARIANCES[1]).min(MOST_LOG).exp();
    Anchor {
        x: anchor.x + offsets[0] * VARIANCES[0] * anchor.width,
        y: anchor.y + offsets[1] * VARIANCES[0] * anchor.height,
        width: anchor.width * side(offsets[2]),
        height: anchor.height * side(offsets[3]),
    }
    .corners()
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    const ANCHOR: Anchor = Anchor { x: 40.0, y: 24.0, width: 32.0, height: 64.0 };

    #[test]
    fn no_offset_is_the_anchor() {
        assert_eq!(corners_from_offsets([0.0; 4], &ANCHOR), ANCHOR.corners());
        assert_eq!(offsets_from_corners(ANCHOR.corners(), &ANCHOR), [0.0; 4]);
        let shifted = corners_from_offsets([10.0, 0.0, 0.0, 0.0], &ANCHOR);
        assert_eq!(shifted, [56.0, -8.0, 88.0, 56.0], "10 x 0.1 anchors to the right");
    }

    #[test]
    fn any_offsets_give_a_finite_box() {
        let corners = corners_from_offsets([0.0, 0.0, 1e30, f32::INFINITY], &ANCHOR);
        assert!(corners.iter().all(|edge| edge.is_finite()), "{corners:?}");
    }

    proptest! {
        #[test]
        fn coding_and_decoding_is_identity(
            x0 in -50f32..300.0, y0 in -50f32..300.0, width in 1f32..300.0, height in 1f32..300.0,
        ) {
            let corners = [x0, y0, x0 + width, y0 + height];
            let again = corners_from_offsets(offsets_from_corners(corners, &ANCHOR), &ANCHOR);
            for (edge, again) in corners.into_iter().zip(again) {
                prop_assert!((edge - again).abs() < 1e-2, "{corners:?} {again}");
            }
        }
    }
}
