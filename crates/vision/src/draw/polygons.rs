//! Rasterisation of polygons.

use crate::draw::canvas::{Canvas, Corners, Point};
use crate::draw::coverage::Coverage;

/// Sub-scanlines per row of pixels; horizontally, coverage is exact.
const CUTS: usize = 4;

/// Maximum number of corners; of a larger polygon every second, third ... corner is used.
const MAX_CORNERS: usize = 4096;

/// Returns the coverage of the union of `polygons` (`[x0, y0, x1, y1, ...]`, pixels; each by the even-odd rule).
/// Corners that are not finite are omitted.
pub(super) fn coverage_of_polygons<T: AsRef<[f32]>>(canvas: &Canvas<'_>, polygons: &[T]) -> Option<Coverage> {
    let polygons: Vec<Vec<Point>> = polygons.iter().map(|polygon| points(polygon.as_ref())).collect();
    let mut coverage = Coverage::within(canvas, corners_around(&polygons))?;
    let mut sum = vec![0.0; coverage.width];
    let left = coverage.left as f32;
    for polygon in &polygons {
        for (y, values) in (coverage.top..).zip(coverage.values.chunks_exact_mut(coverage.width.max(1))) {
            sum.fill(0.0);
            for cut in 0..CUTS {
                let crossings = crossings(polygon, y as f32 + (cut as f32 + 0.5) / CUTS as f32);
                crossings
                    .as_chunks()
                    .0
                    .iter()
                    .for_each(|[from, to]| add_span(&mut sum, from - left, to - left));
            }
            for (value, sum) in values.iter_mut().zip(&sum) {
                *value = (*value).max((sum * 255.0 / CUTS as f32).round() as u8);
            }
        }
    }
    Some(coverage)
}

fn points(polygon: &[f32]) -> Vec<Point> {
    let pairs = polygon.chunks_exact(2).map(|pair| [pair[0], pair[1]]);
    let step = pairs.len().div_ceil(MAX_CORNERS).max(1);
    pairs.step_by(step).filter(|point| point.iter().all(|part| part.is_finite())).collect()
}

fn corners_around(polygons: &[Vec<Point>]) -> Corners {
    let start = [f32::INFINITY, f32::INFINITY, f32::NEG_INFINITY, f32::NEG_INFINITY];
    polygons
        .iter()
        .flatten()
        .fold(start, |[x0, y0, x1, y1], [x, y]| [x0.min(*x), y0.min(*y), x1.max(*x), y1.max(*y)])
}

/// Returns where the edges of a polygon cross a scanline, from left to right.
fn crossings(polygon: &[Point], y: f32) -> Vec<f32> {
    let next = polygon.iter().skip(1).chain(polygon.first());
    let mut found: Vec<f32> = polygon
        .iter()
        .zip(next)
        .filter(|(from, to)| (from[1] <= y) != (to[1] <= y))
        .map(|(from, to)| from[0] + (y - from[1]) / (to[1] - from[1]) * (to[0] - from[0]))
        .collect();
    found.sort_by(f32::total_cmp);
    found
}

/// Adds to each pixel the part of it between `from` and `to`.
fn add_span(row: &mut [f32], from: f32, to: f32) {
    let (from, to) = (from.clamp(0.0, row.len() as f32), to.clamp(0.0, row.len() as f32));
    let (first, last) = (from as usize, (to.ceil() as usize).min(row.len()));
    for (index, sum) in row.iter_mut().enumerate().take(last).skip(first) {
        *sum += (to.min(index as f32 + 1.0) - from.max(index as f32)).max(0.0);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use opendr_engine::data::Image;

    fn area(polygons: &[Vec<f32>]) -> f32 {
        let mut image = Image::from_rgb8(vec![0; 60 * 40 * 3], 60, 40).unwrap();
        let mut canvas = Canvas::over(&mut image);
        if let Some(coverage) = coverage_of_polygons(&canvas, polygons) {
            coverage.paint(&mut canvas, [255; 3], 1.0, 1.0);
        }
        image.chw_u8()[..60 * 40].iter().map(|sample| f32::from(*sample) / 255.0).sum()
    }

    #[test]
    fn areas_are_exact() {
        let square = vec![3.25, 4.0, 13.25, 4.0, 13.25, 9.0, 3.25, 9.0];
        assert!((area(std::slice::from_ref(&square)) - 50.0).abs() < 0.3);
        assert!((area(&[vec![10.0, 5.0, 50.0, 5.0, 10.0, 35.0]]) - 600.0).abs() < 3.0);
        // The union of a polygon and one inside it is the outer one; the even-odd rule holds within a polygon.
        assert!((area(&[square.clone(), square]) - 50.0).abs() < 0.3);
        assert!((area(&[vec![5.0, 5.0, 25.0, 25.0, 25.0, 5.0, 5.0, 25.0]]) - 200.0).abs() < 3.0);
        assert!((area(&[vec![-1e9, 0.0, 1e9, 0.0, 1e9, 40.0, -1e9, 40.0]]) - 2400.0).abs() < 1.0);
    }

    #[test]
    fn hostile_polygons_are_cut() {
        let wild = [f32::NAN, f32::INFINITY, f32::MAX, f32::MIN, -4.0, 0.0, 3.5];
        let polygons: Vec<Vec<f32>> =
            wild.iter().map(|a| wild.iter().flat_map(|b| [*a, *b, *b, 3.0]).collect()).collect();
        area(&polygons);
        assert_eq!(area(&[vec![], vec![1.0], vec![1.0, 2.0], vec![1.0, 2.0, 30.0, 30.0]]), 0.0);
        let circle = (0..100_000).flat_map(|step| {
            let (sine, cosine) = (step as f32 / 100_000.0 * std::f32::consts::TAU).sin_cos();
            [20.0 + 10.0 * cosine, 20.0 + 10.0 * sine]
        });
        assert!((area(&[circle.collect()]) - 314.16).abs() < 1.0);
    }
}
