//! Matching of anchors and objects (Liu et al., SSD, ECCV 2016, section 2.2).

use opendr_perception_common::suppression::iou;

use super::anchors::Anchor;

/// Target of an anchor.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Match {
    /// Background.
    Background,
    /// The object of this index.
    Object(usize),
    /// No target: the overlap with an object is between the thresholds, or the anchor lies in a crowd.
    Ignored,
}

/// Thresholds of the matching.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Matching {
    /// Minimum IoU of an anchor with its object.
    pub object_iou: f32,
    /// IoU below which an anchor is background.
    pub background_iou: f32,
    /// Share of an anchor's area in a crowd above which it is ignored.
    pub crowd_share: f32,
}

impl Default for Matching {
    fn default() -> Self {
        Self { object_iou: 0.5, background_iou: 0.4, crowd_share: 0.5 }
    }
}

impl Matching {
    /// Returns a match per anchor. Boxes are `[x0, y0, x1, y1]` in the anchors' pixels.
    ///
    /// Every object that overlaps any anchor gets its best one, even with a small overlap. Where two objects have the same
    /// best anchor, the one with the larger overlap gets it, and the other its next best. Every other anchor matches the
    /// object that it overlaps most.
    pub fn run(&self, anchors: &[Anchor], objects: &[[f32; 4]], crowds: &[[f32; 4]]) -> Vec<Match> {
        let mut best = vec![(0.0, 0); anchors.len()];
        for (number, object) in objects.iter().enumerate() {
            for (best, anchor) in best.iter_mut().zip(anchors) {
                let overlap = iou(&anchor.corners(), object);
                if overlap > best.0 {
                    *best = (overlap, number);
                }
            }
        }
        let in_crowd = |anchor: &Anchor| {
            crowds.iter().any(|crowd| share_inside(&anchor.corners(), crowd) > self.crowd_share)
        };
        let of_overlap = |((overlap, object), anchor)| match overlap {
            overlap if overlap >= self.object_iou => Match::Object(object),
            overlap if overlap >= self.background_iou || in_crowd(anchor) => Match::Ignored,
            _ => Match::Background,
        };
        let mut matches: Vec<_> = best.into_iter().zip(anchors).map(of_overlap).collect();
        for claim in best_anchors(anchors, objects) {
            matches[claim.anchor] = Match::Object(claim.object);
        }
        matches
    }
}

/// An object and the free anchor that overlaps it most.
#[derive(Clone, Copy)]
struct AnchorClaim {
    object: usize,
    anchor: usize,
    overlap: f32,
}

impl AnchorClaim {
    fn of(object: usize, anchors: &[Anchor], corners: &[f32; 4], taken: &[bool]) -> Option<Self> {
        let free = anchors.iter().zip(taken).enumerate().filter(|(_, (_, taken))| !**taken);
        let claims = free.map(|(number, (anchor, _))| Self {
            object,
            anchor: number,
            overlap: iou(&anchor.corners(), corners),
        });
        claims.max_by(Self::by_overlap).filter(|claim| claim.overlap > 0.0)
    }

    /// Compares by overlap; among equal overlaps the first is the greatest.
    fn by_overlap(&self, other: &Self) -> std::cmp::Ordering {
        let numbers = |claim: &Self| (claim.object, claim.anchor);
        self.overlap.total_cmp(&other.overlap).then(numbers(other).cmp(&numbers(self)))
    }
}

/// Returns an anchor for every object that overlaps a free one, in the order of decreasing overlaps.
fn best_anchors(anchors: &[Anchor], objects: &[[f32; 4]]) -> Vec<AnchorClaim> {
    let mut taken = vec![false; anchors.len()];
    let claim_of = |object: usize, taken: &[bool]| AnchorClaim::of(object, anchors, &objects[object], taken);
    let mut waiting: Vec<_> = (0..objects.len()).filter_map(|object| claim_of(object, &taken)).collect();
    let mut accepted = Vec::with_capacity(objects.len());
    while let Some(at) = (0..waiting.len()).max_by(|a, b| waiting[*a].by_overlap(&waiting[*b])) {
        let claim = waiting.swap_remove(at);
        if taken[claim.anchor] {
            waiting.extend(claim_of(claim.object, &taken));
        } else {
            taken[claim.anchor] = true;
            accepted.push(claim);
        }
    }
    accepted
}

/// Returns the share of a box's area that lies inside another.
fn share_inside(corners: &[f32; 4], other: &[f32; 4]) -> f32 {
    let side =
        |axis: usize| (corners[axis + 2].min(other[axis + 2]) - corners[axis].max(other[axis])).max(0.0);
    side(0) * side(1) / ((corners[2] - corners[0]) * (corners[3] - corners[1]))
}

#[cfg(test)]
mod tests {
    use super::super::anchors::AnchorLevel;
    use super::*;

    fn anchors() -> Vec<Anchor> {
        AnchorLevel { stride: 32, sides: vec![[32.0, 32.0]] }.anchors([96, 32]).collect()
    }

    #[test]
    fn overlap_decides() {
        let matches = Matching::default().run(&anchors(), &[[0.0, 0.0, 32.0, 32.0]], &[]);
        assert_eq!(matches, [Match::Object(0), Match::Background, Match::Background]);
        // The IoU is 32 x 14.5 of 32 x 32, 0.45, but no anchor has a higher one.
        let matches = Matching::default().run(&anchors(), &[[0.0, 0.0, 32.0, 14.5]], &[]);
        assert_eq!(matches[0], Match::Object(0));
        let two = [[0.0, 0.0, 32.0, 32.0], [18.0, 0.0, 46.0, 32.0]];
        assert_eq!(Matching::default().run(&anchors(), &two, &[])[1], Match::Object(1));
    }

    #[test]
    fn overlaps_between_the_thresholds_are_ignored() {
        let doubled: Vec<_> = [24.0, 32.0]
            .map(|side| Anchor { x: 16.0, y: 16.0, width: 32.0, height: side })
            .into_iter()
            .collect();
        let matches = Matching::default().run(&doubled, &[[0.0, 9.0, 32.0, 23.0]], &[]);
        assert_eq!(matches, [Match::Object(0), Match::Ignored]);
    }

    #[test]
    fn every_object_gets_an_anchor_even_the_same_ones_best() {
        let objects = [[0.0, 0.0, 10.0, 10.0], [0.0, 0.0, 32.0, 30.0], [0.0, 0.0, 40.0, 8.0]];
        let matches = Matching::default().run(&anchors(), &objects, &[]);
        assert_eq!(matches, [Match::Object(1), Match::Object(2), Match::Background]);
        let outside = [[500.0, 500.0, 510.0, 510.0]];
        assert_eq!(Matching::default().run(&anchors(), &outside, &[]), [Match::Background; 3]);
    }

    #[test]
    fn crowds_are_ignored() {
        let crowd = [[0.0, 0.0, 50.0, 32.0]];
        let matches = Matching::default().run(&anchors(), &[], &crowd);
        assert_eq!(matches, [Match::Ignored, Match::Ignored, Match::Background]);
    }
}
