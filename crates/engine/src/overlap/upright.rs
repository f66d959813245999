//! Overlap of axis-aligned boxes in an image.

/// Returns the intersection over union of two boxes `[x0, y0, x1, y1]`; 0 for a box without area.
///
/// Areas are products of differences of corners, as in py-motmetrics, TrackEval and KITTI's development kit. The rounding
/// is therefore the same, and a pair at a threshold falls on the same side.
pub fn box_iou(a: [f64; 4], b: [f64; 4]) -> f64 {
    let shared = shared_area(a, b);
    if shared > 0.0 { shared / (area(a) + area(b) - shared) } else { 0.0 }
}

/// Returns the intersection over the area of `a`; 0 for a box without area.
pub fn box_ioa(a: [f64; 4], b: [f64; 4]) -> f64 {
    let shared = shared_area(a, b);
    if shared > 0.0 { shared / area(a) } else { 0.0 }
}

/// Returns the generalised intersection over union of two boxes `[x0, y0, x1, y1]`, -1 to 1: the farther apart they are,
/// the lower (H. Rezatofighi et al., "Generalized Intersection over Union", CVPR 2019, Algorithm 1). It is -1 if the box
/// around both has no area.
pub fn box_giou(a: [f64; 4], b: [f64; 4]) -> f64 {
    let shared = shared_area(a, b);
    let (union, around) = (area(a) + area(b) - shared, area(around(a, b)));
    if around > 0.0 { shared / union.max(f64::MIN_POSITIVE) - (around - union) / around } else { -1.0 }
}

/// Returns the distance intersection over union of two boxes `[x0, y0, x1, y1]`, -1 to 1: their intersection over union
/// minus the squared distance of their centers, divided by the squared diagonal of the box around both (Z. Zheng et al.,
/// "Distance-IoU Loss", AAAI 2020, Eq. 7).
pub fn box_diou(a: [f64; 4], b: [f64; 4]) -> f64 {
    let square = |axis: usize| {
        let between = (a[axis] + a[axis + 2] - b[axis] - b[axis + 2]) / 2.0;
        let around = around(a, b);
        [between, around[axis + 2] - around[axis]].map(|length| length * length)
    };
    let ([dx, width], [dy, height]) = (square(0), square(1));
    let diagonal = width + height;
    box_iou(a, b) - if diagonal > 0.0 { (dx + dy) / diagonal } else { 0.0 }
}

/// Returns the smallest box around both.
fn around(a: [f64; 4], b: [f64; 4]) -> [f64; 4] {
    [a[0].min(b[0]), a[1].min(b[1]), a[2].max(b[2]), a[3].max(b[3])]
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
    fn overlaps_of_two_boxes() {
        let (a, b) = ([0.0, 0.0, 4.0, 4.0], [2.0, 2.0, 6.0, 4.0]);
        assert_eq!(box_iou(a, b), 4.0 / (16.0 + 8.0 - 4.0));
        assert_eq!((box_ioa(a, b), box_ioa(b, a)), (0.25, 0.5));
        assert_eq!(box_iou(a, a), 1.0);
        let flipped = [4.0, 4.0, 0.0, 0.0];
        assert_eq!((box_iou(a, flipped), box_ioa(flipped, a)), (0.0, 0.0));
        // Side by side, 2 apart: the box around both is 10 by 4.
        let far = [6.0, 0.0, 10.0, 4.0];
        assert_eq!(box_giou(a, far), -8.0 / 40.0);
        assert_eq!(box_diou(a, far), -36.0 / 116.0);
        assert_eq!((box_giou(a, a), box_diou(a, a)), (1.0, 1.0));
        let around = 24.0 - (16.0 + 8.0 - 4.0);
        assert_eq!(box_giou(a, b), 4.0 / 20.0 - around / 24.0);
        let point = [1.0, 1.0, 1.0, 1.0];
        assert_eq!((box_giou(point, point), box_diou(point, point)), (-1.0, 0.0));
        let touching = [4.0, 0.0, 8.0, 4.0];
        assert_eq!((box_iou(a, touching), box_ioa(a, touching)), (0.0, 0.0));
    }
}
