//! Oriented boxes: suppression by the probabilistic IoU, and polygons.

use opendr_engine::target::{BoundingBox, Segment, Segmentation};
use opendr_perception_common::boxes_from_candidates::box_from_candidate;
use opendr_perception_common::exported_network::Rows;
use opendr_perception_common::suppression::{Candidate, keep_best};
use opendr_vision::InputGeometry;

/// Number of candidates with the highest scores that are processed.
const CONSIDERED: usize = 1000;

/// A box as a Gaussian distribution: its centre and its covariance `[[a, c], [c, b]]`.
#[derive(Debug, Clone, Copy)]
pub(super) struct Gaussian {
    centre: [f32; 2],
    a: f32,
    b: f32,
    c: f32,
}

impl Gaussian {
    /// Returns the distribution of a box that is rotated by `angle`, in radians, about its centre.
    fn new([left, top, right, bottom]: [f32; 4], angle: f32) -> Self {
        // A uniform distribution over a side has the variance side^2 / 12.
        let [width, height] = [(right - left).powi(2) / 12.0, (bottom - top).powi(2) / 12.0];
        let (sin, cos) = angle.sin_cos();
        Self {
            centre: [(left + right) / 2.0, (top + bottom) / 2.0],
            a: width * cos * cos + height * sin * sin,
            b: width * sin * sin + height * cos * cos,
            c: (width - height) * cos * sin,
        }
    }

    /// Returns the probabilistic IoU, 1 minus the Hellinger distance (Llerena et al., Gaussian Bounding Boxes and Probabilistic
    /// Intersection-over-Union for Object Detection, 2021).
    fn probabilistic_iou(&self, other: &Self) -> f32 {
        const SMALL: f32 = 1e-7;
        let [x, y] = [self.centre[0] - other.centre[0], self.centre[1] - other.centre[1]];
        let [a, b, c] = [self.a + other.a, self.b + other.b, self.c + other.c];
        let determinant = a * b - c * c;
        let distance =
            (a * y * y + b * x * x) / (determinant + SMALL) * 0.25 - c * x * y / (determinant + SMALL) * 0.5;
        let own = |one: &Self| (one.a * one.b - one.c * one.c).max(0.0);
        let ratio = determinant / (4.0 * (own(self) * own(other)).sqrt() + SMALL) + SMALL;
        let bhattacharyya = (distance + ratio.ln() * 0.5).clamp(SMALL, 100.0);
        1.0 - (1.0 - (-bhattacharyya).exp() + SMALL).sqrt()
    }
}

/// Suppresses rotated candidates, whose angle is the last value of their row: each drops those of its class and of lower scores that it
/// overlaps, even if it is dropped itself (Fast NMS). At most `max_boxes` are left, highest score first.
pub(super) fn suppress(
    candidates: &mut Vec<Candidate>,
    rows: &Rows<'_>,
    iou_threshold: f32,
    max_boxes: usize,
    shapes: &mut Vec<Gaussian>,
    marks: &mut Vec<bool>,
) {
    candidates.retain(|candidate| {
        candidate.corners.iter().all(|edge| edge.is_finite()) && angle(rows, candidate).is_finite()
    });
    keep_best(candidates, CONSIDERED);
    candidates.sort_unstable_by(|a, b| b.score.total_cmp(&a.score).then(a.index.cmp(&b.index)));
    shapes.clear();
    shapes
        .extend(candidates.iter().map(|candidate| Gaussian::new(candidate.corners, angle(rows, candidate))));
    marks.clear();
    marks.extend((0..candidates.len()).map(|at| {
        let better = candidates[..at].iter().zip(&shapes[..at]);
        let mut of_class = better.filter(|(candidate, _)| candidate.class == candidates[at].class);
        of_class.any(|(_, shape)| shape.probabilistic_iou(&shapes[at]) > iou_threshold)
    }));
    let mut dropped = marks.iter();
    candidates.retain(|_| dropped.next() == Some(&false));
    candidates.truncate(max_boxes);
}

/// Returns the angle of a candidate, in radians.
pub(super) fn angle(rows: &Rows<'_>, candidate: &Candidate) -> f32 {
    rows.at(candidate.index as usize, rows.fields().saturating_sub(1))
}

/// Returns the box around a rotated candidate, in pixels of the image and clipped to it, with the rotated box as its polygon; `None` outside
/// of the image.
pub(super) fn box_from_oriented(
    candidate: &Candidate,
    angle: f32,
    geometry: &InputGeometry,
) -> Option<BoundingBox> {
    let [left, top, right, bottom] = candidate.corners;
    let [x, y] = [(left + right) / 2.0, (top + bottom) / 2.0];
    let [half_width, half_height] = [(right - left).abs() / 2.0, (bottom - top).abs() / 2.0];
    let (sin, cos) = angle.sin_cos();
    let reach_x = half_width * cos.abs() + half_height * sin.abs();
    let reach_y = half_width * sin.abs() + half_height * cos.abs();
    let around = Candidate { corners: [x - reach_x, y - reach_y, x + reach_x, y + reach_y], ..*candidate };
    let mut found = box_from_candidate(&around, geometry)?;
    let corner = |right: f32, down: f32| {
        let [right, down] = [right * half_width, down * half_height];
        geometry.image_from_input([x + right * cos - down * sin, y + right * sin + down * cos])
    };
    let corners = [corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)];
    let next = |at: usize| corners[(at + 1) % 4];
    let twice: f32 = (0..4).map(|at| corners[at][0] * next(at)[1] - next(at)[0] * corners[at][1]).sum();
    found.segment = Some(Box::new(Segment {
        segmentation: Segmentation::Polygons(vec![corners.as_flattened().to_vec()]),
        area: twice.abs() / 2.0,
        iscrowd: false,
    }));
    Some(found)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_boxes_overlap_wholly_and_distant_ones_not_at_all() {
        let shape = |x: f32, angle: f32| Gaussian::new([x, 0.0, x + 40.0, 20.0], angle);
        assert!(shape(0.0, 0.3).probabilistic_iou(&shape(0.0, 0.3)) > 0.99);
        assert!(shape(0.0, 0.3).probabilistic_iou(&shape(500.0, 0.3)) < 1e-3);
        // A box is the same after half a turn, and another after a quarter.
        let half = shape(0.0, 0.0).probabilistic_iou(&shape(0.0, std::f32::consts::PI));
        let quarter = shape(0.0, 0.0).probabilistic_iou(&shape(0.0, std::f32::consts::FRAC_PI_2));
        assert!(half > 0.99 && quarter < 0.7, "{half} {quarter}");
    }
}
