//! Masks from polygons, equal to those of COCO's tools pixel for pixel.

use super::overlap::pixels;
use crate::target::Rle;
use crate::{Error, Result};

/// Steps per pixel along an outline.
const SCALE: f64 = 5.0;
/// Maximum length of an outline in steps, far above that of any outline in an image.
const MAX_STEPS: i64 = 1 << 26;

impl Rle {
    /// Creates the mask inside polygons `[x0, y0, x1, y1, ...]` in pixels; of several, their union.
    ///
    /// It equals `rleFrPoly` and `rleMerge` of pycocotools; fewer than three points enclose nothing.
    ///
    /// # Errors
    /// Returns `InvalidInput` for coordinates that are not finite or far outside, and for an image of 2^32 pixels or more.
    pub fn from_polygons<P: AsRef<[f64]>>(height: u32, width: u32, polygons: &[P]) -> Result<Self> {
        let mut masks = polygons.iter().map(|polygon| Self::from_polygon(height, width, polygon.as_ref()));
        let Some(first) = masks.next() else { return Self::from_polygon(height, width, &[]) };
        masks.try_fold(first?, |all, mask| all.union(&mask?))
    }

    fn from_polygon(height: u32, width: u32, polygon: &[f64]) -> Result<Self> {
        let pixels = pixels(height, width)?;
        let points = scaled(polygon)?;
        let mut crossings = Crossings { height, width, last: None, ends: Vec::new() };
        if points.len() >= 3 {
            for (start, end) in points.iter().zip(points.iter().cycle().skip(1)) {
                crossings.edge(*start, *end);
            }
        }
        let mut ends = crossings.ends;
        ends.push(pixels);
        ends.sort_unstable();
        Self::new(height, width, runs_from_ends(&ends))
    }
}

/// Converts points from pixels to steps.
fn scaled(polygon: &[f64]) -> Result<Vec<[i32; 2]>> {
    if let Some(wrong) = polygon.iter().find(|pixel| !pixel.is_finite()) {
        return Err(Error::invalid_input(format!(
            "an outline has a coordinate of {wrong}; remove the point"
        )));
    }
    let far = f64::from(1 << 28);
    let step = |pixel: f64| (SCALE * pixel + 0.5).clamp(-far, far) as i32;
    let points: Vec<[i32; 2]> =
        polygon.as_chunks::<2>().0.iter().map(|[x, y]| [step(*x), step(*y)]).collect();
    let length: i64 =
        points.iter().zip(points.iter().cycle().skip(1)).map(|(from, to)| steps(*from, *to)).sum();
    if length > MAX_STEPS {
        let pixels = length as f64 / SCALE;
        return Err(Error::invalid_input(format!(
            "an outline is {pixels:.0} pixels long; check its coordinates"
        )));
    }
    Ok(points)
}

/// Returns the longer of the two extents of an edge.
fn steps(from: [i32; 2], to: [i32; 2]) -> i64 {
    i64::from((from[0] - to[0]).abs().max((from[1] - to[1]).abs()))
}

/// Positions where an outline crosses the middle of a column; the mask toggles there, in column order.
struct Crossings {
    height: u32,
    width: u32,
    last: Option<[i32; 2]>,
    ends: Vec<u32>,
}

impl Crossings {
    /// Adds an edge. Its points are computed from the end with the smaller coordinate, in either direction.
    fn edge(&mut self, from: [i32; 2], to: [i32; 2]) {
        let [dx, dy] = [(to[0] - from[0]).abs(), (to[1] - from[1]).abs()];
        let flat = dx >= dy;
        let backwards = if flat { from[0] > to[0] } else { from[1] > to[1] };
        let ([x0, y0], [x1, y1]) = if backwards { (to, from) } else { (from, to) };
        let steps = dx.max(dy);
        let slope = match steps {
            0 => 0.0,
            _ if flat => f64::from(y1 - y0) / f64::from(dx),
            _ => f64::from(x1 - x0) / f64::from(dy),
        };
        for step in 0..=steps {
            let t = if backwards { steps - step } else { step };
            let beside = |start: i32| (f64::from(start) + slope * f64::from(t) + 0.5) as i32;
            self.point(if flat { [x0 + t, beside(y0)] } else { [beside(x0), y0 + t] });
        }
    }

    fn point(&mut self, [u, v]: [i32; 2]) {
        let Some([u_last, v_last]) = self.last.replace([u, v]).filter(|last| last[0] != u) else { return };
        let column = (f64::from(if u < u_last { u } else { u - 1 }) + 0.5) / SCALE - 0.5;
        if column.floor() != column || column < 0.0 || column > f64::from(self.width) - 1.0 {
            return;
        }
        let row = ((f64::from(v.min(v_last)) + 0.5) / SCALE - 0.5).clamp(0.0, f64::from(self.height)).ceil();
        self.ends.push(column as u32 * self.height + row as u32);
    }
}

/// Returns the lengths between sorted positions; two crossings at one position cancel out.
fn runs_from_ends(ends: &[u32]) -> Vec<u32> {
    let mut runs: Vec<u32> = Vec::with_capacity(ends.len());
    let mut lengths = ends.iter().scan(0, |last, end| {
        let length = end - *last;
        *last = *end;
        Some(length)
    });
    runs.extend(lengths.next());
    while let Some(length) = lengths.next() {
        if length > 0 {
            runs.push(length);
        } else if let (Some(next), Some(run)) = (lengths.next(), runs.last_mut()) {
            *run += next;
        }
    }
    runs
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The texts are those of pycocotools 2.0.11 (`encode` of `merge(frPyObjects(..))`).
    #[test]
    fn polygons_are_filled_as_by_pycocotools() {
        let packed = |polygons: &[Vec<f64>]| Rle::from_polygons(12, 14, polygons).unwrap().packed();
        assert_eq!(
            packed(&[vec![2.3, 1.7, 10.1, 2.9, 11.5, 9.3, 3.7, 10.5, 3.7, 10.5]]),
            "V1751O0001O00001OP1"
        );
        assert_eq!(packed(&[vec![-3.2, -4.1, 20.7, 5.5, 6.3, 18.9]]), "0483M2Nc1N_N00001O001O");
        assert_eq!(
            packed(&[
                vec![1.0, 1.0, 6.0, 1.0, 6.0, 6.0, 1.0, 6.0],
                vec![4.0, 4.0, 12.5, 4.0, 12.5, 11.5, 4.0, 11.5]
            ]),
            "=5700006J03M0000000000008"
        );
        assert_eq!(packed(&[vec![1.0, 1.0, 9.0, 9.0, 9.0, 1.0, 1.0, 9.0]]), "=76N2N2N10O2N2N2j1");
        assert_eq!(Rle::from_polygons::<Vec<f64>>(3, 4, &[]).unwrap().counts(), [12]);
        assert_eq!(packed(&[vec![1.0, 1.0, 5.0, 5.0]]), packed(&[]));
    }

    #[test]
    fn outlines_far_outside_are_rejected() {
        for polygon in [[0.0, 0.0, f64::NAN, 1.0, 2.0, 2.0], [0.0, 0.0, 1e300, 0.0, 0.0, -1e300]] {
            assert!(Rle::from_polygons(9, 9, &[polygon]).is_err());
        }
        assert!(Rle::from_polygons(1 << 16, 1 << 16, &[[0.0; 6]]).is_err());
    }
}
