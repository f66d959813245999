//! Overlap of upright boxes in a picture.

/// Intersection over union of two boxes `[x0, y0, x1, y1]`; 0 for a box without area.
///
/// Areas are products of differences of corners, as in py-motmetrics, TrackEval and KITTI's devkit: rounding is the
/// same, so that a pair on the edge of a threshold falls on the same side.
pub fn image_overlap(a: [f64; 4], b: [f64; 4]) -> f64 {
    let shared = shared_area(a, b);
    if shared > 0.0 { shared / (area(a) + area(b) - shared) } else { 0.0 }
}

/// The share of `a` that lies in `b`; 0 for a box without area.
pub fn image_cover(a: [f64; 4], b: [f64; 4]) -> f64 {
    let shared = shared_area(a, b);
    if shared > 0.0 { shared / area(a) } else { 0.0 }
}

fn area([x0, y0, x1, y1]: [f64; 4]) -> f64 {
    (x1 - x0).max(0.0) * (y1 - y0).max(0.0)
}

fn shared_area(a: [f64; 4], b: [f64; 4]) -> f64 {
    area([a[0].max(b[0]), a[1].max(b[1]), a[2].min(b[2]), a[3].min(b[3])])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares() {
        let (a, b) = ([0.0, 0.0, 4.0, 4.0], [2.0, 2.0, 6.0, 4.0]);
        assert_eq!(image_overlap(a, b), 4.0 / (16.0 + 8.0 - 4.0));
        assert_eq!((image_cover(a, b), image_cover(b, a)), (0.25, 0.5));
        assert_eq!(image_overlap(a, a), 1.0);
        let turned = [4.0, 4.0, 0.0, 0.0];
        assert_eq!((image_overlap(a, turned), image_cover(turned, a)), (0.0, 0.0));
        let touching = [4.0, 0.0, 8.0, 4.0];
        assert_eq!((image_overlap(a, touching), image_cover(a, touching)), (0.0, 0.0));
    }
}
