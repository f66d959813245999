//! Geometric relations between boxes.

use opendr_perception_common::suppression::{Candidate, iou};

/// Number of values of the geometry of one box relative to another.
pub const GEOMETRY: usize = 14;
/// Number of neighbours of a box: itself, and those that overlap it most.
pub const NEIGHBOURS: usize = 16;

/// Minimum IoU of neighbours, as in OpenDR.
const LEAST_OVERLAP: f32 = 0.2;
/// Additive mask against neighbours of a lower score: the logarithm of OpenDR's factor 0.1.
const LOWER_SCORE_MASK: f32 = -std::f32::consts::LN_10;
/// Additive mask of padding.
const PADDING_MASK: f32 = -1e4;
/// Limit of the values.
const LARGEST: f32 = 50.0;

/// The boxes of an image, or of several images one after the other.
#[derive(Debug, Clone, Default)]
pub struct Relations {
    /// Geometry of each box relative to itself, `[boxes, GEOMETRY]`.
    pub own: Vec<f32>,
    /// Geometry of each neighbour relative to the box, `[boxes, NEIGHBOURS, GEOMETRY]`.
    pub pairs: Vec<f32>,
    /// Index of each neighbour, the box itself first and as padding: `[boxes, NEIGHBOURS]`.
    pub neighbours: Vec<i64>,
    /// Additive attention mask, `[boxes, NEIGHBOURS]`: 0, less for neighbours of lower scores, least for padding.
    pub mask: Vec<f32>,
    others: Vec<(f32, usize)>,
}

impl Relations {
    /// Returns the number of boxes.
    pub fn len(&self) -> usize {
        self.own.len() / GEOMETRY
    }

    /// Clears all boxes.
    pub fn clear(&mut self) {
        self.own.clear();
        self.pairs.clear();
        self.neighbours.clear();
        self.mask.clear();
    }

    /// Adds the boxes of an image of `size` pixels, sorted by descending score.
    pub fn add(&mut self, boxes: &[Candidate], size: [f32; 2]) {
        let first = self.len() as i64;
        for (at, found) in boxes.iter().enumerate() {
            self.own.extend(geometry(found, found, size));
            self.others.clear();
            for (other, beside) in boxes.iter().enumerate() {
                let shared =
                    if beside.class == found.class { iou(&found.corners, &beside.corners) } else { 0.0 };
                if other != at && shared > LEAST_OVERLAP {
                    self.others.push((shared, other));
                }
            }
            self.others.sort_unstable_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
            let others = self.others.iter().map(|(_, other)| Some(*other));
            let places = std::iter::once(Some(at)).chain(others).chain(std::iter::repeat(None));
            for place in places.take(NEIGHBOURS) {
                let other = place.unwrap_or(at);
                self.pairs.extend(geometry(found, &boxes[other], size));
                self.neighbours.push(first + other as i64);
                self.mask.push(match place {
                    Some(other) if other <= at => 0.0,
                    Some(_) => LOWER_SCORE_MASK,
                    None => PADDING_MASK,
                });
            }
        }
    }
}

/// Returns the geometry of `other` relative to `found` in an image of `size` pixels: offset, distance, sides, overlap,
/// area, score and shape, both absolute and relative to `found`.
fn geometry(found: &Candidate, other: &Candidate, size: [f32; 2]) -> [f32; GEOMETRY] {
    let sides = |corners: &[f32; 4]| [corners[2] - corners[0], corners[3] - corners[1]];
    let middle = |corners: &[f32; 4]| [(corners[0] + corners[2]) / 2.0, (corners[1] + corners[3]) / 2.0];
    let unit = size.map(|side| side / 20.0);
    let ([width, height], [own_width, own_height]) = (sides(&other.corners), sides(&found.corners));
    let ([x, y], [own_x, own_y]) = (middle(&other.corners), middle(&found.corners));
    let (dx, dy) = (x - own_x, y - own_y);
    let far = (dx * dx + dy * dy) / (unit[0] * unit[0] + unit[1] * unit[1]);
    // Areas as the sides of squares, so that all values have one order of magnitude.
    let square = (width * height).sqrt();
    let numbers = [
        dx / unit[0],
        dy / unit[1],
        far,
        width / own_width,
        width / unit[0],
        height / own_height,
        height / unit[1],
        5.0 * iou(&found.corners, &other.corners),
        square / (own_width * own_height).sqrt(),
        square / (unit[0] * unit[1]).sqrt(),
        5.0 * other.score,
        5.0 * (other.score - found.score),
        height / width,
        height / width / (own_height / own_width),
    ];
    numbers.map(|number| number.clamp(-LARGEST, LARGEST))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn found(left: f32, score: f32, class: u32) -> Candidate {
        Candidate { corners: [left, 0.0, left + 40.0, 80.0], score, class, index: 0 }
    }

    #[test]
    fn neighbours_overlap_and_the_surer_count_more() {
        let mut relations = Relations::default();
        relations.add(&[found(900.0, 0.95, 0)], [1000.0, 500.0]);
        let boxes = [
            found(0.0, 0.9, 0),
            found(10.0, 0.8, 0),
            found(2.0, 0.7, 0),
            found(500.0, 0.6, 0),
            found(0.0, 0.5, 1),
        ];
        relations.add(&boxes, [1000.0, 500.0]);
        assert_eq!(relations.len(), 6);
        let of = |at: usize| &relations.neighbours[at * NEIGHBOURS..(at + 1) * NEIGHBOURS];
        // The overlap with the third is 38 of 42, with the second 30 of 50; indices include the first image's box.
        assert_eq!(of(1)[..4], [1, 3, 2, 1]);
        assert_eq!(of(0), [0; NEIGHBOURS]);
        assert_eq!(of(4), [4; NEIGHBOURS]);
        assert_eq!(of(5), [5; NEIGHBOURS], "another class");
        let mask = |at: usize| &relations.mask[at * NEIGHBOURS..at * NEIGHBOURS + 4];
        assert_eq!(mask(1), [0.0, LOWER_SCORE_MASK, LOWER_SCORE_MASK, PADDING_MASK]);
        assert_eq!(mask(3), [0.0, 0.0, 0.0, PADDING_MASK]);
    }

    #[test]
    fn geometry_by_hand() {
        let numbers = geometry(&found(0.0, 0.9, 0), &found(10.0, 0.5, 0), [400.0, 200.0]);
        let expected = [0.5, 0.0, 0.2, 1.0, 2.0, 1.0, 8.0, 3.0, 1.0, 4.0, 2.5, -2.0, 2.0, 1.0];
        for (got, expected) in numbers.iter().zip(expected) {
            assert!((got - expected).abs() < 1e-5, "{numbers:?}");
        }
    }
}
