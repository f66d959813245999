//! Transformation of polygons.

use crate::augment::picture::map::AffineMap;

/// Maps the polygon `[x0, y0, x1, y1, ...]` without clipping; points that are not finite are skipped.
pub(super) fn mapped(polygon: &[f32], map: &AffineMap) -> Vec<[f64; 2]> {
    let corners = polygon.chunks_exact(2).filter(|corner| corner.iter().all(|part| part.is_finite()));
    corners.map(|corner| map.output_from_input([corner[0].into(), corner[1].into()])).collect()
}

/// Clips a polygon to an image (Sutherland and Hodgman, 1974); the result may be empty.
pub(super) fn clipped(mut polygon: Vec<[f64; 2]>, size: [usize; 2]) -> Vec<[f64; 2]> {
    for axis in 0..2 {
        for (edge, sign) in [(0.0, 1.0), (size[axis] as f64, -1.0)] {
            polygon = half(&polygon, |corner| sign * (corner[axis] - edge));
        }
    }
    polygon
}

/// Returns the part of a polygon where `inside` is not negative.
fn half(polygon: &[[f64; 2]], inside: impl Fn(&[f64; 2]) -> f64) -> Vec<[f64; 2]> {
    let mut kept = Vec::with_capacity(polygon.len() + 4);
    let before = polygon.iter().cycle().skip(polygon.len().saturating_sub(1));
    for (from, to) in before.zip(polygon) {
        let (start, end) = (inside(from), inside(to));
        if (start < 0.0) != (end < 0.0) {
            let part = start / (start - end);
            kept.push([0, 1].map(|axis| from[axis] + part * (to[axis] - from[axis])));
        }
        if end >= 0.0 {
            kept.push(*to);
        }
    }
    kept
}

/// Returns the area of a simple polygon in square pixels.
pub(super) fn area(polygon: &[[f64; 2]]) -> f64 {
    let next = polygon.iter().cycle().skip(1);
    let doubled: f64 = polygon.iter().zip(next).map(|(from, to)| from[0] * to[1] - to[0] * from[1]).sum();
    doubled.abs() / 2.0
}

/// Returns `[left, top, right, bottom]` around points; `None` without points.
pub(super) fn bounds<'a>(points: impl IntoIterator<Item = &'a [f64; 2]>) -> Option<[f64; 4]> {
    points
        .into_iter()
        .map(|[x, y]| [*x, *y, *x, *y])
        .reduce(|[x0, y0, x1, y1], [x, y, ..]| [x0.min(x), y0.min(y), x1.max(x), y1.max(y)])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn polygons_are_clipped_at_the_border() {
        let triangle = vec![[-10.0, 5.0], [10.0, -15.0], [30.0, 5.0]];
        let inside = clipped(triangle.clone(), [20, 20]);
        assert_eq!(bounds(&inside), Some([0.0, 0.0, 20.0, 5.0]));
        assert!((area(&triangle) - 400.0).abs() < 1e-9 && (area(&inside) - 100.0).abs() < 1e-9);
        assert!(clipped(triangle, [20, 20]).len() <= 7);
        assert!(clipped(vec![[30.0, 1.0], [40.0, 1.0], [40.0, 9.0]], [20, 20]).is_empty());
        assert!(clipped(Vec::new(), [20, 20]).is_empty());
        assert_eq!(bounds(&[]), None);
    }
}
