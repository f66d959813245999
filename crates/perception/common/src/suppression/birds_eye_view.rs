//! Non-maximum suppression of 3D boxes in bird's-eye view.

use opendr_engine::overlap::RotatedRectangle;

use super::greedy::{keep_unmarked, mark};

/// A 3D box before suppression.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BevCandidate {
    /// Footprint on the ground plane.
    pub footprint: RotatedRectangle,
    /// Score, 0..=1.
    pub score: f32,
    /// Class index; boxes of different classes never suppress each other.
    pub class: u32,
    /// Index of the box for the caller, to look up other data of it.
    pub index: u32,
}

/// Applies greedy NMS by the IoU of footprints (rotated rectangles, exact): the box with the highest score drops all of its class
/// that overlap it by more than `overlap`, then the next that is left. At most `most` boxes are kept, highest score first.
///
/// Boxes that are not finite or have no area are dropped. `dropped` is work memory. A comparison of circumscribed circles
/// spares most pairs the intersection of polygons.
pub fn suppress_bev(candidates: &mut Vec<BevCandidate>, dropped: &mut Vec<bool>, overlap: f32, most: usize) {
    candidates.retain(|candidate| {
        let RotatedRectangle { center, size, angle } = candidate.footprint;
        let is_finite = center.iter().chain(&size).chain([&angle]).all(|part| part.is_finite());
        is_finite && candidate.score.is_finite() && candidate.footprint.area() > 0.0
    });
    candidates.sort_unstable_by(|a, b| b.score.total_cmp(&a.score).then(a.index.cmp(&b.index)));
    mark(candidates, dropped, most, |best, other| {
        best.class == other.class && best.footprint.iou(&other.footprint) > f64::from(overlap)
    });
    keep_unmarked(candidates, dropped);
}

#[cfg(test)]
mod tests {
    use super::*;

    fn car(x: f64, angle: f64, score: f32, index: u32) -> BevCandidate {
        let floor = RotatedRectangle { center: [x, 0.0], size: [4.0, 2.0], angle };
        BevCandidate { footprint: floor, score, class: 0, index }
    }

    fn run(mut candidates: Vec<BevCandidate>, overlap: f32, most: usize) -> Vec<u32> {
        suppress_bev(&mut candidates, &mut Vec::new(), overlap, most);
        candidates.iter().map(|candidate| candidate.index).collect()
    }

    /// Footprints of 4 x 2 m, shifted by 2 m along x, share 4 of 12 square metres, a third. Crossed ones share 4 of 12 too.
    #[test]
    fn by_hand() {
        let both = |angle: f64, x: f64| vec![car(0.0, 0.0, 0.8, 0), car(x, angle, 0.9, 1)];
        assert_eq!(run(both(0.0, 2.0), 0.32, 9), [1]);
        assert_eq!(run(both(0.0, 2.0), 0.34, 9), [1, 0]);
        assert_eq!(run(both(std::f64::consts::FRAC_PI_2, 0.0), 0.32, 9), [1]);
        assert_eq!(run(both(std::f64::consts::FRAC_PI_2, 0.0), 0.34, 9), [1, 0]);
        assert_eq!(run(both(0.0, 8.0), 0.0, 1), [1]);
        let mut other = both(0.0, 0.0);
        other[0].class = 1;
        assert_eq!(run(other, 0.1, 9), [1, 0]);
    }

    #[test]
    fn invalid_boxes_are_dropped() {
        let mut boxes =
            vec![car(0.0, f64::NAN, 0.9, 0), car(f64::INFINITY, 0.0, 0.9, 1), car(0.0, 0.0, f32::NAN, 2)];
        boxes.push(BevCandidate {
            footprint: RotatedRectangle { center: [0.0; 2], size: [-1.0, 2.0], angle: 0.0 },
            ..car(0.0, 0.0, 0.9, 3)
        });
        boxes.push(car(0.0, 0.1, 0.1, 4));
        assert_eq!(run(boxes, 0.5, 9), [4]);
        assert!(run(Vec::new(), 0.5, 9).is_empty());
    }
}
